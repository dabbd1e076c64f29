"""The console of the logs: ROS's format and colours, one write a line, and streams that fail."""

from __future__ import annotations

import io
import re
import sys

import pytest

from robolink.impl.log_output import Console, Record, compile_format
from robolink.impl.logging_severity import LoggingSeverity


class Terminal(io.StringIO):
    """A terminal that counts how often it is written to."""

    writes = 0

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        self.writes += 1
        return super().write(text)


RECORD = Record(1_500_000_000, LoggingSeverity.INFO, "talker", "hi", "/a/b.py", "main", 7)


@pytest.mark.parametrize(
    ("environ", "severity", "tty", "expected"),
    [
        ({}, "INFO", True, "\x1b[0m[INFO] [1.500000000] [talker]: hi\x1b[0m\n"),
        ({}, "WARN", False, "[WARN] [1.500000000] [talker]: hi\n"),
        ({}, "WARN", True, "\x1b[33m[WARN] [1.500000000] [talker]: hi\x1b[0m\n"),
        ({}, "ERROR", True, "\x1b[31m[ERROR] [1.500000000] [talker]: hi\x1b[0m\n"),
        ({}, "DEBUG", True, "\x1b[32m[DEBUG] [1.500000000] [talker]: hi\x1b[0m\n"),
        ({"NO_COLOR": "1"}, "WARN", True, "[WARN] [1.500000000] [talker]: hi\n"),
        ({"RCUTILS_COLORIZED_OUTPUT": "0"}, "WARN", True, "[WARN] [1.500000000] [talker]: hi\n"),
        (
            {"RCUTILS_COLORIZED_OUTPUT": "1", "NO_COLOR": "1"},
            "WARN",
            False,
            "\x1b[33m[WARN] [1.500000000] [talker]: hi\x1b[0m\n",
        ),
        ({"RCUTILS_CONSOLE_OUTPUT_FORMAT": "{name}|{message}"}, "WARN", False, "talker|hi\n"),
    ],
)
def test_the_console_writes_as_ros_does(
    environ: dict[str, str], severity: str, tty: bool, expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    stream = Terminal() if tty else io.StringIO()
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", stream)
    Console(environ)(RECORD._replace(severity=LoggingSeverity[severity]))
    assert stream.getvalue() == expected


def test_a_line_is_one_write_to_the_stream_of_the_moment(monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = Terminal(), Terminal()
    console = Console({})
    for stream in (first, second):
        monkeypatch.setattr(sys, "stderr", stream)
        console(RECORD._replace(message="two\nlines"))
    assert [first.writes, second.writes] == [1, 1]
    monkeypatch.setattr(sys, "stdout", first)
    Console({"RCUTILS_LOGGING_USE_STDOUT": "1"})(RECORD)
    assert (first.writes, second.writes) == (2, 1)


def test_a_console_that_cannot_take_a_line_ends_no_program(monkeypatch: pytest.MonkeyPatch) -> None:
    closed, narrow = io.StringIO(), io.TextIOWrapper(io.BytesIO(), encoding="cp1252")
    closed.close()
    console = Console({"RCUTILS_CONSOLE_OUTPUT_FORMAT": "{message}"})
    for stream in (closed, None, narrow):
        monkeypatch.setattr(sys, "stderr", stream)
        console(RECORD._replace(message="a → b"))
    assert isinstance(narrow.buffer, io.BytesIO)
    assert narrow.buffer.getvalue().split() == [b"a", b"\\u2192", b"b"]


def test_every_token_of_a_format_is_written() -> None:
    written = compile_format(
        r"{severity} {name} {message} {function_name} {file_name} {line_number} {time_as_nanoseconds}"
        r" {other} {\t\x1b\n{time}"
    )(RECORD)
    assert written == "INFO talker hi main /a/b.py 7 1500000000 {other} {\t\x1b\n1.500000000"
    date = compile_format("{date_time_with_ms}")(RECORD)
    assert re.fullmatch(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.500", date)
