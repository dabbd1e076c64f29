"""Exercises of a teacher: the template works, and a proof finds what is wrong with one."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from robolink.exceptions import DocumentError
from robolink.grading.languages import Language
from robolink.learn.checking import check
from robolink.learn.exercise import Exercise, ExerciseError, read_course, read_exercise
from robolink.learn.report import Report
from robolink.learn.teaching import new_exercise, proofs


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def here_checked(exercise: Exercise, file: Path, language: Language) -> Report:
    return check(exercise, file, language)


def found(course: list[Exercise]) -> list[tuple[bool, str]]:
    return [(each.good, each.text) for each in proofs(course, here_checked)]


@pytest.mark.slow
def test_a_new_exercise_fails_as_given_and_its_solution_passes(here: Path) -> None:
    assert new_exercise("stop_early") == here / "exercises/01_stop_early"
    (given, solution) = found(read_course(here / "exercises"))
    assert given == (True, "given.py fails: it drove 0.0 m in ten seconds, and not 2 m")
    assert solution[0]
    assert solution[1].startswith("solution.py passes in ")


@pytest.mark.slow
def test_a_proof_speaks_portuguese(here: Path) -> None:
    folder = new_exercise("stop_early", language="pt")
    assert "# Dicas, uma de cada vez" in (folder / "exercise.yaml").read_text(encoding="utf-8")
    assert "Teste de stop_early" in (folder / "check.py").read_text(encoding="utf-8")
    (folder / "solution.py").write_text("")
    found = [each.text for each in proofs(read_course(here / "exercises"), here_checked, "pt")]
    assert found == [
        "given.py falha: ele andou 0.0 m em dez segundos, e não 2 m",
        "solution.py falha: solution.py está vazio, ou só tem comentários",
    ]


def test_they_are_numbered_and_made_where_the_others_are(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    new_exercise("one")
    assert new_exercise("two").name == "02_two"
    monkeypatch.chdir(here / "exercises")
    assert new_exercise("three") == here / "exercises/03_three"
    assert new_exercise("other", str(here / "more")) == here / "more/01_other"
    assert [each.name for each in read_course(here / "exercises")] == ["one", "two", "three"]


@pytest.mark.parametrize("name", ["", "Two", "2", "a b", "../up", "é", "a" * 61])
def test_names_that_are_none(name: str, here: Path) -> None:
    with pytest.raises(ExerciseError, match="is not a name for an exercise"):
        new_exercise(name)
    assert list(here.iterdir()) == []


def test_a_name_that_is_taken(here: Path) -> None:
    new_exercise("one")
    with pytest.raises(ExerciseError, match="has an exercise 'one' already"):
        new_exercise("one")


@pytest.mark.slow
def test_a_proof_finds_what_is_wrong(here: Path) -> None:
    folder = new_exercise("one")
    (folder / "given.py").write_bytes((folder / "solution.py").read_bytes())
    (folder / "solution.py").write_text("x = (\n")
    (given, solution) = found(read_course(here / "exercises"))
    assert given == (False, "given.py passes already: there is nothing to do")
    assert not solution[0]
    assert solution[1].startswith("solution.py fails: SyntaxError: ")
    (folder / "solution.py").unlink()
    (folder / "check.py").write_text("def check(trial):\n    trial.tell('nothing', True)\n")
    ((good, text),) = found(read_course(here / "exercises"))
    assert not good
    assert text.startswith("the check is broken: no result 'nothing' in exercise.yaml")


def test_an_exercise_in_one_language_serves_for_both(here: Path) -> None:
    folder = new_exercise("one")
    settings = folder / "exercise.yaml"
    settings.write_text(
        "title: {pt: Um}\ntext: {pt: Dois}\nresults: {}\ncomments: {todo: {pt: Três}}\n", encoding="utf-8"
    )
    (exercise,) = read_course(here / "exercises")
    assert exercise.given_text("en").startswith("# Um\n#\n# Dois\n\n")
    assert "        # Três\n" in exercise.given_text("en")


def test_a_comment_that_is_nowhere(here: Path) -> None:
    folder = new_exercise("one")
    (folder / "exercise.yaml").write_text("title: {en: a}\ntext: {en: b}\nresults: {}\n")
    (exercise,) = read_course(here / "exercises")
    with pytest.raises(ExerciseError, match=r"no comment 'todo' in exercise\.yaml"):
        exercise.given_text("en")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("title: {en: a}\ntext: {en: b}\nresult: {}\n", "unknown key 'result'"),
        ("title: {en: a}\n", "missing"),
        ("title: a\n", "expected"),
        ("{", "exercise.yaml:"),
        ("", "exercise.yaml:"),
    ],
)
def test_a_mistake_in_its_file_has_its_place(here: Path, text: str, told: str) -> None:
    folder = new_exercise("one")
    (folder / "exercise.yaml").write_text(text)
    (exercise,) = read_course(here / "exercises")
    with pytest.raises(DocumentError, match=re.escape(told)) as error:
        exercise.given_text("en")
    assert "\n" not in str(error.value)


def test_both_templates_make_the_same_exercise(here: Path) -> None:
    """They differ in comments and docstrings alone."""
    english, portuguese = new_exercise("one"), new_exercise("two", language="pt")
    assert read_exercise(english).settings == read_exercise(portuguese).settings
    code = [ast.parse((each / "check.py").read_text(encoding="utf-8")).body[1:] for each in (english, portuguese)]
    texts = [ast.unparse(function).splitlines()[2:] for (function,) in code]
    assert texts[0] == texts[1]
