"""launch_test as `robolink shim launch_test` writes it: runs the launch tests of a file as ROS 2's command does."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from robolink.cli.shared.output import complain, say

_USAGE = "launch_test FILE [NAME:=VALUE]... [--show-args] [--package-name PACKAGE] [--junit-xml FILE] [-v]"


def main(args: Sequence[str] | None = None) -> int:
    """Run the launch tests of a file, and return the exit code.

    Args:
        args: The file, launch arguments and options; None takes those of the process.
    """
    words = list(sys.argv[1:] if args is None else args)
    if not words or words[0] in ("-h", "--help"):
        say(f"{_USAGE}; made by 'robolink shim launch_test': 'pytest FILE' runs the same tests, each by its name")
        return 0
    if not any(Path(each).is_file() for each in words):
        return complain(f"there is no file among '{' '.join(words)[:200]}': {_USAGE}", 2)
    from robolink import compat
    from robolink.exceptions import RobolinkError

    compat.activate(compat.ALWAYS)
    from robolink.launch.ros.launch_testing.isolation import own_network
    from robolink.launch.ros.launch_testing.launch_test import parse_arguments, run

    try:
        with own_network():
            return run(*parse_arguments(words))
    except RobolinkError as error:
        return complain(str(error))


if __name__ == "__main__":
    sys.exit(main())
