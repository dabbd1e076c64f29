"""Exercises for the page: what is told of checks, hints and saves, and folders that are gone meanwhile."""

from __future__ import annotations

import queue
import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.grading.languages import Language
from robolink.grading.mistakes import Mistake
from robolink.learn.exercise import Exercise
from robolink.learn.folder import StudentFolder, start_folder
from robolink.learn.lines import reported
from robolink.learn.page import Operation, PageExercises
from robolink.learn.report import Line, Report

GOOD = Report([Line(True, "it drives")], seconds=0.8)
BAD = Report(
    [Line(False, "it stands")], Mistake("exception", "ValueError: \x1b[2J", 3, "f(x)"), printed="a\nb", seconds=0.8
)
WITHIN = 10.0


class Desk:
    """Exercises of a folder with checks that have given results, and all that the pages are told."""

    def __init__(self, folder: StudentFolder, *reports: Report) -> None:
        self.left, self.checked = [*reports], list[str]()
        self.told: queue.Queue[Operation] = queue.Queue()
        self.exercises = PageExercises(folder, check=self._check)

    def _check(self, exercise: Exercise, file: Path, language: Language, *, stop: threading.Event) -> Report:
        self.checked.append(f"{exercise.name} {language}")
        return self.left.pop(0) if self.left else BAD

    def wait_for(self, op: str, **fields: Any) -> Operation:
        """Return the next operation of a name that is told, with these fields."""
        while True:
            found = self.told.get(timeout=WITHIN)
            if found["op"] == op and all(found[name] == value for name, value in fields.items()):
                return found


@contextmanager
def desk(folder: Path, *reports: Report, language: Language = "en") -> Iterator[Desk]:
    student = start_folder(str(folder), language=language)
    student.write()
    made = Desk(student, *reports)
    made.exercises.begin(made.told.put)
    try:
        yield made
    finally:
        made.exercises.close()


def test_the_next_exercise_is_checked_at_once_and_a_save_checks_its_own(tmp_path: Path) -> None:
    with desk(tmp_path, BAD, GOOD) as made:
        first = made.wait_for("exercise")
        assert (first["name"], first["report"]["passed"]) == ("walk", False)
        assert first["report"]["findings"] == [
            {"mark": "✗", "text": "it stands", "below": []},
            {
                "mark": "✗",
                "text": "your program stopped with an error at line 3:",
                "below": ["   3 | f(x)", "ValueError: \\x1b[2J"],
            },
        ]
        assert first["report"]["printed"] == ["a", "b"]
        (tmp_path / "08_stop.py").write_text("x = 1\n", encoding="utf-8")
        assert made.wait_for("exercise", name="stop")["report"]["passed"]
        state = made.wait_for("learn", current="stop", checking=None)
        assert state["saves"] == 1
        assert state["heading"] == "1 of 31 exercises done"
        states = {each["name"]: each["state"] for each in state["exercises"]}
        assert (states["walk"], states["stop"], states["react"]) == ("next", "done", "open")


def test_the_page_is_told_path_and_code_and_the_line_until_it_changes(tmp_path: Path) -> None:
    with desk(tmp_path) as made:
        made.wait_for("learn", checking=None)
        file = tmp_path / "08_stop.py"
        file.write_bytes(b"\xef\xbb\xbfx = 1\r\ny = '\x1b[2J\xff'\rf(x)\n")
        told = made.wait_for("exercise", name="stop")
        assert told["path"] == str(file)
        assert told["code"] == "x = 1\ny = '\\x1b[2J\ufffd'\nf(x)\n"
        assert told["line"] == 3
        file.write_text("x = 1\n", encoding="utf-8")
        (shown,) = made.exercises.obey("show", "stop")
        assert (shown["code"], shown["line"]) == ("x = 1\n", 0)
        file.unlink()
        (shown,) = made.exercises.obey("show", "stop")
        assert (shown["code"], shown["line"]) == (None, 0)


def test_a_save_during_a_check_ends_that_check(tmp_path: Path) -> None:
    begun = threading.Event()

    def check(exercise: Exercise, file: Path, language: Language, *, stop: threading.Event) -> Report:
        if begun.is_set():
            return GOOD
        begun.set()
        assert stop.wait(WITHIN)
        return BAD

    student = start_folder(str(tmp_path), language="en")
    student.write()
    told: queue.Queue[Operation] = queue.Queue()
    exercises = PageExercises(student, check=check)
    exercises.begin(told.put)
    try:
        assert begun.wait(WITHIN)
        exercises.saved(student.course[0])
        reports = iter(lambda: told.get(timeout=WITHIN), None)
        assert next(each for each in reports if each["op"] == "exercise")["report"]["passed"]
    finally:
        exercises.close()


def test_hints_come_one_by_one_and_count_for_the_terminal_too(tmp_path: Path) -> None:
    with desk(tmp_path, language="pt") as made:
        made.exercises.obey("hint", "stop")
        assert len(made.wait_for("exercise", name="stop")["hints"]) == 1
        start_folder(str(tmp_path)).next_hint(start_folder(str(tmp_path)).chosen("stop"))
        made.exercises.obey("hint", "stop")
        told = made.wait_for("exercise", name="stop")
        assert (len(told["hints"]), told["allHints"]) == (3, 3)
        assert told["hints"][0].startswith("O feixe da frente")


@pytest.mark.slow
def test_progress_and_language_of_another_command_are_shown(tmp_path: Path) -> None:
    with desk(tmp_path) as made:
        made.wait_for("learn", checking=None)
        other = start_folder(str(tmp_path))
        other.finish(other.chosen("hello"))
        assert made.wait_for("learn", heading="1 of 31 exercises done")
        other.speak("pt")
        assert made.wait_for("learn", language="pt")["heading"] == "1 de 31 exercícios feitos"


def test_another_language_checks_again_in_it(tmp_path: Path) -> None:
    with desk(tmp_path) as made:
        made.wait_for("exercise")
        made.exercises.obey("language", "pt")
        told = made.wait_for("exercise")["report"]["findings"]
        assert told[1]["text"] == "seu programa parou com um erro na linha 3:"
        assert made.checked == ["walk en", "walk pt"]
        assert start_folder(str(tmp_path)).language == "pt"


def test_a_reset_keeps_the_student_s_file(tmp_path: Path) -> None:
    with desk(tmp_path) as made:
        made.wait_for("exercise")
        (tmp_path / "08_stop.py").write_text("mine = 1\n", encoding="utf-8")
        (note,) = made.exercises.obey("reset", "stop")
        assert note["message"] == "08_stop.py is as it was at the beginning; yours is 08_stop.mine.py"
        assert (tmp_path / "08_stop.mine.py").read_text(encoding="utf-8") == "mine = 1\n"


def test_only_the_names_of_exercises_count(tmp_path: Path) -> None:
    exercises = PageExercises(start_folder(str(tmp_path / "mine"), language="en"))
    commands: tuple[str, ...] = ("show", "check", "hint", "reset")
    for name in ("../stop", "stop/../../x", "/etc/passwd", "08_stop.py", "", "s\x00p", "x" * 900):
        for command in commands:
            with pytest.raises(NotFoundError, match="no exercise named") as caught:
                exercises.obey(command, name)
            assert len(str(caught.value)) < 300
    assert not any(tmp_path.iterdir())


def test_a_folder_that_is_gone_is_told_and_not_made_again(tmp_path: Path) -> None:
    place = tmp_path / "mine"
    with desk(place, BAD, GOOD) as made:
        made.wait_for("learn", checking=None)
        shutil.rmtree(place)
        commands: tuple[str, ...] = ("hint", "reset")
        for command in commands:
            with pytest.raises(RobolinkError, match="robolink learn start"):
                made.exercises.obey(command, "stop")
        made.exercises.obey("check", "stop")
        assert "robolink learn start" in made.wait_for("status", level=2)["message"]
        assert made.wait_for("exercise", name="stop")["report"]["passed"]
        assert not place.exists()
        shown = made.exercises.obey("show", "stop")
        assert shown[0]["text"].startswith("The robot drives ahead")


def test_a_check_that_cannot_begin_is_told_and_the_next_one_runs(tmp_path: Path) -> None:
    student = start_folder(str(tmp_path), language="en")
    student.write()
    left: list[Report | OSError] = [OSError(28, "No space left on device"), GOOD]

    def check(exercise: Exercise, file: Path, language: Language, *, stop: threading.Event) -> Report:
        found = left.pop(0)
        if isinstance(found, OSError):
            raise found
        return found

    told: queue.Queue[Operation] = queue.Queue()
    exercises = PageExercises(student, check=check)
    exercises.begin(told.put)
    try:
        while (found := told.get(timeout=WITHIN))["op"] != "status":
            pass
        assert "No space left" in found["message"]
        while "checking" not in (found := told.get(timeout=WITHIN)) or found["checking"] is not None:
            pass
        exercises.obey("check", "walk")
        while (found := told.get(timeout=WITHIN))["op"] != "exercise":
            pass
        assert found["report"]["passed"]
    finally:
        exercises.close()


def test_a_line_of_code_that_is_endless_is_cut(tmp_path: Path) -> None:
    exercise = start_folder(str(tmp_path), language="en").course[0]
    report = Report(mistake=Mistake("syntax", "SyntaxError: too many nested parentheses", 1, "(" * 100_000))
    assert max(len(each) for each in reported(exercise, report, "en")) < 250
