"""Single keys: what terminals send becomes names, and the terminal is as before afterwards."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.cli.shared.terminal import keys
from robolink.text.keys import split_keys


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("qQ ", ["q", "Q", " "]),
        ("\x1b[A\x1b[B\x1b[C\x1b[D", ["up", "down", "right", "left"]),
        ("\x1bOA", ["up"]),
        ("\xe0H\xe0P", ["up", "down"]),
        ("\r\n\x7f\x1b", ["enter", "enter", "backspace", "escape"]),
        ("\x1b[5~\x1b[99~x", ["pageup", "x"]),
        ("ção", ["ç", "ã", "o"]),
    ],
)
def test_what_a_terminal_sends_becomes_names(text: str, names: list[str]) -> None:
    assert split_keys(text) == names


@given(st.text())
def test_any_text_is_split(text: str) -> None:
    assert all(split_keys(text))


def test_without_a_terminal_no_key_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("q"))
    with keys() as read:
        assert read(0.0) == ""


if sys.platform != "win32":
    import termios

    @pytest.fixture
    def typist(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
        """The end of a terminal at which somebody types; the other is standard input."""
        theirs, ours = os.openpty()
        with open(ours, encoding="utf-8", buffering=1, closefd=False) as stdin:
            monkeypatch.setattr(sys, "stdin", stdin)
            yield theirs
            monkeypatch.undo()
        for each in (theirs, ours):
            os.close(each)

    def test_each_key_comes_at_once_and_the_terminal_is_as_before(typist: int) -> None:
        before = termios.tcgetattr(sys.stdin)
        with keys() as read:
            assert termios.tcgetattr(sys.stdin) != before
            os.write(typist, b"s\x1b[A")
            assert [read(10.0), read(0.0), read(0.0)] == ["s", "up", ""]
        assert termios.tcgetattr(sys.stdin) == before
