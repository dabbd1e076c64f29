"""Layouts of a line: columns on a terminal, the name in brackets for programs and for who chose ROS's format."""

from __future__ import annotations

import io
import re

import pytest

from robolink.supervisor.policy import Severity
from robolink.supervisor.reporting.layouts import Brackets, Columns, layout

LOGGED = "[INFO] [1795863973.050000000] [world]: robot at (1, 2)"


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture(autouse=True)
def plain_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    for each in ("NO_COLOR", "RCUTILS_COLORIZED_OUTPUT", "RCUTILS_CONSOLE_OUTPUT_FORMAT"):
        monkeypatch.delenv(each, raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "80")


def columns(*names: str, has_colour: bool = False, widest: int = 20, clock: Clock | None = None) -> Columns:
    return Columns(names, has_colour=has_colour, widest=widest, clock=clock or Clock())


def line(made: Columns | Brackets, name: str, text: str) -> str:
    return made.line(name, f"{text}\n".encode()).decode()


def text(made: Columns, name: str, of: str) -> str:
    """Return the text of a line, behind its three columns."""
    return line(made, name, of)[len("  0.0 s  INFO  launch  ") : -1]


def without_colours(shown: str) -> str:
    return re.sub(r"\x1b\[[0-9;]*m", "", shown)


# --- which layout ---------------------------------------------------------------------------------------------


def test_a_terminal_gets_columns_and_all_else_what_the_nodes_wrote(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = line(layout(Terminal(), ["world"], Clock()), "world", LOGGED)
    assert without_colours(shown) == "  0.0 s  INFO  world   robot at (1, 2)\n"
    assert line(layout(io.StringIO(), ["world"]), "world", LOGGED) == f"[world] {LOGGED}\n"
    monkeypatch.setenv("RCUTILS_CONSOLE_OUTPUT_FORMAT", "[{severity}] [{time}] [{name}]: {message}")
    assert line(layout(Terminal(), ["world"]), "world", LOGGED) == f"\x1b[36m[world]\x1b[0m {LOGGED}\n"


@pytest.mark.parametrize(
    ("variable", "value"), [("NO_COLOR", "1"), ("RCUTILS_COLORIZED_OUTPUT", "0"), ("TERM", "dumb")]
)
def test_colours_can_be_switched_off(variable: str, value: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(variable, value)
    shown = line(layout(Terminal(), ["world"], Clock()), "world", LOGGED.replace("INFO", "WARN"))
    assert shown == "  0.0 s  WARN  world   robot at (1, 2)\n"


def test_a_narrow_terminal_has_a_narrow_column_of_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    wide, narrow = "  0.0 s        a                     hi\n", "  0.0 s        a       hi\n"
    for width, expected in (("100", wide), ("60", narrow)):
        monkeypatch.setenv("COLUMNS", width)
        assert line(layout(Terminal(), ["a", "a_name_of_20_letters"], Clock()), "a", "hi") == expected


# --- columns --------------------------------------------------------------------------------------------------


def test_a_line_has_the_time_since_the_start() -> None:
    clock = Clock()
    made = columns("a", clock=clock)
    found = []
    for passed in (0.04, 3.21, 71.0, 12345.6):
        clock.now = 100.0 + passed
        found.append(line(made, "a", "x"))
    assert found == [f"{each}        a       x\n" for each in ("  0.0 s", "  3.2 s", " 71.0 s", "12345.6 s")]


@pytest.mark.parametrize(
    ("name", "of", "shown"),
    [
        ("world", LOGGED, "robot at (1, 2)"),
        ("ada/world", "[WARN] [1795863973.05] [ada.world]: [1.5] [x]: y", "[1.5] [x]: y"),
        ("world-2", "[INFO] [1795863973.05] [world]: x", "world: x"),
        ("world", "[INFO] [1.5] [world.planner]: x", "planner: x"),
        ("a", "[INFO] [1.5] []: x", ": x"),
        ("a", "\x1b[33m[WARN] [1.5] [a]: x\x1b[0m", "x"),
        ("a", "\x1b[0m[INFO] [1.5] [b]: \x1b[31mx\x1b[0m", "b: \x1b[31mx\x1b[0m"),
        ("a", "[INFO] [now] [a]: x", "[INFO] [now] [a]: x"),
        ("a", "said [INFO] [1.5] [a]: x", "said [INFO] [1.5] [a]: x"),
        ("a", "[INFO] [1.5] [a]: ", ""),
        ("a", '  File "a.py", line 3, in <module>', '  File "a.py", line 3, in <module>'),
        ("a", "x" * 5000, "x" * 5000),
        ("a", "\u00e9 \u4e2d \U0001f916", "\u00e9 \u4e2d \U0001f916"),
    ],
)
def test_each_line_is_whole_and_says_each_name_once(name: str, of: str, shown: str) -> None:
    found = line(columns(name), name, of)
    assert found.partition(name)[2].lstrip(" ").removesuffix("\n") == shown.lstrip(" ")
    assert found.endswith(f"  {shown}\n")


def test_lines_of_others_than_a_log_have_no_severity() -> None:
    assert line(columns("a"), "a", "Traceback (most recent call last):").startswith("  0.0 s        a       Traceback")


def test_a_progress_line_is_shown_as_it_was_in_the_end() -> None:
    assert text(columns("a"), "a", "\r 10%\r 50%\r100%\r") == "100%"
    assert text(columns("a"), "a", "done\r") == "done"


def test_a_terminal_obeys_colours_only_and_none_is_left_on() -> None:
    found = text(columns("a"), "a", "\x1b[31mred\x1b[2J\x1b]0;title\x07 \u202e\ttab")
    assert found == "\x1b[31mred\\x1b[2J\\x1b]0;title\\x07 \\u202e\ttab\x1b[0m"


def test_severities_have_their_colours_and_names_their_own() -> None:
    made = columns("a", "b", has_colour=True)
    time, name = "\x1b[2m  0.0 s\x1b[0m", "\x1b[36ma\x1b[0m     "
    for severity, style in (("DEBUG", "2"), ("WARN", "33"), ("ERROR", "31"), ("FATAL", "1;31")):
        found = line(made, "a", f"[{severity}] [1.5] [a]: x")
        assert found == f"{time}  \x1b[{style}m{severity:5}\x1b[0m {name}  \x1b[{style}mx\x1b[0m\n"
    assert line(made, "a", "[INFO] [1.5] [a]: x") == f"{time}  INFO  {name}  x\n"
    assert line(made, "a", "[WARN] [1.5] [a]: \x1b[35mown\x1b[0m").endswith("  \x1b[35mown\x1b[0m\n")
    assert line(made, "b", "x") == f"{time}        \x1b[32mb\x1b[0m       x\n"


def test_names_are_aligned_and_long_ones_are_whole() -> None:
    made = columns("a", "a_longer_name", "a_name_that_is_longer_than_the_column")
    assert line(made, "a", "x") == "  0.0 s        a              x\n"
    assert line(made, "a_longer_name", "x") == "  0.0 s        a_longer_name  x\n"
    assert line(made, "a_name_that_is_longer_than_the_column", "x").endswith("than_the_column  x\n")
    made.add("another_longer_name")
    assert line(made, "a", "x") == "  0.0 s        a                    x\n"
    assert line(made, "another_longer_name", "x") == "  0.0 s        another_longer_name  x\n"


@pytest.mark.parametrize("severity", ["INFO", "WARN", "ERROR"])
def test_lines_of_the_launchers_own_are_in_the_same_columns(severity: Severity) -> None:
    found = columns("a").say("one\n\x1b[2Jtwo", severity)
    row = f"  0.0 s  {severity:5} launch  "
    assert found.decode() == f"\r{row}one\n{row}\\x1b[2Jtwo\n"


# --- brackets -------------------------------------------------------------------------------------------------


def test_programs_get_the_name_and_the_line_as_it_came() -> None:
    made = layout(io.StringIO(), ["a", "b"])
    assert line(made, "a", "hi\r") == "[a] hi\n"
    assert made.line("b", b"\xc3\xa9\xff").decode() == "[b] \u00e9\ufffd\n"
    assert made.say("over", "ERROR") == b"[launch] over\n"
    made.add("c")
    assert line(made, "c", LOGGED) == f"[c] {LOGGED}\n"


def test_a_chosen_format_has_its_severitys_colour_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """A node writes its log to the launcher without colours: there is no terminal at its end."""
    monkeypatch.setenv("RCUTILS_CONSOLE_OUTPUT_FORMAT", "[{severity}] {message}")
    lines = {
        "[WARN] \u00e9": "\x1b[33m[WARN] \u00e9\x1b[0m",
        "[ERROR] b": "\x1b[31m[ERROR] b\x1b[0m",
        "[INFO] c": "[INFO] c",
        "[FATAL] \x1b[1mown": "[FATAL] \x1b[1mown",
        "a [WARN] ": "a [WARN] ",
        "": "",
    }
    made = layout(Terminal(), ["a"])
    assert [line(made, "a", each).partition(" ")[2] for each in lines] == [f"{each}\n" for each in lines.values()]
    monkeypatch.setenv("RCUTILS_COLORIZED_OUTPUT", "0")
    made = layout(Terminal(), ["a"])
    assert [line(made, "a", each).partition(" ")[2] for each in lines] == [f"{each}\n" for each in lines]
