"""tools/peer_tests.py: it counts right, tells what nobody has given a reason for, and its pages say what it knows."""

from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]


def _tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("peer_tests", ROOT / "tools" / "peer_tests.py")
    assert spec
    assert spec.loader
    module = sys.modules["peer_tests"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


tool = _tool()
SUITES = {name: tool.read_suite(path) for name, path in tool.suites().items()}


def _generated(name: str) -> str:
    """Return the part of a suite's page that the tool has written."""
    begin, end = tool.marks(name)
    page: str = (ROOT / "docs" / "reference" / SUITES[name].page).read_text(encoding="utf-8")
    return page.partition(begin)[2].partition(end)[0]


# --- The pages --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SUITES)
def test_the_page_has_each_reason_and_no_other(name: str) -> None:
    reasons = tool.reasons_of(SUITES[name])
    for verdict in (tool.FAILED, tool.NOT_APPLICABLE):
        part = _generated(name).partition(f"### {verdict.capitalize()}\n")[2].partition("\n### ")[0]
        told = dict(re.findall(r"^- `([^`]+)`: (.+)$", part, re.MULTILINE))
        assert told == {test: reason.text for test, reason in reasons.items() if reason.verdict == verdict}


@pytest.mark.parametrize("name", SUITES)
def test_the_pages_figures_are_those_of_the_reasons(name: str) -> None:
    suite, reasons = SUITES[name], tool.reasons_of(SUITES[name])
    found = re.findall(r"^\| (\S+) \| (\d+) \| (\d+) \| (\d+) \|$", _generated(name), re.MULTILINE)
    *files, whole = [tool.Row(file, *map(int, counts)) for file, *counts in found]
    assert whole.file == "all"
    assert list(whole[1:]) == [sum(column) for column in zip(*(each[1:] for each in files), strict=True)]
    for row in files:
        of_file = [reason.verdict for test, reason in reasons.items() if test.partition("::")[0] == row.file]
        if not suite.cases:
            assert (row.failed, row.not_applicable) == (of_file.count(tool.FAILED), of_file.count(tool.NOT_APPLICABLE))
        assert bool(row.failed or row.not_applicable) == bool(of_file), row.file


# --- The tool ---------------------------------------------------------------------------------------------------------


def _stage(folder: Path, limit: float = 60.0, **suite: object) -> object:
    described = tool.Suite(repository="ros2/x", version="1", tests="test", **{"cases": False, **suite})
    return tool.Stage(folder, "memory", limit, described, folder / "prefix", folder)


TESTS = """
import unittest
import pytest

class TestIt(unittest.TestCase):
    def test_good(self): pass
    def test_bad(self): raise ValueError("no good")

@pytest.mark.parametrize("case", [1, 2])
def test_cases(case): assert case == 1

@pytest.mark.parametrize("case", [1, 2])
def test_both(case): pass

@pytest.mark.skip("not here")
def test_skipped(): pass

class Helper:
    def test_nothing(self): pass
"""


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A test file; ROS 2's names are of no interest in it."""
    monkeypatch.setattr(tool, "SHIM", "no:doctest")
    path = tmp_path / "test_it.py"
    path.write_text(TESTS)
    return path


@pytest.mark.processes
def test_a_file_is_run_and_its_functions_counted(file: Path) -> None:
    outcomes = tool.run(file, _stage(file.parent))
    assert {test.partition("::")[2]: outcome.verdict for test, outcome in outcomes.items()} == {
        "TestIt::test_good": tool.PASSED,
        "TestIt::test_bad": tool.FAILED,
        "test_cases": tool.FAILED,
        "test_both": tool.PASSED,
        "test_skipped": tool.NOT_APPLICABLE,
    }
    assert outcomes["test_it.py::TestIt::test_bad"].error == "ValueError: no good"
    assert tool.rows(outcomes)[-1] == tool.Row("all", 2, 2, 1)


@pytest.mark.processes
def test_all_of_a_file_fail_that_cannot_be_run_or_does_not_end(file: Path) -> None:
    file.write_text("import nonsense\ndef test_a(): pass\nclass TestIt:\n    async def test_b(self): pass\n")
    outcomes = tool.run(file, _stage(file.parent))
    assert [*outcomes] == ["test_it.py::test_a", "test_it.py::TestIt::test_b"]
    assert all(each.verdict == tool.FAILED and "nonsense" in each.error for each in outcomes.values())
    file.write_text("import time\ndef test_a(): time.sleep(60)\n")
    (late,) = tool.run(file, _stage(file.parent, 0.5)).values()
    assert late.error == "not ended after 0.5 s"


@pytest.mark.processes
def test_a_file_finds_the_types_that_rclpys_tests_import(tmp_path: Path) -> None:
    path = tmp_path / "test_it.py"
    path.write_text(
        "from test_msgs.action import Fibonacci\nfrom test_msgs.msg import MultiNested\n"
        "from test_msgs.srv import Arrays\n"
        "from test_msgs.message_fixtures import get_test_msg\nimport rclpy.serialization as rclpy\n\n"
        "def test_all():\n    new, *filled = get_test_msg('MultiNested')\n"
        "    assert all(rclpy.deserialize_message(rclpy.serialize_message(each), MultiNested) == each != new"
        " for each in filled)\n"
    )
    assert tool.run(path, _stage(tmp_path)) == {"test_it.py::test_all": tool.Outcome(tool.PASSED)}


def test_what_has_no_reason_and_what_needs_none_are_told() -> None:
    outcomes = {f"test_a.py::{name}": tool.Outcome(name, "why") for name in (tool.PASSED, tool.FAILED)}
    good = {
        f"test_a.py::{tool.FAILED}": tool.Reason(tool.NOT_APPLICABLE, "C"),
        "test_b.py::x": tool.Reason("failed", ""),
    }
    assert list(tool.surprises(outcomes, good)) == []
    assert [each.verdict for each in tool.judged(outcomes, good).values()] == [tool.PASSED, tool.NOT_APPLICABLE]
    wrong = {f"test_a.py::{tool.PASSED}": tool.Reason(tool.FAILED, "C"), "test_a.py::gone": tool.Reason("failed", "")}
    assert [line.split()[1] for line in tool.surprises(outcomes, wrong)] == ["passed,", "failed:", "has"]


@pytest.mark.processes
def test_a_file_that_fails_is_run_again(file: Path) -> None:
    file.write_text("def test_bad(): assert 0\ndef test_late(): pass\ndef test_fine(): pass\n")
    failed = tool.Outcome(tool.FAILED, "late")
    found = {f"test_it.py::test_{name}": failed for name in ("bad", "late")}
    found["test_it.py::test_fine"] = tool.Outcome(tool.PASSED)
    again = tool.run_again(found, [file], {}, _stage(file.parent), tool.Console(quiet=True))
    assert [each.verdict for each in again.values()] == [tool.FAILED, tool.PASSED, tool.PASSED]
    known = dict.fromkeys(found, tool.Reason(tool.FAILED, "known"))
    assert tool.run_again(found, [file], known, _stage(file.parent), tool.Console(quiet=True)) == found


@pytest.mark.processes
def test_cases_are_counted_where_a_suite_wants_it(file: Path) -> None:
    outcomes = tool.run(file, _stage(file.parent, cases=True))
    counted = {test.partition("::")[2]: outcome.verdict for test, outcome in outcomes.items() if "[" in test}
    assert counted == {
        "test_cases[1]": "passed",
        "test_cases[2]": "failed",
        "test_both[1]": "passed",
        "test_both[2]": "passed",
    }
    reason = {"test_it.py::test_cases": tool.Reason(tool.FAILED, "known")}
    assert tool.judged(outcomes, reason)["test_it.py::test_cases[2]"].verdict == tool.FAILED
    assert not [each for each in tool.surprises(outcomes, reason) if "test_cases" in each]


def test_a_reason_may_be_for_a_whole_file() -> None:
    failed = {f"test_a.py::{name}": tool.Outcome(tool.FAILED, "why") for name in ("x", "y")}
    reason = {"test_a.py": tool.Reason(tool.NOT_APPLICABLE, "C")}
    assert list(tool.surprises(failed, reason)) == []
    passed = {test: tool.Outcome(tool.PASSED) for test in failed}
    assert [line.split()[1] for line in tool.surprises(passed, reason)] == ["passed,"]


def test_what_a_project_installs_is_in_the_prefix(tmp_path: Path) -> None:
    program = tmp_path / "x" / "programs" / "talk"
    program.parent.mkdir(parents=True)
    program.write_text("")
    suite = tool.Suite(repository="", version="", tests="", installed={"lib/x": "x/programs"})
    tool.install(tmp_path, suite, tmp_path / "prefix")
    assert (tmp_path / "prefix" / "lib" / "x" / "talk").is_file()
    assert (tmp_path / "prefix" / "share" / "ament_index" / "resource_index" / "packages" / "x").is_file()


def test_only_what_is_between_the_marks_is_written(tmp_path: Path) -> None:
    page, (begin, end) = tmp_path / "page.md", tool.marks("x")
    page.write_text(f"before {begin} old {end} after")
    tool.write(page, "x", "new")
    assert page.read_text() == f"before {begin}\n\nnew\n{end} after"
    page.write_text("no marks")
    with pytest.raises(ValueError, match="for the text to go between"):
        tool.write(page, "x", "new")


def test_a_folder_that_is_no_checkout_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="expected a checkout of ros2/rclpy"):
        tool.folder_of_tests(tmp_path, SUITES["rclpy"])
