"""Words of command lines on Windows and elsewhere; cmd and the C runtime are stood in for by their rules."""

from __future__ import annotations

import subprocess

import pytest

from robolink.system.processes import SHELL, split_words, windows_line


@pytest.mark.parametrize(
    ("text", "platform", "words"),
    [
        ("a 'b c' \"d e\"f", "linux", ["a", "b c", "d ef"]),
        (r"a\ b c", "linux", ["a b", "c"]),
        ("a 'b c' \"d e\"f", "win32", ["a", "b c", "d ef"]),
        (r'"C:\Program Files\gdb.exe" --args', "win32", [r"C:\Program Files\gdb.exe", "--args"]),
        (r"C:\tools\x.exe '' #no", "win32", [r"C:\tools\x.exe", "", "#no"]),
        ("", "win32", []),
    ],
)
def test_words_lose_their_quotes_on_every_system(text: str, platform: str, words: list[str]) -> None:
    assert split_words(text, platform) == words


@pytest.mark.parametrize("platform", ["linux", "win32"])
def test_a_quote_is_closed(platform: str) -> None:
    with pytest.raises(ValueError, match="closing quotation"):
        split_words("a 'b", platform)


def test_a_line_for_cmd_keeps_its_quotes() -> None:
    line = 'ros2 service call /spawn turtlesim/srv/Spawn "{x: 2, y: 2}"'
    assert windows_line([*SHELL, line]) == f'cmd /d /s /c "{line}"'
    assert windows_line(["xterm", "-e", *SHELL, line]) == f'xterm -e cmd /d /s /c "{line}"'


def test_other_words_are_quoted_as_programs_read_them() -> None:
    words = ["x.exe", "a b", 'c"d', ""]
    assert windows_line(words) == subprocess.list2cmdline(words) == 'x.exe "a b" c\\"d ""'
