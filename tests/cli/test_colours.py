"""Colours of the command line: where there is a terminal, and NO_COLOR is not set."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.launch.looking import validate
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


def test_marks_have_their_colours_and_the_rest_none(monkeypatch: pytest.MonkeyPatch) -> None:
    from robolink.cli.shared.marks import say_marked

    terminal = on_terminal(monkeypatch)
    say_marked(["  ✓ done", "✗ no\x1b[2J", "next: ✓"])
    assert terminal.getvalue() == "  \x1b[32m✓\x1b[0m done\n\x1b[31m✗\x1b[0m no\\x1b[2J\nnext: ✓\n"


def test_marks_are_letters_where_the_terminal_lacks_them(monkeypatch: pytest.MonkeyPatch) -> None:
    from robolink.cli.shared.marks import say_marked

    class Old(io.StringIO):
        encoding = "cp1252"

    old = Old()
    monkeypatch.setattr(sys, "stdout", old)
    say_marked(["✓ → ✗ é"])
    assert old.getvalue() == "+ > x é\n"


def test_no_color_and_pipes_have_none(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)
    assert styled("a", "31", io.StringIO()) == styled("a", "31", None) == "a"
    monkeypatch.setenv("NO_COLOR", "1")
    assert not wants_colour(terminal)
    assert main(["topic", "--help"]) == 0
    assert main(["topicc"]) == 2
    assert "\x1b" not in terminal.getvalue()


def test_a_note_has_a_yellow_name(monkeypatch: pytest.MonkeyPatch) -> None:
    from robolink.cli.shared.output import tell

    terminal = on_terminal(monkeypatch)
    tell("robolink: left out\x1b[2J")
    tell("no note, robolink: x")
    assert terminal.getvalue() == "\x1b[33mrobolink:\x1b[0m left out\\x1b[2J\nno note, robolink: x\n"


def test_checks_have_their_colours(monkeypatch: pytest.MonkeyPatch) -> None:
    from robolink.cli import doctor
    from robolink.cli.doctor import checks, facts, gathering

    def always(verdict: facts.Verdict) -> Callable[[facts.Facts], facts.Verdict]:
        return lambda found: verdict

    verdicts = [facts.Verdict("fine"), facts.Verdict("", (), ("odd\x1b[2J", "odder")), facts.Verdict("", ("broken",))]
    found = [facts.Check(f"c{index}", "m", always(each)) for index, each in enumerate(verdicts)]
    terminal = on_terminal(monkeypatch)
    monkeypatch.setattr(checks, "CHECKS", found)
    monkeypatch.setattr("robolink.cli.doctor.dds_checks.DDS_CHECKS", [])
    monkeypatch.setattr("robolink.cli.doctor.graph_checks.GRAPH_CHECKS", [])
    monkeypatch.setattr(gathering, "gather", lambda: type("Facts", (), {"seen": type("Seen", (), {"error": ""})}))
    monkeypatch.setattr("robolink.cli.doctor.report.sections", lambda facts: [])
    assert main(["doctor"]) == 1
    assert terminal.getvalue().splitlines() == [
        "\x1b[32mok\x1b[0m    c0              fine",
        "\x1b[33mWARN\x1b[0m  c1              odd\\x1b[2J",
        "                      odder",
        "\x1b[31mFAIL\x1b[0m  c2              broken",
        "",
        "\x1b[31m1/3 check(s) failed\x1b[0m",
        "",
        "Failed modules: m",
        doctor.BY_SYMPTOM,
    ]


@pytest.mark.parametrize(
    ("node", "code", "shown"), [("world", 0, "\x1b[32mno mistake found\x1b[0m in "), ("worl", 1, "")]
)
def test_what_validate_finds_has_its_colour(
    node: str, code: int, shown: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(validate, "validate", lambda entries: validate.Report([], []))
    path = tmp_path / "made.yaml"
    path.write_text(f"nodes: [node: {node}]\n")
    terminal = on_terminal(monkeypatch)
    assert main(["launch", str(path), "--validate"]) == code
    expected = shown + str(path) if shown else f"\x1b[31m{path}:1:15\x1b[0m: nodes[0].node: no node named 'worl'"
    assert expected in terminal.getvalue()
