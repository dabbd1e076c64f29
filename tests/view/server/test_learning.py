"""Exercises on the wire: who may ask for what, two pages at once, and requests that are none."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from robolink.grading.languages import Language
from robolink.learn.exercise import Exercise
from robolink.learn.folder import start_folder
from robolink.learn.page import PageExercises
from robolink.learn.report import Line, Report
from tests.support.view_clients import shown


def exercises(folder: Path) -> PageExercises:
    student = start_folder(str(folder), language="en")
    student.write()

    def check(exercise: Exercise, file: Path, language: Language, *, stop: threading.Event) -> Report:
        text = file.read_text(encoding="utf-8")
        return Report([Line("good" in text, f"{exercise.name} of {len(text)} letters")])

    return PageExercises(student, check=check)


def test_two_pages_are_told_of_the_same_check(tmp_path: Path) -> None:
    with shown(exercises(tmp_path)) as system, system.client() as one, system.client() as other:
        assert one.wait_for("learn")["exercises"][7]["file"] == "08_stop.py"
        (tmp_path / "08_stop.py").write_text("good", encoding="utf-8")
        for page in (one, other):
            told = page.wait_for("exercise", name="stop")
            assert told["report"]["findings"] == [{"mark": "✓", "text": "stop of 4 letters", "below": []}]
        one.send("learn", command="hint", name="stop")
        assert len(other.wait_for("exercise", name="stop")["hints"]) == 1


def test_without_the_token_a_page_looks_and_does_nothing(tmp_path: Path) -> None:
    with shown(exercises(tmp_path)) as system, system.client(token=False) as client:
        client.wait_for("learn", checking=None)  # after the check at the start
        before = {each.name: each.read_bytes() for each in tmp_path.iterdir()}
        for command in ("check", "hint", "reset", "language"):
            client.send("learn", command=command, name="pt" if command == "language" else "stop")
            assert f"learn {command} is refused" in client.wait_for("status", level=2)["message"]
        client.send("learn", command="show", name="stop")
        assert "report" not in client.wait_for("exercise", name="stop")
        assert {each.name: each.read_bytes() for each in tmp_path.iterdir()} == before


def test_a_wrong_token_gets_nothing(tmp_path: Path) -> None:
    with (
        shown(exercises(tmp_path)) as system,
        pytest.raises(InvalidStatus, match="403"),
        connect(f"ws://127.0.0.1:{system.view.port}/?token=wrong"),
    ):
        pass


def test_nonsense_is_told_in_one_line(tmp_path: Path) -> None:
    with shown(exercises(tmp_path)) as system, system.client() as client:
        for command, name in (("delete", "stop"), ("check", "../../08_stop.py"), ("show", "<b>"), ("language", "fr")):
            client.send("learn", command=command, name=name)
            message = client.wait_for("status", level=2)["message"]
            assert "\n" not in message
            assert ("Invalid enum value 'delete'" if command == "delete" else f"named '{name}'") in message
        client.send("learn", command="check", name="x" * 2000)
        assert "learn: " in client.wait_for("status", level=2)["message"]


def test_a_server_without_exercises_says_where_they_are() -> None:
    with shown() as system, system.client() as client:
        client.send("learn", command="show", name="stop")
        assert "robolink learn view" in client.wait_for("status", level=2)["message"]
