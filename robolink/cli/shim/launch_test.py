"""launch_test as `robolink shim launch_test` writes it: pytest runs the launch tests of a file."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from robolink.cli.shared.output import complain, say

_USAGE = "launch_test FILE [NAME:=VALUE]... [--junit-xml FILE]"


def main(args: Sequence[str] | None = None) -> int:
    """Run the launch tests of a file, and return the exit code.

    Args:
        args: The file, launch arguments and options of pytest; None takes those of the process.
    """
    words = list(sys.argv[1:] if args is None else args)
    if not words or words[0] in ("-h", "--help"):
        say(f"{_USAGE}; made by 'robolink shim launch_test': further options are pytest's")
        return 0
    given = [each for each in words if ":=" in each and not each.startswith("-")]
    files = [each for each in words if Path(each).is_file() and each.endswith(".py")]
    if not files:
        return complain(f"there is no Python file among '{' '.join(words)[:200]}': {_USAGE}", 2)
    try:
        import pytest
    except ImportError:
        return complain("launch tests are run by pytest, which is not installed: pip install pytest")
    others = [each for each in words if each not in given]
    return int(pytest.main(["-v", *others, *(["--launch-args", *given] if given else [])]))


if __name__ == "__main__":
    sys.exit(main())
