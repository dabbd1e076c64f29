"""Each exercise: as given it fails with a sentence of its own, and its solution passes; both within two seconds."""

from __future__ import annotations

import ast
import re
import time
from pathlib import Path
from typing import TypeGuard

import pytest

from robolink.grading.languages import LANGUAGES, Language
from robolink.learn.checking import check
from robolink.learn.exercise import Exercise, read_course
from robolink.learn.report import Report

SOLUTIONS = Path(__file__).parent / "solutions"
COURSE = read_course()
LONGEST = 2.0
"""Most seconds of a processor that a check may take; a process takes 0.3 more (docs/reference/exercises.md)."""

FAILS = {
    "01_walk": "a step in direction 90 ended at (-0.13, 0.27), and not at (0.00, 0.30)",
    "02_hello": "there is no node that stays: main() comes to its end at once",
    "03_timer": 'after 1.5 s the log should have "count 1", and has count 0',
    "04_publisher": "nothing came on cmd_vel in three seconds: is publish called, and often enough?",
    "05_ramp": "its first speeds are 0.0, 0.1, 0.1, 0.1",
    "06_square": "it drove on until it touched the wall: it never turned",
    "07_subscriber": "a scan came, and nothing was published on nearest: does it subscribe to scan?",
    "08_stop": "it drove 3.8 m into the wall",
    "09_react": "3 m are free ahead, and it drives with 0.00 m/s, not 0.30",
    "10_odometry": "after 2.5 m it still drives with 0.4 m/s",
    "11_talk": "there is no node called listener, only talker",
    "12_service": "the call of power with True got no answer: does the callback return the response?",
    "13_client": "AttributeError: 'NoneType' object has no attribute 'sum'",
    "14_parameter": "the parameter was set to 0.5, and it still asks for 0.30 m/s",
    "15_limits": "it accepted 3.0 m/s, which is far too fast",
    "16_launch": "16_launch.yaml:11:5: nodes[0].parameter: unknown key 'parameter': write `parameters`",
    "17_two_robots": "ada needs a node ada/reactive_controller; there is: reactive_controller",
    "18_pid": "after ten seconds the speed is 0.607 m/s, and should be from 0.95 to 1.05",
    "19_qos": "who subscribed two seconds later heard nothing",
    "20_frames": "base_link is the child of laser: it should be the other way round",
    "21_where": 'LookupException: "odom" passed to lookupTransform argument target_frame does not exist.',
    "22_action": "the goal ended as aborted: whoever asked must think that it failed",
    "23_bag": "the robot drove 1.94 m, and driven() returned 250.00",
    "24_testing": "it passes with a program that never drives",
    "25_camera": "the yellow thing is in the middle, and it said 40.00",
    "26_safe": "no scan came for two seconds, and it still drives with 0.3 m/s",
    "27_states": "in half a minute its states were: DRIVE, BACK",
    "28_follow_wall": "it drove 0.0 m in five seconds",
    "29_particles": "particles at 2.0 m drove 0.5 m, and are at 2.00 m on average, not at 2.50",
    "30_estimate": "its frame is '', and not 'map': a place needs to say from where it is measured",
    "31_tour": "the robot was on its way to the first place, and the goal of another came",
}
"""First sentence that is bad, for the file as it is given."""

named = pytest.mark.parametrize("exercise", COURSE, ids=[each.folder.name for each in COURSE])


def tried(exercise: Exercise, text: str, folder: Path, language: Language = "en") -> Report:
    file = folder / exercise.file
    file.write_text(text, encoding="utf-8")
    begin = time.process_time()
    report = check(exercise, file, language)
    assert time.process_time() - begin < LONGEST
    return report


def told(report: Report) -> str:
    """Return the sentence, or the mistake, that a student reads first."""
    bad = next((each.text for each in report.lines if not each.good), "")
    return bad or (report.mistake.text if report.mistake is not None else "")


def solution(exercise: Exercise) -> str:
    return (SOLUTIONS / exercise.file).read_text(encoding="utf-8")


@pytest.mark.slow
@named
def test_as_given_it_fails_with_the_right_sentence(exercise: Exercise, tmp_path: Path) -> None:
    report = tried(exercise, exercise.given_text("en"), tmp_path)
    assert not report.passed
    assert told(report) == FAILS[exercise.folder.name]


@pytest.mark.slow
@named
def test_its_solution_passes(exercise: Exercise, tmp_path: Path) -> None:
    report = tried(exercise, solution(exercise), tmp_path, "pt")
    assert report.mistake is None
    assert [each.text for each in report.lines if not each.good] == []
    assert report.passed


@named
def test_it_has_all_texts_in_both_languages(exercise: Exercise) -> None:
    settings = exercise.settings
    outcomes = [text for each in settings.results.values() for text in each]
    for text in (settings.title, settings.text, *settings.hints, *settings.comments.values(), *outcomes):
        assert text.en.strip()
        assert text.pt.strip()
    for each in settings.results.values():
        for text in each:
            assert placeholders(text.en) == placeholders(text.pt)
    assert 2 <= len(settings.hints) <= 5


@named
def test_its_sentences_are_those_that_its_check_tells(exercise: Exercise) -> None:
    tree = ast.parse((exercise.folder / "check.py").read_text(encoding="utf-8"))
    calls = [each for each in ast.walk(tree) if isinstance(each, ast.Call)]
    told = {each.args[0].value for each in calls if ast.unparse(each.func) == "trial.tell" and is_text(each.args[0])}
    texts = {each.value for each in ast.walk(tree) if is_text(each)}
    assert told <= set(exercise.settings.results) <= texts


@named
def test_what_is_given_fits_a_terminal_and_leaves_no_placeholder(exercise: Exercise) -> None:
    for language in LANGUAGES:
        text = exercise.given_text(language)
        assert max(map(len, text.splitlines())) <= 100
        assert not re.search(r"# \{\w+\}", text)
        for line in exercise.text(language).splitlines():
            assert len(line) <= 78


def test_every_exercise_has_a_solution_and_a_sentence() -> None:
    assert sorted(each.file for each in COURSE) == sorted(each.name for each in SOLUTIONS.iterdir() if each.is_file())
    assert sorted(each.folder.name for each in COURSE) == sorted(FAILS)


def test_no_solution_is_in_the_package() -> None:
    for each in COURSE:
        assert solution(each) not in [path.read_text(encoding="utf-8") for path in each.folder.glob("*.*")]


def placeholders(text: str) -> set[str]:
    return set(re.findall(r"\{(\w+)", text))


def is_text(node: ast.AST) -> TypeGuard[ast.Constant]:
    return isinstance(node, ast.Constant)
