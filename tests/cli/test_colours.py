"""Colours of the command line: where there is a terminal, and NO_COLOR is not set."""

from __future__ import annotations

import io
import sys

import pytest

from robolink.cli.main import main
from robolink.system.terminal import styled, wants_colour


class Terminal(io.StringIO):
    encoding = "utf-8"

    def isatty(self) -> bool:
        return True


def on_terminal(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    """Make standard output and error a terminal."""
    made = Terminal()
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stdout", made)
    monkeypatch.setattr(sys, "stderr", made)
    return made


def test_an_error_has_a_red_name(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)
    assert main(["topicc"]) == 2
    assert terminal.getvalue().startswith("\x1b[1;31mrobolink:\x1b[0m no command named 'topicc'")


def test_help_has_bold_headings(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)
    assert main(["topic", "--help"]) == 0
    text = terminal.getvalue()
    assert text.startswith("\x1b[1mUsage:\x1b[0m robolink topic")
    assert "\n\x1b[1mCommands:\x1b[0m\n" in text


@pytest.mark.annex("learn")
def test_marks_have_their_colours_and_the_rest_none(monkeypatch: pytest.MonkeyPatch) -> None:
    from robolink.cli.learn.work import say_all

    terminal = on_terminal(monkeypatch)
    say_all(["  ✓ done", "✗ no\x1b[2J", "next: ✓"])
    assert terminal.getvalue() == "  \x1b[32m✓\x1b[0m done\n\x1b[31m✗\x1b[0m no\\x1b[2J\nnext: ✓\n"


def test_no_color_and_pipes_have_none(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)
    assert styled("a", "31", io.StringIO()) == styled("a", "31", None) == "a"
    monkeypatch.setenv("NO_COLOR", "1")
    assert not wants_colour(terminal)
    assert main(["topic", "--help"]) == 0
    assert main(["topicc"]) == 2
    assert "\x1b" not in terminal.getvalue()
