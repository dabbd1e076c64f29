"""The window in a terminal: half blocks of the right colours, above a log that scrolls, and refusals."""

from __future__ import annotations

import re
import sys

import numpy as np
import pytest

from robolink.counterparts.turtlesim.picture import BACKGROUND, Canvas, Drawn
from robolink.counterparts.turtlesim.window import NoTerminalWindowError, half_blocks, terminal_room
from tests.support.commands import ROBOLINK, TERMINAL, Command

COLOUR = re.compile(r"\x1b\[[34]8;2;(\d+);(\d+);(\d+)m")


def test_a_character_is_the_mean_colours_of_two_parts() -> None:
    picture = np.zeros((4, 6, 3), np.uint8)
    picture[0, :3] = (200, 100, 50)  # half of the upper left part
    picture[2:, 3:] = (1, 2, 3)
    assert half_blocks(picture, 2) == ("\x1b[38;2;100;50;25m\x1b[48;2;0;0;0m▀\x1b[38;2;0;0;0m\x1b[48;2;1;2;3m▀\x1b[0m")


def test_a_thin_line_and_a_turtle_are_seen() -> None:
    canvas = Canvas()
    empty, picture = canvas.picture([]), canvas.picture([Drawn(5.0, 5.0, 0.0, 0)])
    assert set(COLOUR.findall(half_blocks(empty, 40))) == {tuple(map(str, BACKGROUND))}
    lines = half_blocks(picture, 40).split("\r\n")
    assert [re.sub(r"\x1b\[[\d;]*m", "", line) for line in lines] == ["▀" * 40] * 20
    assert len([line for line in lines if len(COLOUR.findall(line)) > 2]) in {2, 3}
    empty[250] = (255, 0, 0)
    assert len(set(COLOUR.findall(half_blocks(empty, 40)))) == 2


def test_without_a_terminal_it_says_so() -> None:
    with pytest.raises(NoTerminalWindowError, match="standard output is none"), terminal_room():
        pass


def test_a_terminal_can_be_too_small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("LINES", "12")
    with pytest.raises(NoTerminalWindowError, match="20 columns and 16 lines at least"), terminal_room():
        pass


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="a terminal of Linux and macOS")
def test_the_window_is_drawn_and_the_terminal_is_given_back(domain: int) -> None:
    words = ("run", "turtlesim", "turtlesim_node", "--terminal")
    with Command(domain, *words, program=(sys.executable, "-c", TERMINAL, *ROBOLINK), has_input=True) as turtlesim:
        turtlesim.wait_for("\x1b[2J")
        turtlesim.wait_for("▀" * 10)
        turtlesim.press("\x03")  # Ctrl-C
        turtlesim.wait_for("\x1b[r")
        assert turtlesim.end() == 0
        said = "\n".join(line.text for line in turtlesim.lines)
        assert "Spawning turtle [turtle1]" in said
        assert "http" not in said
