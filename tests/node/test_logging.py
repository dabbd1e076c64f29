"""Logging: levels, filters by call site, the console's format and colours, handlers, stamps."""

from __future__ import annotations

import io
import itertools
import logging as stdlib_logging
import sys
import threading
import timeit
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, logging
from robolink.duration import Duration
from robolink.impl.log_output import Console, Record, output
from robolink.impl.rcutils_logger import RcutilsLogger, internal_files
from robolink.logging import LoggingSeverity
from robolink.time import Time
from robolink.transport.memory import Bus, MemoryTransport

SECOND = 1_000_000_000


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    console, now = output.console, output.now
    yield
    output.console, output.now = console, now
    logging.clear_config()


@pytest.fixture
def records() -> Iterator[list[Record]]:
    """Collect what is logged; the console is silent."""
    found: list[Record] = []
    logging.set_console_handler(None)
    logging.add_handler(found.append)
    yield found
    logging.remove_handler(found.append)


class ManualClock:
    """A clock that stands where it is put."""

    def __init__(self) -> None:
        self.time = Time()

    def now(self) -> Time:
        return self.time

    def advance(self, seconds: float) -> None:
        self.time = self.time + Duration(seconds=seconds)


def test_a_line_is_recorded_with_its_place(records: list[Record]) -> None:
    logging.set_time_source(lambda: 1_700_000_000_123_456_789)
    assert logging.get_logger("talker").warning("careful")
    (record,) = records
    assert record[:4] == (1_700_000_000_123_456_789, LoggingSeverity.WARN, "talker", "careful")
    assert (Path(record.file).name, record.function) == ("test_logging.py", "test_a_line_is_recorded_with_its_place")
    assert "careful" in Path(__file__).read_text().splitlines()[record.line - 1]


def test_every_severity_has_its_method(records: list[Record]) -> None:
    logging.set_logger_level("talker", LoggingSeverity.DEBUG)
    for method in ("debug", "info", "warn", "warning", "error", "fatal"):
        assert getattr(logging.get_logger("talker"), method)("x")
    assert logging.get_logger("talker").log("x", 30)
    assert [record.severity.name for record in records] == ["DEBUG", "INFO", "WARN", "WARN", "ERROR", "FATAL", "WARN"]


def test_what_is_below_the_level_is_dropped(records: list[Record]) -> None:
    logger = logging.get_logger("talker")
    assert not logger.debug("off by default")
    logger.set_level(LoggingSeverity.ERROR)
    assert [logger.info("x"), logger.warning("x"), logger.error("x")] == [False, False, True]
    assert [logger.is_enabled_for(each) for each in (30, 40)] == [False, True]
    logger.set_level(LoggingSeverity.DEBUG)
    assert logger.debug("x")
    assert len(records) == 2


def test_levels_are_inherited_along_the_dots() -> None:
    parent = logging.get_logger("a")
    child = parent.get_child("b").get_child("c")
    assert child.name == "a.b.c"
    assert child.get_effective_level() is LoggingSeverity.INFO
    parent.set_level(LoggingSeverity.WARN)
    assert child.get_effective_level() is LoggingSeverity.WARN
    logging.set_logger_level("a.b", 40)
    assert child.get_effective_level() is LoggingSeverity.ERROR
    assert logging.get_logger_level("a.b") is LoggingSeverity.ERROR
    assert logging.get_logger_level("a.b.c") is LoggingSeverity.UNSET
    logging.set_logger_level("a.b", LoggingSeverity.UNSET)
    assert logging.get_logger_effective_level("a.b.c") is LoggingSeverity.WARN
    assert logging.get_logger_effective_level("ab") is LoggingSeverity.INFO
    logging.set_logger_level("", LoggingSeverity.FATAL)
    assert logging.get_logger_effective_level("ab") is LoggingSeverity.FATAL
    logging.clear_config()
    assert child.get_effective_level() is LoggingSeverity.INFO


def test_names_and_levels_are_checked() -> None:
    with pytest.raises(ValueError, match="Logger name must not be empty"):
        logging.get_logger("")
    with pytest.raises(ValueError, match="Child logger name must not be empty"):
        logging.get_logger("a").get_child("")
    with pytest.raises(ValueError, match="15"):
        logging.set_logger_level("a", 15)
    with pytest.raises(ValueError, match="25"):
        logging.get_logger("a").log("x", 25)
    assert logging.get_logging_severity_from_string("warn") is LoggingSeverity.WARN
    with pytest.raises(RuntimeError, match=r"'inf' \(did you mean 'INFO'\?\)"):
        logging.get_logging_severity_from_string("inf")


def logged(count: int, log: Callable[[], bool]) -> list[bool]:
    """Log so many times."""
    return [log() for _ in range(count)]


def test_once_and_skip_first(records: list[Record]) -> None:
    logger = logging.get_logger("talker")
    assert logged(4, lambda: logger.info("x", once=True)) == [True, False, False, False]
    assert logged(3, lambda: logger.info("x", skip_first=True)) == [False, True, True]
    assert logged(4, lambda: logger.info("x", once=True, skip_first=True)) == [False, True, False, False]
    assert logged(2, lambda: logger.info("x", once=False)) == [True, True]
    assert len(records) == 6


def test_throttle_follows_the_given_clock(records: list[Record]) -> None:
    clock, logger = ManualClock(), logging.get_logger("talker")

    def log() -> bool:
        passed = logger.info("x", throttle_duration_sec=2, throttle_time_source_type=clock)
        clock.advance(1)
        return passed

    assert logged(6, log) == [False, False, True, False, True, False]  # rclpy counts from zero
    clock.time = Time(seconds=1)  # a simulation that began again
    assert logged(3, log) == [True, False, True]
    assert len(records) == 4


def test_throttle_follows_the_stamps_when_no_clock_is_given(records: list[Record]) -> None:
    times = iter(range(0, 100 * SECOND, SECOND // 4))
    logging.set_time_source(times.__next__)
    logger = logging.get_logger("talker")
    logged(40, lambda: logger.info("x", throttle_duration_sec=1.0))
    gaps = [b.stamp_ns - a.stamp_ns for a, b in itertools.pairwise(records)]
    assert len(records) > 5
    assert min(gaps) >= SECOND


def test_throttle_comes_before_skip_first(records: list[Record]) -> None:
    clock, logger = ManualClock(), logging.get_logger("talker")
    clock.advance(10)

    def log() -> bool:
        passed = logger.info("x", skip_first=True, throttle_duration_sec=1, throttle_time_source_type=clock)
        clock.advance(0.4)
        return passed

    assert logged(5, log) == [False, False, False, True, False]
    assert len(records) == 1


def test_filters_belong_to_the_place_that_logs(records: list[Record]) -> None:
    logger = logging.get_logger("talker")
    for _ in range(3):
        logger.info("here", once=True)
        logger.info("there", once=True), logger.info("beside", once=True)
    assert [record.message for record in records] == ["here", "there", "beside"]


def test_a_filter_is_asked_only_when_the_level_is_on(records: list[Record]) -> None:
    logger = logging.get_logger("talker")

    def log() -> bool:
        return logger.debug("x", once=True)

    assert logged(2, log) == [False, False]
    logger.set_level(LoggingSeverity.DEBUG)
    assert logged(2, log) == [True, False]
    assert len(records) == 1


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"unknown": 1}, TypeError, 'parameter "unknown" is not one of the recognized logging options'),
        ({"throttle_time_source_type": ManualClock()}, TypeError, "required parameter .* not specified"),
        ({"throttle_duration_sec": 1, "throttle_time_source_type": 5}, ValueError, "must be a clock, got 5"),
        ({"severity": 10}, TypeError, "got multiple values for argument 'severity'"),
    ],
)
def test_wrong_options_are_refused(options: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        logging.get_logger("talker").info("x", **options)


@pytest.mark.parametrize(
    ("first", "then", "message"),
    [
        ({}, {"severity": 30}, "severity cannot be changed between calls"),
        ({}, {"name": "other"}, "name cannot be changed between calls"),
        ({}, {"once": True}, "filters cannot be changed between calls"),
        ({"throttle_duration_sec": 1}, {"throttle_duration_sec": 2}, "parameters cannot be changed between calls"),
    ],
)
def test_a_place_that_logs_stays_as_it_is(
    records: list[Record], first: dict[str, Any], then: dict[str, Any], message: str
) -> None:
    logger = logging.get_logger("talker")
    calls = iter([first, then])

    def log() -> bool:
        return logger.log("x", **{"severity": LoggingSeverity.INFO, **next(calls)})

    assert log()
    with pytest.raises(ValueError, match=rf"{message}.*test_logging\.py:\d+ logs INFO as 'talker'"):
        log()
    assert len(records) == 1


def test_another_name_may_be_given(records: list[Record]) -> None:
    logging.get_logger("talker").info("x", name="alias")
    assert records[0].name == "alias"


def test_wrappers_can_step_aside(records: list[Record]) -> None:
    code = compile("def wrapper(logger): logger.info('x')", "/lib/wrapper.py", "exec")
    scope: dict[str, Any] = {}
    exec(code, scope)
    logger = logging.get_logger("talker")
    scope["wrapper"](logger)
    internal_files.add("/lib/wrapper.py")
    try:
        scope["wrapper"](logger)
    finally:
        internal_files.discard("/lib/wrapper.py")
    assert [Path(record.file).name for record in records] == ["wrapper.py", "test_logging.py"]


def test_the_environment_is_read_again_on_request(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setenv("RCUTILS_CONSOLE_OUTPUT_FORMAT", "<{message}>")
    logging.initialize()
    logging.shutdown()
    logging.get_logger("talker").info("after shutdown")
    assert stream.getvalue() == "<after shutdown>\n"


def test_a_handler_may_log_and_may_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    logging.set_console_handler(Console({"RCUTILS_CONSOLE_OUTPUT_FORMAT": "{severity} {message}"}))
    inner, seen = logging.get_logger("handler"), []

    def handler(record: Record) -> None:
        inner.info("from the handler")
        seen.append(record.message)
        raise OSError("no network")

    logging.add_handler(handler)
    try:
        logged(2, lambda: logging.get_logger("talker").info("line"))
    finally:
        logging.remove_handler(handler)
        logging.remove_handler(handler)
    assert seen == ["line", "line"]
    lines = stream.getvalue().splitlines()
    assert [line.split()[0] for line in lines] == ["INFO", "INFO", "ERROR", "INFO", "INFO"]
    assert "failed: OSError: no network" in lines[2]


def test_threads_log_whole_lines_and_once_is_once(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stderr", stream)
    logger, barrier = logging.get_logger("talker"), threading.Barrier(4)

    def work() -> None:
        barrier.wait(10)
        for _ in range(50):
            logger.info("often")
            logger.info("once", once=True)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(10)
    messages = [line.rpartition(": ")[2] for line in stream.getvalue().splitlines()]
    assert (messages.count("often"), messages.count("once"), len(messages)) == (200, 1, 201)


@pytest.mark.parametrize(
    ("environ", "expected"),
    [
        ({"ROS_LOG_DIR": "/logs", "ROS_HOME": "/ros"}, "/logs"),
        ({"ROS_LOG_DIR": "~/logs"}, "/home/u/logs"),
        ({"ROS_HOME": "/ros"}, "/ros/log"),
        ({}, "/home/u/.ros/log"),
    ],
)
def test_the_logging_directory(environ: dict[str, str], expected: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in {"HOME": "/home/u", "USERPROFILE": "/home/u"}.items():
        monkeypatch.setenv(name, value)
    for name in ("ROS_LOG_DIR", "ROS_HOME"):
        monkeypatch.setenv(name, environ.get(name, ""))
    assert logging.get_logging_directory() == Path(expected)


def test_a_line_that_is_off_costs_next_to_nothing() -> None:
    class Empty:
        def debug(self, message: str, **kwargs: object) -> bool:
            return False

    logger, empty, count = logging.get_logger("talker"), Empty(), 20_000
    logger.debug("x")
    cost = min(timeit.repeat(lambda: logger.debug("x"), number=count, repeat=5))
    call = min(timeit.repeat(lambda: empty.debug("x"), number=count, repeat=5))
    assert (cost - call) / count < 0.3e-6


def test_the_standard_library_stays_reachable() -> None:
    assert stdlib_logging.getLogger("x").name == "x"
    assert logging.get_logger("x").__class__ is RcutilsLogger


def test_a_command_line_may_silence_the_console(capfd: pytest.CaptureFixture[str], bus: Bus) -> None:
    for flag, text in (("--disable-stdout-logs", "one"), ("--enable-stdout-logs", "two")):
        context = Context(transport=MemoryTransport(bus=bus))
        context.init(["--ros-args", flag])
        with context:
            logging.get_logger("here").info(text)
    printed = capfd.readouterr().err
    assert "one" not in printed
    assert "two" in printed
