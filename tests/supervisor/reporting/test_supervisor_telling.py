"""What is told of a system: why a process ended, a summary of an unhappy run, events for programs."""

from __future__ import annotations

import io
import subprocess
import sys
import threading

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.supervisor import Event, Process, Restarts, Rules, Supervisor
from robolink.supervisor.events import Output
from robolink.supervisor.reporting.dispatcher import Cause, Summary

TRACEBACK = 'Traceback (most recent call last):\n  File "x.py", line 1, in <module>\n    1 / 0\n    ~~^~~\n'
GROUP = """\
  + Exception Group Traceback (most recent call last):
  |   File "x.py", line 1, in <module>
  | ExceptionGroup: two (1 sub-exception)
  +-+---------------- 1 ----------------
    | TypeError: a
    +------------------------------------
"""
SEGMENTATION_FAULT = """\
Fatal Python error: Segmentation fault

Current thread 0x01 (most recent call first):
  File "x.py", line 3 in f

Extension modules: numpy (total: 1)
"""
NOT_BEGUN = "Fatal Python error: init_sys_streams: can't initialize sys standard streams"
CAUSES = [
    ("all is well\n", ""),
    (TRACEBACK + "ZeroDivisionError: division by zero\n", "ZeroDivisionError: division by zero"),
    (TRACEBACK + "KeyError: 'a'\n\nDuring handling ...\n\n" + TRACEBACK + "ValueError: b\n", "ValueError: b"),
    (TRACEBACK + "ValueError: two\n  lines\nValueError2\n", "ValueError: two"),
    (TRACEBACK + "\x1b[1;35mValueError\x1b[0m: \x1b[35mred\x1b[0m\n", "ValueError: red"),
    (TRACEBACK + "ValueError: \x1b]0;title\x07 \xff\n", "ValueError: \\x1b]0;title\\x07 ÿ"),
    (TRACEBACK + "ValueError: old\n" + "line\n" * 30, ""),
    (TRACEBACK + "ValueError: " + "x" * 1000 + "\n", "ValueError: " + "x" * 185 + "..."),
    ('  File "x.py", line 1\n    x ==\n        ^\nSyntaxError: invalid syntax\n', "SyntaxError: invalid syntax"),
    (GROUP, "ExceptionGroup: two (1 sub-exception)"),
    (SEGMENTATION_FAULT, "Fatal Python error: Segmentation fault"),
    ("terminate called after throwing an instance of 'E'\n  what():  no such thing\n", "no such thing"),
    ("robolink: no world named 'labb' (did you mean 'lab'?)\n", "no world named 'labb' (did you mean 'lab'?)"),
    ("Traceback (most recent call last):\n", ""),
    ("KeyboardInterrupt\n", "KeyboardInterrupt"),
    (NOT_BEGUN + "\nPython runtime state: initialized\nKeyboardInterrupt\n\nCurrent thread\n", "KeyboardInterrupt"),
    (NOT_BEGUN + "\n" + TRACEBACK + "KeyboardInterrupt\n", "KeyboardInterrupt"),
    (NOT_BEGUN + "\n" + TRACEBACK + "TypeError: expected a message argument\n", NOT_BEGUN),
]


@pytest.mark.parametrize(("output", "text"), CAUSES)
def test_why_a_program_ended(output: str, text: str) -> None:
    cause = Cause()
    for line in output.splitlines(keepends=True):
        cause.line(line.encode())
    assert cause.text == text


def test_what_a_ctrl_c_has_led_to_has_that_as_its_cause() -> None:
    cause = Cause()
    for line in (
        "Traceback (most recent call last):",
        '  File "functools.py", line 972, in __set_name__',
        "KeyboardInterrupt",
        "",
        "The above exception was the direct cause of the following exception:",
        "",
        "Traceback (most recent call last):",
        '  File "platform.py", line 778, in <module>',
        "RuntimeError: Error calling __set_name__",
    ):
        cause.line(line.encode() + b"\n")
    assert cause.text == "KeyboardInterrupt"


@given(st.lists(st.binary(max_size=50) | st.sampled_from([line.encode() for line in TRACEBACK.splitlines()])))
def test_any_output_has_a_cause_of_one_printable_line_or_none(lines: list[bytes]) -> None:
    cause = Cause()
    for line in lines:
        cause.line(line)
    assert cause.text == "" or cause.text.isprintable()


@pytest.mark.processes
@pytest.mark.parametrize("code", ["def f(): 1 / 0\nf()", "import nothing_like_this", "x = = 1", "raise ValueError"])
def test_what_this_python_prints_is_understood(code: str) -> None:
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False).stderr
    cause = Cause()
    for line in printed.splitlines(keepends=True):
        cause.line(line)
    assert cause.text == printed.decode().splitlines()[-1]


def test_the_summary_counts_failures_and_tells_the_last_of_each() -> None:
    summary = Summary()
    assert summary.lines() == []
    summary.failed("a", "a was killed by SIGSEGV", restarts=0, was_requested=False)
    summary.failed("b", "b ended with exit code 1", restarts=0, was_requested=True)
    summary.failed("a", "a ended with exit code 2", restarts=1, was_requested=False)
    assert summary.lines(["c"]) == [
        "a ended with exit code 2 (failed 2 times, started again once)",
        "b ended with exit code 1 (when asked to stop)",
        "c still runs: it could not be killed",
    ]


# --- a system that runs ---------------------------------------------------------------------------------------

FOR_EVER = "import time\nprint('ready', flush=True)\nwhile True: time.sleep(0.02)\n"


def python(name: str, code: str, rules: Rules | None = None) -> Process:
    return Process(name, [sys.executable, "-c", code], rules=rules or Rules())


@pytest.mark.processes
def test_a_crash_is_told_with_its_cause_and_again_at_the_end() -> None:
    output = io.StringIO()
    # b's last words come behind the news of a's end
    code = "import time\ntry:\n    while True: time.sleep(0.02)\nexcept KeyboardInterrupt: print('bye')"
    crash = python("a", "import sys; sys.stdin.read(); raise ValueError('no good')")
    assert Supervisor([python("b", code), crash], output=output).run() == 1
    lines = output.getvalue().splitlines()
    assert "[launch] a ended with exit code 1: ValueError: no good" in lines
    if "[b] bye" in lines:  # unless b was interrupted before it had begun
        assert lines[-1] == "[launch] summary: a ended with exit code 1: ValueError: no good"


class Heard:
    """Keeps events, and acts on them."""

    def __init__(self) -> None:
        self.events: list[Event] = []
        self.supervisor: Supervisor | None = None
        self.threads: set[int] = set()

    def __call__(self, event: Event) -> None:
        self.events.append(event)
        self.threads.add(threading.get_ident())
        if len(self.named("started")) == 2 and self.supervisor is not None:
            self.supervisor.stop()

    def named(self, kind: str) -> list[dict[str, object]]:
        return [each for each in map(self.plain, self.events) if each["event"] == kind]

    @staticmethod
    def plain(event: Event) -> dict[str, object]:
        found: dict[str, object] = msgspec.json.decode(msgspec.json.encode(event))
        return found


@pytest.mark.processes
def test_events_tell_a_program_what_happens() -> None:
    heard = Heard()
    crash = python("a", "print('hé')\nraise ValueError('x')", Rules(Restarts("always", delay=0.0)))
    supervisor = heard.supervisor = Supervisor([crash], output=io.StringIO(), on_event=heard)
    supervisor.run()
    kinds = [each["event"] for each in map(heard.plain, heard.events)]
    assert kinds[0] == "started"
    assert kinds[-1] == "ended"
    assert heard.named("output")[0]["line"] == "hé"
    first = heard.named("exited")[0]
    assert (first["returncode"], first["how"], first["cause"]) == (1, "ended with exit code 1", "ValueError: x")
    assert heard.named("restarting")[0]["delay"] == 0.0
    assert heard.named("started")[1]["restarts"] == 1
    assert heard.named("stopping")[0]["step"] == "interrupt"
    assert len(heard.threads) == 1
    assert all(isinstance(each["at"], float) for each in map(heard.plain, heard.events))


@pytest.mark.processes
def test_a_listener_that_is_gone_ends_the_system() -> None:
    def broken(event: Event) -> None:
        raise BrokenPipeError

    assert Supervisor([python("a", FOR_EVER)], output=io.StringIO(), on_event=broken).run() == 0


@pytest.mark.processes
def test_a_listener_that_stands_still_holds_up_no_decision() -> None:
    go_on = threading.Event()

    def slow(event: Event) -> None:
        if isinstance(event, Output):
            supervisor.stop()
            go_on.wait(60)

    endless = python("a", "while True: print('x')")
    supervisor = Supervisor([endless], output=io.StringIO(), on_event=slow, patience=1.0)
    try:
        assert supervisor.run() == 0
    finally:
        go_on.set()
