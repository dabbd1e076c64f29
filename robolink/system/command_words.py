"""Words of command lines: how a text is split into them, and how Windows gets them."""

from __future__ import annotations

import shlex
import subprocess
import sys
from collections.abc import Sequence

SHELL = ("cmd", "/d", "/s", "/c")
"""Words before a line for the shell of Windows, which takes the quotes around it off and reads the rest as typed."""


def split_words(text: str, platform: str = sys.platform) -> list[str]:
    r"""Return the words of a command line, `text`. Raises ValueError if a quote is not closed.

    On Windows a backslash is a letter as any other, since paths are full of them; quotes are taken off there, too.

    >>> split_words(r'"C:\Program Files\x.exe" -a', "win32")
    ['C:\\Program Files\\x.exe', '-a']
    """
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
    if tuple(words[-len(SHELL) - 1 : -1]) == SHELL:
        return f'{subprocess.list2cmdline(words[:-1])} "{words[-1]}"'
    return subprocess.list2cmdline(words)
