"""launch_testing's records, lookups and assertions, with events that are made here."""

from __future__ import annotations

import re
import sys
import threading
from pathlib import Path
from typing import Any

import pytest

from robolink.launch.ros import launch_testing
from robolink.launch.ros.launch.actions import ExecuteProcess
from robolink.launch.ros.launch.bases import LaunchArgumentError
from robolink.launch.ros.launch.process_events import ProcessExited, ProcessIO, ProcessStarted
from robolink.launch.ros.launch_testing import ActiveIoHandler, ActiveProcInfoHandler, asserts, tools
from robolink.launch.ros.launch_testing.util import NO_CMD_ARGS, NoMatchingProcessException, resolveProcesses


def process(name: str, *words: str) -> ExecuteProcess:
    """Return an action whose process has started."""
    made = ExecuteProcess(cmd=[name, *words])
    made.process_details = {"name": name, "cmd": [name, *words], "cwd": None, "env": None, "pid": 7}
    return made


def details(action: ExecuteProcess) -> dict[str, Any]:
    assert action.process_details is not None
    return {"action": action, **action.process_details}


def output(*lines: tuple[ExecuteProcess, str]) -> ActiveIoHandler:
    made = ActiveIoHandler()
    for action, text in lines:
        made.append(ProcessIO(text=text.encode(), fd=STREAMS[text.endswith("!\n")], **details(action)))
    return made


STREAMS = {False: 1, True: 2}
"""Standard output; a line that ends with an exclamation mark is an error."""
NAMED = process("wheel", "/opt/bin/driver")
NAMED.process_details = {**details(NAMED), "cmd": ["/opt/bin/driver", "-v"]}
ADA, BOB = process("talker-ada", "--fast", "x"), process("talker-bob")
LINES = [(ADA, "one two\n"), (BOB, "other\n"), (ADA, "oh!\n"), (ADA, "\x1b[33mthree\x1b[0m\nfo"), (ADA, "ur")]


@pytest.mark.parametrize(
    ("expected", "is_there"),
    [
        ("two\nthree\nfo", True),
        ("one three", False),
        (re.compile(r"t\w+e"), True),
        (re.compile("^x"), False),
        (["one two", "four"], True),
        (["four", "one two"], False),
        (["one two", "fou"], True),
        (["two", re.compile("r$")], True),
        ("oh", False),
        ([re.compile("two"), re.compile("t")], True),
        ([re.compile("three"), re.compile("two")], False),
    ],
)
def test_what_is_expected_of_an_output(expected: object, is_there: bool) -> None:
    assert output(*LINES).waitFor(expected, ADA, timeout=0, stream="stdout") is is_there


@pytest.mark.parametrize("expected", [3, [], [3]])
def test_what_cannot_be_expected_is_refused(expected: object) -> None:
    with pytest.raises(ValueError, match="the expected text is a text, a pattern or several of either, got"):
        output(*LINES).waitFor(expected, timeout=0)


def test_outputs_are_told_by_process_or_all_together() -> None:
    heard = output(*LINES)
    assert (heard.processes(), heard.process_names()) == ([ADA, BOB], ["talker-ada", "talker-bob"])
    assert [each.text for each in heard["talker-bob"]] == [each.text for each in heard[BOB]] == [b"other\n"]
    assert heard.waitFor("other", timeout=0, stream="stdout")
    assert heard.waitFor("oh!", timeout=0)
    assert not heard.waitFor("\x1b[33mthree", timeout=0, stream="stdout")
    heard.assertWaitFor("\x1b[33mthree", ADA, strip_ansi_escape_sequences=False, stream="stdout")
    heard.assertWaitFor("OH", ADA, output_filter=str.upper)
    with pytest.raises(AssertionError, match="Waiting for output timed out: 'oh' was not written to stderr"):
        heard.assertWaitFor("oh", "bob", timeout=0)
    with pytest.raises(AssertionError, match="Did not find 'nine' in the stdout of talker-ada, talker-bob"):
        asserts.assertInStdout(heard, "nine", None)
    asserts.assertInStderr(heard, "oh", ADA)
    with pytest.raises(ValueError, match="a stream is stdout or stderr, got 'stdin'"):
        asserts.assertInStream(heard, "oh", ADA, stream="stdin")
    with pytest.raises(ValueError, match="output_filter is a function, got int"):
        asserts.assertInStream(heard, "oh", ADA, output_filter=3)  # type: ignore[arg-type]
    with pytest.raises(NoMatchingProcessException, match="any processes matching 'cy', only: talker-ada --fast x, tal"):
        heard.assertWaitFor("x", "cy", timeout=0)


def test_a_process_that_has_written_nothing_is_known_by_its_name() -> None:
    heard = ActiveIoHandler()
    heard.track("talker-ada")
    assert (heard.process_names(), heard.processes()) == (["talker-ada"], [])
    assert heard["talker-ada"] == heard[ADA] == []
    with pytest.raises(KeyError, match="talker-bob"):
        heard[BOB]


def test_a_test_waits_for_what_comes_later() -> None:
    heard, ended = ActiveIoHandler(), ActiveProcInfoHandler()

    def happen() -> None:
        ended.append(ProcessStarted(**details(ADA)))
        heard.append(ProcessIO(text=b"late\n", fd=1, **details(ADA)))
        ended.append(ProcessExited(returncode=3, **details(ADA)))

    thread = threading.Timer(0.05, happen)
    thread.start()
    heard.assertWaitFor("late", timeout=10, stream="stdout")
    ended.assertWaitForStartup(ADA)
    ended.assertWaitForShutdown("ada")
    thread.join()
    assert (ended["ada"], ended.process_names()) == (ended[ADA], ["talker-ada"])
    with pytest.raises(AssertionError, match="Timed out waiting for process 'talker-bob' to start"):
        ended.assertWaitForStartup(BOB, timeout=0)


def test_exit_codes() -> None:
    ended = ActiveProcInfoHandler()
    with pytest.raises(NoMatchingProcessException, match="No data recorded for any process"):
        asserts.assertExitCodes(ended)
    ended.append(ProcessStarted(**details(BOB)))
    with pytest.raises(AssertionError, match="talker-bob has not ended"):
        asserts.assertExitCodes(ended)
    ended.append(ProcessExited(returncode=-2, **details(BOB)))
    ended.append(ProcessExited(returncode=0, **details(ADA)))
    asserts.assertExitCodes(ended, process=ADA)
    asserts.assertExitCodes(ended, [0, -2])
    signal = "" if sys.platform == "win32" else " (SIGINT)"
    with pytest.raises(AssertionError, match=re.escape(f"talker-bob ended with -2{signal}, and [0] was expected")):
        asserts.assertExitCodes(ended)


@pytest.mark.parametrize(
    ("name", "cmd_args", "found"),
    [
        ("ada", None, [ADA]),
        ("talker", "--fast", [ADA]),
        ("talker", ["x", "--fast"], [ADA]),
        ("talker", NO_CMD_ARGS, [BOB]),
    ],
)
def test_processes_are_found_by_name_and_arguments(name: str, cmd_args: object, found: list[ExecuteProcess]) -> None:
    assert resolveProcesses(output(*LINES), process=name, cmd_args=cmd_args) == found


def test_a_process_is_found_by_its_program_too() -> None:
    heard = output(*LINES, (NAMED, "x\n"))
    assert (
        resolveProcesses(heard, process="driver") == resolveProcesses(heard, process="wheel", cmd_args="-v") == [NAMED]
    )
    with pytest.raises(NoMatchingProcessException, match="'opt'"):
        resolveProcesses(heard, process="opt")


def test_names_that_are_no_single_processs_are_refused() -> None:
    heard = output(*LINES)
    with pytest.raises(ValueError, match="Found multiple processes matching 'talker': talker-ada --fast x, talker-bob"):
        resolveProcesses(heard, process="talker")
    assert resolveProcesses(heard, process="talker", strict_proc_matching=False) == [ADA, BOB]
    with pytest.raises(TypeError, match="a process is an action or a name, got int"):
        resolveProcesses(heard, process=3)  # type: ignore[arg-type]


def test_texts_that_follow_each_other() -> None:
    with asserts.assertSequentialStdout(output(*LINES), ADA) as checker:
        checker.assertInStdout("one")
        checker.assertInStdout("three")
        with pytest.raises(AssertionError, match=r"(?s)'two' not found behind the last match, .*oh!\nthree\nfour"):
            checker.assertInText("two")
        checker.assertInStdout("four")


def test_filters_and_files_of_output(tmp_path: Path) -> None:
    kept = tools.basic_output_filter(["rc", "INFO"], [r".*\bdds\b"])
    assert kept("INFO x\nrc\nhello\na dds b\nbye") == "hello\nbye"
    assert tools.basic_output_filter()("pid 3\nx\n") == "x\n"
    (tmp_path / "a.txt").write_text("one\ntwo\n")
    (tmp_path / "b.regex").write_text("o.e\n")
    assert tools.expected_output_from_file(str(tmp_path / "a")) == ["one", "two"]
    assert tools.expected_output_from_file(str(tmp_path / "b")) == [re.compile("o.e")]
    with pytest.raises(FileNotFoundError, match=r"neither .*c\.txt nor .*c\.regex"):
        tools.expected_output_from_file(str(tmp_path / "c"))


def test_parameters_of_several_launches() -> None:
    @launch_testing.parametrize("a, b", [(1, 2), (3, 4)])
    @launch_testing.parametrize("c", ["x"])
    def describe(a: int, b: int, c: str) -> str:
        return f"{a}{b}{c}"

    assert [function() for function, _ in describe()] == ["12x", "34x"]
    assert [values for _, values in describe()] == [{"c": "x", "a": 1, "b": 2}, {"c": "x", "a": 3, "b": 4}]
    with pytest.raises(LaunchArgumentError, match="parametrize has 2 names, and a row with 1 values"):
        launch_testing.parametrize("a, b", [1])


def test_retries() -> None:
    tries = []

    @launch_testing.markers.retry_on_failure(times=3)
    def third_time(fails: int) -> int:
        tries.append(fails)
        assert len(tries) > fails
        return len(tries)

    assert third_time(2) == 3
    tries.clear()
    with pytest.raises(AssertionError):
        third_time(9)
    assert len(tries) == 3


def test_there_may_be_time_between_retries(monkeypatch: pytest.MonkeyPatch) -> None:
    slept: list[float] = []
    monkeypatch.setattr("time.sleep", slept.append)

    @launch_testing.markers.retry_on_failure(times=3, delay=0.5)
    def never() -> None:
        raise AssertionError

    with pytest.raises(AssertionError):
        never()
    assert slept == [0.5, 0.5]
