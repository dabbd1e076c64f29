"""robolink learn: its verbs, as a student types them."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from robolink.cli.learn import exercise_names, work
from robolink.cli.main import main
from robolink.grading.languages import Language
from robolink.grading.mistakes import Mistake
from robolink.learn.exercise import Exercise, read_course
from robolink.learn.report import Line, Report

Captured = pytest.CaptureFixture[str]
SOLUTIONS = Path(__file__).parents[2] / "learn" / "solutions"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("LC_ALL", "en_US.UTF-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def student(here: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> Path:
    assert main(["learn", "start"]) == 0
    monkeypatch.chdir(here / "learn_robolink")
    capsys.readouterr()
    return here / "learn_robolink"


def fake(monkeypatch: pytest.MonkeyPatch, *reports: Report) -> list[str]:
    """Let checks have these results, one after the other; return the files that are checked."""
    left, checked = list(reports), list[str]()

    def check(exercise: Exercise, file: Path, language: Language) -> Report:
        assert file.name == exercise.file
        checked.append(f"{exercise.name} {language}")
        return left.pop(0)

    monkeypatch.setattr(work, "check_apart", check)
    return checked


GOOD = Report([Line(True, "it drives")], seconds=0.8)
BAD = Report([Line(False, "it stands")], seconds=0.8)


def test_before_the_start_it_lists_them_all(here: Path, capsys: Captured) -> None:
    assert main(["learn"]) == 0
    out = capsys.readouterr().out
    assert main(["learn", "list"]) == 0
    assert capsys.readouterr().out == out
    assert "02_hello.py" in out
    assert "A first node" in out
    assert main(["learn", "--language", "pt"]) == 0
    assert "Um primeiro node" in capsys.readouterr().out


def test_start_says_where_to_go(here: Path, capsys: Captured) -> None:
    assert main(["learn", "start", "aula", "--language", "pt"]) == 0
    out = capsys.readouterr().out
    assert out == f"exercícios em aula: {len(read_course())}\ncd aula, e depois: robolink learn\n"
    assert main(["learn", "start", "aula"]) == 0
    assert capsys.readouterr().out.startswith("todos os exercícios já estão em aula\n")


def test_a_check_that_passes_says_what_is_next(
    student: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    first, second, *_ = read_course()
    fake(monkeypatch, GOOD)
    assert main(["learn", "check"]) == 0
    out = capsys.readouterr().out
    assert "  ✓ it drives\n" in out
    assert f"{first.file} is done (0.8 s)\n" in out
    assert f"next: {second.file}: {second.title('en')}\n" in out
    assert main(["learn"]) == 0
    assert f"  ✓ {first.file}" in capsys.readouterr().out


def test_a_check_that_fails_ends_with_1(student: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    checked = fake(monkeypatch, BAD, Report(mistake=Mistake("exception", "ValueError: x", 3, "    f(x)")))
    assert main(["learn", "check", "stop", "--language", "pt"]) == 1
    assert "  ✗ it stands\n" in capsys.readouterr().out
    assert main(["learn", "check", "2"]) == 1
    out = capsys.readouterr().out
    assert "seu programa parou com um erro na linha 3:\n       3 |     f(x)\n    ValueError: x\n" in out
    assert checked == ["stop pt", "hello pt"]


def test_all_are_checked_with_a_line_for_each(student: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    count = len(read_course())
    fake(monkeypatch, *[GOOD] * (count - 1), BAD)
    assert main(["learn", "check", "--all"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == count + 1
    assert lines[-1] == f"{count - 1} of {count} exercises done"


def test_hints_show_and_reset(student: Path, capsys: Captured) -> None:
    assert main(["learn", "hint", "hello"]) == 0
    assert capsys.readouterr().out.startswith("hint 1 of 3: The name is")
    assert main(["learn", "hint", "hello"]) == 0
    assert capsys.readouterr().out.startswith("hint 2 of 3: ")
    assert main(["learn", "show", "hello"]) == 0
    assert "A node is a program" in capsys.readouterr().out
    assert main(["learn", "reset", "hello"]) == 0
    assert capsys.readouterr().out == "02_hello.py is as it was at the beginning; yours is 02_hello.mine.py\n"


def test_watch_checks_at_once_and_ends_with_ctrl_c(
    student: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    fake(monkeypatch, BAD, BAD)

    def interrupt(seconds: float) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("robolink.cli.learn.work.time.sleep", interrupt)
    assert main(["learn", "watch"]) == 130
    assert "it stands" in capsys.readouterr().out
    assert main(["learn", "watch", "stop"]) == 130
    out = capsys.readouterr().out
    assert "08_stop.py: Stop before the wall" in out
    assert out.endswith("a hint: robolink learn hint stop\n"), "the hint of this exercise, not of the next"


def test_beside_the_folder_one_is_told_where_it_is(
    here: Path, student: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    assert main(["learn", "start"]) == 0
    assert capsys.readouterr().out.startswith("all exercises are here already\n")
    monkeypatch.chdir(here)
    assert main(["learn", "check"]) == 1
    assert capsys.readouterr().err == f"robolink: the exercises are in {student.name}: cd {student.name}\n"
    assert main(["learn"]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == f"cd {student.name}, then: robolink learn"


def test_mistakes_are_one_line(here: Path, student: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    assert main(["learn", "check", "helo"]) == 1
    assert capsys.readouterr().err == "robolink: no exercise named 'helo' (did you mean 'hello'?)\n"
    assert main(["learn", "--language", "fr"]) == 2
    assert "'fr' is none of en, pt" in capsys.readouterr().err
    (here / "empty").mkdir()
    monkeypatch.chdir(here / "empty")
    assert main(["learn", "check"]) == 1
    assert capsys.readouterr().err.startswith("robolink: no exercises in this folder or above it")
    monkeypatch.setenv("LC_ALL", "pt_BR.UTF-8")
    assert main(["learn", "check"]) == 1
    assert capsys.readouterr().err.startswith("robolink: não há exercícios nesta pasta nem acima dela")


def test_a_file_that_is_gone_is_told(student: Path, capsys: Captured) -> None:
    (student / "02_hello.py").unlink()
    assert main(["learn", "check", "hello"]) == 1
    told = "robolink: there is no 02_hello.py here: `robolink learn reset hello` writes it again\n"
    assert capsys.readouterr().err == told
    assert main(["learn", "reset", "hello"]) == 0
    assert capsys.readouterr().out == "02_hello.py is there again\n"
    assert (student / "02_hello.py").is_file()


def test_names_are_completed(student: Path) -> None:
    assert "hello" in exercise_names()


@pytest.mark.processes
def test_a_real_check(student: Path, capsys: Captured) -> None:
    assert main(["learn", "check", "hello"]) == 1
    assert "there is no node that stays" in capsys.readouterr().out
    (student / "02_hello.py").write_bytes((SOLUTIONS / "02_hello.py").read_bytes())
    assert main(["learn", "check", "hello"]) == 0
    assert "02_hello.py is done" in capsys.readouterr().out


def test_a_teacher_s_exercises(here: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    assert main(["learn", "new", "stop_early"]) == 0
    assert f"made {Path('exercises/01_stop_early/check.py')}\n" in capsys.readouterr().out
    monkeypatch.setattr("robolink.cli.learn.work.check_apart", lambda *_: BAD)
    assert main(["learn", "prove"]) == 1
    out = capsys.readouterr().out
    assert out == "01_stop_early\n  ✓ given.py fails: it stands\n  ✗ solution.py fails: it stands\n"
    assert main(["learn", "start", "aula", "--from", "exercises", "--language", "pt"]) == 0
    monkeypatch.chdir(here / "aula")
    capsys.readouterr()
    assert main(["learn"]) == 0
    assert "01_stop_early.py  Ande para a frente\n" in capsys.readouterr().out
    assert main(["learn", "new", "Bad Name"]) == 1
    assert capsys.readouterr().err.startswith("robolink: 'Bad Name' is not a name for an exercise")


@pytest.mark.skipif(sys.platform == "win32", reason="the quotes of a POSIX shell")
def test_a_folder_is_shown_as_a_shell_takes_it(
    tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["learn", "start", "minha pasta", "--language", "en"]) == 0
    assert "cd 'minha pasta', then: robolink learn" in capsys.readouterr().out
