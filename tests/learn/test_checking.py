"""Checks in this process: syntax errors, exceptions and ends of a student's file, told with their lines."""

from __future__ import annotations

import io
import re
import shutil
from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.grading.mistakes import LONGEST_TEXT, Mistake, mistake_in
from robolink.learn.checking import check
from robolink.learn.exercise import Exercise, chosen, read_course, read_exercise
from robolink.learn.lines import WIDTH, reported
from robolink.learn.report import Line, Report
from robolink.learn.trial import Trial

COURSE = read_course()
HELLO, STOP = chosen(COURSE, "hello"), chosen(COURSE, "stop")
SOLUTIONS = Path(__file__).parent / "solutions"


def tried(text: str, folder: Path, exercise: Exercise = HELLO) -> Report:
    file = folder / exercise.file
    file.write_text(text, encoding="utf-8")
    return check(exercise, file)


def solution(exercise: Exercise) -> str:
    return (SOLUTIONS / exercise.file).read_text(encoding="utf-8")


def test_a_syntax_error_has_its_line(tmp_path: Path) -> None:
    report = tried(solution(HELLO).replace("def main():", "def main()"), tmp_path)
    assert report.mistake is not None
    assert (report.mistake.kind, report.mistake.code) == ("syntax", "def main()")
    assert not report.passed
    lines = list(reported(HELLO, report, "pt"))
    assert lines[0] == f"  ✗ 02_hello.py não é Python válido na linha {report.mistake.line}:"
    assert lines[1].endswith("| def main()")


def test_what_windows_editors_put_before_a_program_is_no_mistake(tmp_path: Path) -> None:
    assert tried("\ufeff" + solution(HELLO), tmp_path).passed


def test_what_json_lacks_is_in_a_report_in_escapes(tmp_path: Path) -> None:
    report = tried(solution(HELLO).replace("rclpy.spin(node)", "raise ValueError('\\ud800' + 'x' * 10_000)"), tmp_path)
    assert msgspec.json.decode(msgspec.json.encode(report), type=Report) == report
    assert report.mistake is not None
    assert report.mistake.text.startswith("ValueError: \\ud800xxx")
    assert len(report.mistake.text) < 2 * LONGEST_TEXT


def test_a_line_without_end_is_cut(tmp_path: Path) -> None:
    report = tried("x = '" + "a" * 100_000, tmp_path)
    assert max(map(len, reported(HELLO, report, "en"))) < LONGEST_TEXT


def test_a_mistake_without_words_has_its_name(tmp_path: Path) -> None:
    report = tried("x = " + "-" * 200_000 + "1", tmp_path)
    assert report.mistake is not None
    assert re.fullmatch(r"02_hello.py: (MemoryError|RecursionError).*", report.mistake.text)


@pytest.mark.parametrize(
    "own", ["def is_over(self):\n        return True", "@property\n    def is_over(self):\n        raise ValueError"]
)
def test_a_class_may_have_names_that_a_program_has(own: str, tmp_path: Path) -> None:
    assert tried(solution(HELLO).replace("\n\n\ndef main", f"\n\n    {own}\n\n\ndef main"), tmp_path).passed


def test_an_exception_at_the_end_has_its_line(tmp_path: Path) -> None:
    raises = "rclpy.get_default_context().on_shutdown(lambda: 1 / 0)\n    rclpy.spin(node)"
    report = tried(solution(HELLO).replace("rclpy.spin(node)", raises), tmp_path)
    assert report.mistake is not None
    assert (report.mistake.kind, report.mistake.code) == (
        "exception",
        "    rclpy.get_default_context().on_shutdown(lambda: 1 / 0)",
    )


def test_an_exception_in_a_constructor_has_its_line_and_the_nearest_name(tmp_path: Path) -> None:
    report = tried(solution(HELLO).replace("get_logger", "get_loger"), tmp_path)
    assert report.mistake is not None
    assert report.mistake.kind == "exception"
    assert report.mistake.code == '        self.get_loger().info("hello")'
    assert report.mistake.text.startswith("AttributeError: ")
    assert "Did you mean: 'get_logger'" in report.mistake.text


def test_an_exception_in_a_callback_has_its_line(tmp_path: Path) -> None:
    report = tried(solution(STOP).replace("twist.linear.x", "twist.liner.x"), tmp_path, STOP)
    assert report.mistake is not None
    assert report.mistake.kind == "exception"
    assert "twist.liner.x" in report.mistake.code
    assert "Did you mean: 'linear'" in report.mistake.text
    assert "Traceback" not in "\n".join(reported(STOP, report, "en"))


def test_a_value_of_the_wrong_type_has_its_line(tmp_path: Path) -> None:
    report = tried(solution(STOP).replace("= 0.3 if", "= 'fast' if"), tmp_path, STOP)
    assert report.mistake is not None
    assert report.mistake.kind == "exception"
    assert "expected float64, got 'fast'" in report.mistake.text
    assert report.mistake.code.strip() == "self.publisher.publish(twist)"


def test_a_program_that_asks_the_keyboard_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO())
    report = tried("name = input('name? ')\n" + solution(HELLO), tmp_path)
    assert list(reported(HELLO, report, "pt"))[:3] == [
        "  ✗ seu programa espera o teclado na linha 1, e um teste não tem teclado: tire",
        "    o input()",
        "       1 | name = input('name? ')",
    ]


@pytest.mark.parametrize("ending", ["raise SystemExit(3)", "exit(3)", "import sys; sys.exit(3)"])
def test_a_program_that_exits_is_told(ending: str, tmp_path: Path) -> None:
    report = tried(solution(HELLO).replace("    rclpy.spin(node)", f"    {ending}"), tmp_path)
    assert not report.passed


@pytest.mark.parametrize(
    "text", ["", "x = 1\n", "print('hi')\n", "import this_is_nowhere\n", "raise KeyboardInterrupt\n"]
)
def test_a_file_without_a_node_is_told(text: str, tmp_path: Path) -> None:
    report = tried(text, tmp_path)
    assert not report.passed
    assert "Traceback" not in "\n".join(reported(HELLO, report, "en"))


@pytest.mark.parametrize("text", ["", "# 02_hello: a comment alone\n"])
def test_a_file_that_was_not_saved_is_told(text: str, tmp_path: Path) -> None:
    report = tried(text, tmp_path)
    assert next(reported(HELLO, report, "en")) == "  ✗ 02_hello.py is empty, or has only comments"


def test_a_file_that_is_not_there_is_told(tmp_path: Path) -> None:
    report = check(HELLO, tmp_path / "02_hello.py")
    assert report.mistake == Mistake("file", "02_hello.py: No such file or directory")


@given(st.binary(max_size=200))
def test_any_bytes_are_python_or_a_mistake(content: bytes) -> None:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "any.py")
        file.write_bytes(content)
        found = mistake_in(file)
        assert found is None or found.kind in ("syntax", "empty", "file")


CHECKED = """
def check(trial):
    {body}
"""


@pytest.fixture
def made(tmp_path: Path) -> Exercise:
    folder = tmp_path / "01_mine"
    folder.mkdir()
    (folder / "exercise.yaml").write_text(
        "title: {en: Mine}\ntext: {en: Do it.}\nresults: {ok: {good: {en: 'fine {n}'}, bad: {en: bad}}}\n"
    )
    (folder / "given.py").write_text("x = 1\n")
    (folder / "check.py").write_text(CHECKED.format(body="trial.tell('ok', trial.module().x == 1, n=1)"))
    return read_exercise(folder)


def test_a_check_about_a_module(made: Exercise, tmp_path: Path) -> None:
    assert tried("x = 1", tmp_path, made).lines == [Line(True, "fine 1")]
    assert tried("x = 2", tmp_path, made).lines == [Line(False, "bad")]


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("trial.tell('okay', True)", "no result 'okay' in exercise.yaml (did you mean 'ok'?)"),
        ("trial.tell('ok', True)", "KeyError: 'n'"),
        ("1 / 0", "ZeroDivisionError"),
        ("pass", ""),
    ],
)
def test_a_broken_check_is_not_the_students_fault(made: Exercise, body: str, words: str, tmp_path: Path) -> None:
    (made.folder / "check.py").write_text(CHECKED.format(body=body))
    report = tried("x = 1", tmp_path, made)
    assert not report.passed
    if words:
        assert report.mistake is not None
        assert report.mistake.kind == "check"
        assert words in report.mistake.text


def test_a_trial_tells_how_far_it_is(tmp_path: Path) -> None:
    trial = Trial(HELLO, tmp_path / "x.py", "en")
    assert trial.moment() == (0.0, 0)
    trial.run(2.0)
    assert trial.moment() == (2.0, 0)
    trial.close()


def test_lines_are_not_wider_than_a_terminal() -> None:
    report = Report([Line(False, "word " * 60)])
    assert max(map(len, reported(HELLO, report, "en"))) <= WIDTH


@pytest.mark.parametrize(
    "check_text", ["trial.world('nowhere')", "trial.module()\n    trial.nothing()"], ids=["a world", "a name"]
)
def test_mistakes_of_a_check_are_not_the_student_s(check_text: str, tmp_path: Path) -> None:
    shutil.copytree(HELLO.folder, tmp_path / "01_mine")
    (tmp_path / "01_mine" / "check.py").write_text(f"def check(trial):\n    {check_text}\n")
    report = tried(solution(HELLO), tmp_path, read_exercise(tmp_path / "01_mine"))
    assert report.mistake is not None
    assert report.mistake.kind == "check"
