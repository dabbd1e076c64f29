"""Errors within a LaunchService: each ends the launch with 1 and all that it runs, none leaves it waiting."""

from __future__ import annotations

import asyncio
import gc
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink.launch.ros.launch import LaunchContext, LaunchDescription, LaunchService
from robolink.launch.ros.launch import logging as launch_logging
from robolink.launch.ros.launch.actions import (
    EmitEvent,
    ExecuteProcess,
    OpaqueFunction,
    RegisterEventHandler,
    TimerAction,
)
from robolink.launch.ros.launch.bases import Event, EventHandler, LaunchArgumentError
from robolink.launch.ros.launch.event_handlers import OnShutdown
from robolink.launch.ros.launch.substitutions import LaunchConfiguration

PATIENCE = 20.0
"""Longest time in seconds until a launch has ended."""


@pytest.fixture(autouse=True)
def _logs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "logs"))
    launch_logging.reset()
    yield
    launch_logging.reset()


def ran(*entities: Any) -> list[int | BaseException]:
    """Run a description and return how it ended: its exit code, or what it raised; nothing if it hangs."""
    service = LaunchService()
    service.include_launch_description(LaunchDescription(list(entities)))
    ends: list[int | BaseException] = []

    def run() -> None:
        try:
            ends.append(service.run())
        except BaseException as error:
            ends.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(PATIENCE)
    return ends


def fails(*args: Any) -> Any:
    raise ZeroDivisionError("here")


def ends(context: LaunchContext) -> None:
    sys.exit(5)


def matcher(event: Event) -> bool:
    return bool(1 / 0)


def process(**options: Any) -> ExecuteProcess:
    return ExecuteProcess(cmd=[sys.executable, "-S", "-c", "import time; time.sleep(60)"], **options)


def soon(*actions: Any) -> TimerAction:
    return TimerAction(period=0.01, actions=actions)


ERRORS: dict[str, Callable[[], list[Any]]] = {
    "a function of a timer": lambda: [soon(OpaqueFunction(function=fails))],
    "a program's end in a timer": lambda: [soon(OpaqueFunction(function=ends))],
    "what is not an action, in a timer": lambda: [TimerAction(period=0.0, actions=[3])],  # type: ignore[list-item]
    "a timer that is negative": lambda: [TimerAction(period=-1.0, actions=[])],
    "a timer that is not a number": lambda: [TimerAction(period="soon", actions=[])],
    "a timer that is negative, within a timer": lambda: [soon(TimerAction(period=-1.0, actions=[]), soon())],
    "two timers at one moment": lambda: [soon(OpaqueFunction(function=fails)), soon(), soon()],
    "a matcher": lambda: [RegisterEventHandler(EventHandler(matcher=matcher, entities=[])), soon()],
    "a matcher, of an event": lambda: [
        EmitEvent(event=Event()),
        RegisterEventHandler(EventHandler(matcher=matcher, entities=[])),
    ],
    "a timeout of a process": lambda: [process(sigterm_timeout="long")],
    "a timeout of a process, in a timer": lambda: [soon(process(sigkill_timeout="long"))],
    "a timeout without a value": lambda: [process(sigterm_timeout=LaunchConfiguration("nowhere"))],
    "a timer's end": lambda: [
        TimerAction(period=60.0, actions=[], cancel_on_shutdown="perhaps"),
        TimerAction(period=60.0, actions=[]),
        soon(OpaqueFunction(function=fails)),
    ],
    "the reaction to the end": lambda: [RegisterEventHandler(OnShutdown(on_shutdown=fails)), soon()],
}


@pytest.mark.parametrize("kind", ERRORS)
def test_an_error_ends_the_launch_with_1(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert ran(*ERRORS[kind]()) == [1]
    lines = [line for line in capsys.readouterr().out.splitlines() if "Caught exception in launch: " in line]
    assert 1 <= len(lines) <= 5
    assert __file__.rpartition("/")[2] in lines[0]


@pytest.mark.parametrize("wrong", [3, None, Event, "end"])
def test_what_is_not_an_event_is_refused_at_once(wrong: Any) -> None:
    service = LaunchService()
    with pytest.raises(LaunchArgumentError, match="an event is expected"):
        service.emit_event(wrong)
    assert ran(EmitEvent(event=wrong)) == [1]


@pytest.mark.processes
@pytest.mark.parametrize("kind", ["a function of a timer", "a matcher", "a timeout of a process, in a timer"])
def test_an_error_stops_the_processes(kind: str) -> None:
    running = process()
    assert ran(running, *ERRORS[kind]()) == [1]
    assert running.return_code != 0


@pytest.mark.processes
@pytest.mark.filterwarnings("ignore:coroutine .* was never awaited")
def test_a_loop_that_is_closed_under_it_takes_the_processes_along(monkeypatch: pytest.MonkeyPatch) -> None:
    errors: list[Any] = []
    monkeypatch.setattr(threading, "excepthook", errors.append)
    monkeypatch.setattr(sys, "unraisablehook", errors.append)
    running = process()
    service = LaunchService()
    service.include_launch_description(LaunchDescription([running, process()]))
    loop = asyncio.new_event_loop()
    loop.set_exception_handler(lambda *_: None)  # it tells of tasks that were left pending
    task = loop.create_task(service.run_async())

    async def until_it_runs() -> None:
        while running.process_details is None or running.process_details.get("pid", 0) == 0:
            await asyncio.sleep(0.01)

    loop.run_until_complete(asyncio.wait_for(until_it_runs(), PATIENCE))
    assert running.process_details is not None
    (thread,) = [each for each in threading.enumerate() if each.name == "launch-supervisor"]
    loop.close()
    os.kill(running.process_details["pid"], signal.SIGTERM)
    thread.join(PATIENCE)
    assert not thread.is_alive()
    del task, service
    gc.collect()
    assert errors == []
