"""docs/learn.md: its tables name all verbs and races, and what its consoles show is what the commands print."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.cli.root import command
from robolink.learn.checking import check
from robolink.learn.exercise import chosen, read_course
from robolink.learn.lines import reported
from robolink.learn.trial import Trial
from robolink.race.races import RACES
from robolink.race.result import Result
from robolink.race.table import table

TEXT = (Path(__file__).parents[2] / "docs" / "learn.md").read_text(encoding="utf-8")
CONSOLES = re.findall(r"```console\n(.*?)```", TEXT, re.DOTALL)
Captured = pytest.CaptureFixture[str]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("LC_ALL", "en_US.UTF-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def shown(start: str) -> list[str]:
    """Return the lines of the console that begins with this command, below it and before the next command."""
    (console,) = (each for each in CONSOLES if f"$ {start}\n" in each)
    below: str = console.partition(f"$ {start}\n")[2]
    return below.partition("$ ")[0].splitlines()


def test_every_verb_is_named() -> None:
    root = command()
    context = root.make_context("robolink", [], resilient_parsing=True)
    for noun in ("learn", "new"):
        for verb in root.get_command(context, noun).commands:
            assert f"{noun} {verb}" in TEXT


def test_every_race_is_named_with_its_rule() -> None:
    for name in RACES:
        assert f"| `{name}` |" in TEXT
    first = table(RACES["maze"], [Result()], 3)
    assert shown("robolink race maze class --seed 3")[0] == next(first)


def test_what_a_check_may_use_is_there() -> None:
    for name in re.findall(r"`trial\.(\w+)", TEXT):
        assert hasattr(Trial, name)


def test_start_and_check_print_what_is_shown(here: Path, capsys: Captured) -> None:
    assert main(["learn", "start"]) == 0
    assert capsys.readouterr().out.splitlines() == shown("robolink learn start")
    exercise = chosen(read_course(), "stop")
    report = check(exercise, here / "learn_robolink" / exercise.file)
    capsys.readouterr()
    head, *lines = [each for each in shown("robolink learn check stop") if each]
    assert head == f"{exercise.file}: {exercise.title('en')}"
    assert lines == list(reported(exercise, report, "en"))


def test_new_exercises_and_projects_are_made_as_shown(here: Path, capsys: Captured) -> None:
    assert main(["learn", "new", "stop_early"]) == 0
    assert capsys.readouterr().out.replace("\\", "/").splitlines()[:4] == shown("robolink learn new stop_early")
    assert main(["learn", "start", "class", "--from", "exercises"]) == 0
    assert capsys.readouterr().out.splitlines()[:1] == shown("robolink learn start class --from exercises")
    assert main(["new", "project", "my_robot"]) == 0
    told = capsys.readouterr().out.replace("\\", "/").splitlines()
    wanted = shown("robolink new project my_robot")
    gap = wanted.index("...")
    assert told[:gap] == wanted[:gap]
    assert told[-len(wanted[gap + 1 :]) :] == wanted[gap + 1 :]
