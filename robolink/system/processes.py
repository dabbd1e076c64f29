"""Other processes: the command lines and the environments with which they are started."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence
from typing import TypeAlias

SHELL = ("cmd", "/d", "/s", "/c")
"""Words before a line for the shell of Windows, which takes the quotes around it off and reads the rest as typed."""
_BEGIN = "import sys; del sys.path[0]; from robolink.__main__ import main; sys.exit(main())"
Variables: TypeAlias = "Mapping[str, str | None]"
"""Variables that are set in an environment, or with None taken out of it."""
ROS_DISTRO = "jazzy"
"""Distribution of ROS 2 that programs see, and that a bag says it comes from, where ROS_DISTRO is not set."""


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
    from pathlib import Path  # late: it takes a node's start 3 ms

    try:
        return Path.cwd() == Path(__file__).resolve().parent.parent
    except OSError:  # it has been deleted
        return False


def split_words(text: str, platform: str = sys.platform) -> list[str]:
    r"""Return the words of a command line, `text`. Raises ValueError if a quote is not closed.

    On Windows a backslash is a letter as any other, since paths are full of them; quotes are taken off there, too.

    >>> split_words(r'"C:\Program Files\x.exe" -a', "win32")
    ['C:\\Program Files\\x.exe', '-a']
    """
    import shlex

    lexer = shlex.shlex(text, posix=True, punctuation_chars=False)
    lexer.whitespace_split, lexer.commenters = True, ""
    if platform == "win32":
        lexer.escape = ""
    return list(lexer)


def windows_line(words: Sequence[str]) -> str:
    """Return the command line by which Windows starts a program.

    Its words are quoted as the C runtime reads them. A line for the shell stays as it is: cmd knows no backslash before
    a quote.

    Args:
        words: The program and its arguments; behind `SHELL` stands one line.
    """
    import subprocess

    if tuple(words[-len(SHELL) - 1 : -1]) == SHELL:
        return f'{subprocess.list2cmdline(words[:-1])} "{words[-1]}"'
    return subprocess.list2cmdline(words)


def set_ros_version() -> None:
    """Set what a sourced ROS 2 sets, where it is not set: launch files and nodes choose types and files by it."""
    for name, value in {"ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3", "ROS_DISTRO": ROS_DISTRO}.items():
        os.environ.setdefault(name, value)


def environment_with(changes: Variables, environ: Mapping[str, str] | None = None) -> dict[str, str]:
    """Return an environment with some changes.

    Args:
        changes: The changes.
        environ: The environment; None is that of this process.
    """
    whole = {**(os.environ if environ is None else environ), **changes}
    return {name: value for name, value in whole.items() if value is not None}


def set_environment(changes: Variables) -> None:
    """Make some `changes` in the environment of this process."""
    for name, value in changes.items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value
