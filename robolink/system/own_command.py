"""Command line of another `robolink` process, which imports nothing from the working directory."""

from __future__ import annotations

import sys
from pathlib import Path

_ROOT = Path(__file__).resolve().parent.parent
_BEGIN = "import sys; del sys.path[0]; from robolink.__main__ import main; sys.exit(main())"


def own_command() -> tuple[str, ...]:
    """Return the first words of a command line that runs this robolink; its arguments follow.

    `python -m` alone would look for each module in the working directory first, and run a stranger's `numpy.py` there.
    Only where robolink itself stands in the working directory is that the place to look: a clone that is not installed.
    """
    if _stands_in_working_directory():
        return sys.executable, "-m", "robolink"
    if sys.version_info >= (3, 11):
        return sys.executable, "-P", "-m", "robolink"
    return sys.executable, "-c", _BEGIN


def _stands_in_working_directory() -> bool:
    try:
        return Path.cwd() == _ROOT
    except OSError:  # it has been deleted
        return False
