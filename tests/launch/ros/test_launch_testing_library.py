"""launch_testing as a library: the loader, texts, results and reports, with tests that are made here."""

from __future__ import annotations

import io
import re
import types
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from robolink.launch.ros import launch_testing
from robolink.launch.ros.launch import LaunchDescription
from robolink.launch.ros.launch.actions import EmitEvent, ExecuteProcess, RegisterEventHandler, TimerAction
from robolink.launch.ros.launch.bases import LaunchArgumentError, LaunchContext
from robolink.launch.ros.launch.event_handlers import OnProcessExit
from robolink.launch.ros.launch.events import Shutdown
from robolink.launch.ros.launch_testing import ReadyAggregator, junitxml, test_result
from robolink.launch.ros.launch_testing.actions import GTest, PyTest, ReadyToTest
from robolink.launch.ros.launch_testing.arguments import parse_launch_arguments, print_arguments_of_launch_description
from robolink.launch.ros.launch_testing.legacy import output as legacy_output
from robolink.launch.ros.launch_testing.loader import LaunchTestError, LoadTestsFromPythonModule, TestRun, cases_in
from robolink.launch.ros.launch_testing.test_runner import LaunchTestRunner
from robolink.launch.ros.launch_testing.text import build_line_match, build_text_match
from robolink.launch.ros.launch_testing.tools import expect_output

LINES = ["a 1", "b 2", "a 3"]


@pytest.mark.parametrize(
    ("expected", "strict", "found"),
    [
        ("2", False, (6, 7)),
        ("2", True, None),
        ("a 1\nb 2\na 3", True, (0, 11)),
        (re.compile("b"), False, (4, 5)),
        (re.compile("b"), True, None),
        (["a", "a"], False, (0, 9)),
        (["a 1\n", "b"], True, (0, 5)),
        (["a", "b"], True, None),
    ],
)
def test_texts_are_found(expected: Any, strict: bool, found: object) -> None:
    assert build_text_match(expected, strict=strict)("a 1\r\nb 2\r\na 3") == found


@pytest.mark.parametrize(
    ("expected", "strict", "found"),
    [
        ("2", False, (1, 2)),
        ("2", True, None),
        (re.compile("[ab]"), True, (0, 3)),
        ([re.compile("a"), "a"], False, (0, 3)),
        ([re.compile("a"), "a"], True, None),
        (["1", "2"], True, (0, 2)),
    ],
)
def test_lines_are_found(expected: Any, strict: bool, found: object) -> None:
    assert build_line_match(expected, strict=strict)(LINES) == found


def test_outputs_are_as_expected_without_their_colours() -> None:
    assert expect_output("\x1b[1mx\x1b[0my", expected_text="xy", strict=True)
    assert not expect_output("\x1b[1mx\x1b[0my", expected_text="xy", strip_ansi_escape_sequences=False)
    assert expect_output(lines=LINES, expected_lines=["1", "3"])
    assert expect_output(lines=LINES, expected_text="1\nb")
    with pytest.raises(ValueError, match="a text or lines, one of them"):
        expect_output("x", lines=["x"], expected_text="x")
    with pytest.raises(ValueError, match="expected_text or expected_lines, one of them"):
        expect_output("x")


def test_the_whole_is_ready_with_its_last_part() -> None:
    ready: list[int] = []
    parts = ReadyAggregator(lambda: ready.append(1), 2)
    seen = []
    for _ in range(4):
        parts.ready_fn()
        seen.append(len(ready))
    assert seen == [0, 1, 1, 1]


def module_of(describe: Callable[..., Any]) -> types.ModuleType:
    """Return a module with two classes of tests."""

    class Beside(unittest.TestCase):
        def setUp(self, word: str = "none") -> None:
            self.word = word

        def test_words(self, word: str) -> None:
            assert self.word == word

        @unittest.expectedFailure
        def test_fails(self, word: str) -> None:
            self.fail(word)

        def test_asks(self, wrod: str) -> None: ...

    @launch_testing.post_shutdown_test()
    class After(unittest.TestCase):
        def test_number(self, number: int) -> None:
            assert number == 1

    made: Any = types.ModuleType("made")
    made.generate_test_description, made.Beside, made.After = describe, Beside, After
    return made  # type: ignore[no-any-return]


def load(describe: Callable[..., Any]) -> list[TestRun]:
    return LoadTestsFromPythonModule(module_of(describe), name="made")


def ran(tests: Any) -> test_result.TestResult:
    """Return the results of tests."""
    return unittest.TextTestRunner(stream=io.StringIO(), resultclass=test_result.TestResult).run(tests)  # type: ignore[return-value]


@launch_testing.parametrize("number", [1, 2])
@launch_testing.markers.keep_alive
@launch_testing.ready_to_test_action_timeout(20)
def describe_two(number: int) -> LaunchDescription:
    return LaunchDescription([ReadyToTest()])


def test_each_launch_has_its_own_tests() -> None:
    one, two = load(describe_two)
    assert (str(one), str(two)) == ("made[1]", "made[2]")
    assert (one.timeout, one.markers) == (20, {"keep_alive": True})
    names = [case._testMethodName for case in one.all_cases()]
    assert names == ["test_asks[1]", "test_fails[1]", "test_words[1]", "test_number[1]"]
    for run in (one, two):
        run.bind(run.pre_shutdown_tests, {"attribute": run}, {"word": "x"})
        run.bind(run.post_shutdown_tests, injected_args=run.param_args)
    results = ran(one.pre_shutdown_tests)
    assert (results.testsRun, len(results.expectedFailures), len(results.errors)) == (3, 1, 1)
    assert "test_asks asks for 'wrod' (did you mean 'word'?): there is word" in results.errors[0][1]
    assert [case.attribute for case in cases_in(two.pre_shutdown_tests)] == [two] * 3
    assert ran(one.post_shutdown_tests).wasSuccessful()
    assert not ran(two.post_shutdown_tests).wasSuccessful()


DUMMY = ExecuteProcess(cmd=["true"])
INSIDE = [
    lambda ready: [ready],
    lambda ready: [TimerAction(period=1.0, actions=[TimerAction(period=1.0, actions=[ready])])],
    lambda ready: [RegisterEventHandler(OnProcessExit(target_action=DUMMY, on_exit=ready))],
    lambda ready: [RegisterEventHandler(OnProcessExit(target_action=DUMMY, on_exit=[DUMMY, ready]))],
    lambda ready: [LaunchDescription([LaunchDescription([ready])])],
]


@pytest.mark.parametrize("inside", INSIDE)
def test_the_beginning_of_the_tests_is_found_wherever_it_is(inside: Callable[[ReadyToTest], Any]) -> None:
    ready, begun = ReadyToTest(), []
    (run,) = load(lambda: (LaunchDescription(inside(ready)), {"x": 3}))
    description, of_file = run.normalized_test_description(ready_fn=lambda: begun.append(1))
    ready.execute(LaunchContext())
    assert (type(description), of_file, begun) == (LaunchDescription, {"x": 3}, [1])


def test_mistakes_of_the_description_are_told() -> None:
    (run,) = load(lambda: LaunchDescription([]))
    with pytest.raises(LaunchTestError, match="must return a LaunchDescription containing a ReadyToTest action"):
        run.get_launch_description()
    (run,) = load(list)
    with pytest.raises(LaunchTestError, match="returned list, not a LaunchDescription"):
        run.get_launch_description()
    with pytest.raises(LaunchTestError, match="has unexpected extra argument 'wrong'"):
        LaunchTestRunner(load(lambda wrong: None)).validate()
    wrong = launch_testing.parametrize("numbre", [1])(lambda number: None)
    with pytest.raises(LaunchTestError, match=r"Could not find an argument in .* matching the parameter 'numbre'"):
        LaunchTestRunner(load(wrong)).validate()
    LaunchTestRunner([*load(describe_two), *load(lambda ready_fn, other=3: None)]).validate()
    with pytest.raises(LaunchArgumentError, match="decorates a class of tests, got int"):
        launch_testing.post_shutdown_test()(3)  # type: ignore[type-var]


def test_a_launch_that_is_skipped_skips_its_tests(capsys: pytest.CaptureFixture[str]) -> None:
    @unittest.skip("not now")
    def describe() -> None: ...

    runs = load(describe)
    (result,) = LaunchTestRunner(runs).run().values()
    assert (result.testsRun, [reason for _, reason in result.skipped]) == (4, ["not now"] * 4)
    assert "made is skipped: not now" in capsys.readouterr().out


def test_reports_in_junits_xml() -> None:
    (run,) = load(lambda: LaunchDescription([ReadyToTest()]))
    run.bind(run.pre_shutdown_tests, injected_args={"word": "x"})
    results = ran(run.pre_shutdown_tests)
    results.append(ran(run.post_shutdown_tests))
    failed, skipped = test_result.FailResult(run, "too early"), test_result.SkipResult(run, "not now")
    root: Any = junitxml.unittestResultsToXml(
        name="all", test_results={"ran": results, "failed": failed, "skipped": skipped}
    ).getroot()
    assert {name: root.get(name) for name in ("name", "tests", "failures", "errors")} == {
        "name": "all",
        "tests": "12",
        "failures": "4",
        "errors": "2",
    }
    assert [suite.get("name") for suite in root] == ["ran", "failed", "skipped"]
    asks = root.find("testsuite/testcase[@name='test_asks']")
    assert asks.get("classname").endswith("Beside")
    assert "wrod" in asks.find("error").get("message")
    assert root.find("testsuite[@name='skipped']/testcase/skipped").get("message") == "not now"
    assert "too early" in root.find("testsuite[@name='failed']/testcase/failure").get("message")


def test_launch_arguments_are_read_and_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert parse_launch_arguments(["a:=1", "b:=x:=y", "a:=2"]) == [("a", "2"), ("b", "x:=y")]
    for wrong in ("a", ":=1", "a:="):
        with pytest.raises(LaunchArgumentError, match=f"malformed launch argument '{wrong}': expected NAME:=VALUE"):
            parse_launch_arguments([wrong])
    print_arguments_of_launch_description(launch_description=LaunchDescription([]))
    assert "No arguments." in capsys.readouterr().out


def test_a_test_that_is_a_process_may_have_a_timeout() -> None:
    assert GTest(path="x").cmd
    assert PyTest(path="x").path == "x"
    context = LaunchContext()
    assert not GTest(path="x").visit(context)
    register, timer = GTest(path="x", timeout=3.0).visit(context) or ()
    assert isinstance(register, RegisterEventHandler)
    assert isinstance(timer, TimerAction)
    assert (timer.seconds(context), type(timer.actions[0])) == (3.0, EmitEvent)


def test_output_tests_of_the_older_kind(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("one\n")
    (tmp_path / "b.regex").write_text("line \\d\\nline b\n")
    text = legacy_output.create_output_test_from_file(str(tmp_path / "a"))
    said = text.collate(text.start, b"x one y\n")
    assert [text.match(said, each) for each in (*text.expected, b"two")] == [True, False]
    pattern = legacy_output.create_output_test_from_file(str(tmp_path / "b"))
    said = pattern.collate(pattern.collate(pattern.start, b"line 1\n"), b"line b\n")
    assert pattern.match(said, pattern.expected[0])
    with pytest.raises(FileNotFoundError, match=r"neither .*c\.txt nor .*c\.regex"):
        legacy_output.create_output_test_from_file(str(tmp_path / "c"))
    assert legacy_output.create_output_lines_filter([b"rc"], [b".*z"])(b"rc 1\nx\nyz\n") == b"x\n"


def test_a_test_service_adds_what_ends_the_launch() -> None:
    description, service = LaunchDescription(), launch_testing.legacy.LaunchTestService()
    assert service.add_test_action(description, DUMMY) is DUMMY
    handler = description.entities[0].event_handler  # type: ignore[attr-defined]
    assert handler.describe()[0] == "OnProcessExit"
    (end,) = service._settle("test 1", "succeeded")
    assert isinstance(end, EmitEvent)
    assert isinstance(end.event, Shutdown)
