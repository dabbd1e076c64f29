"""A LaunchService runs launch descriptions within a program: events, handlers, coroutines, processes."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink.launch.ros.launch import LaunchContext, LaunchDescription, LaunchService
from robolink.launch.ros.launch import logging as launch_logging
from robolink.launch.ros.launch.actions import (
    EmitEvent,
    ExecuteProcess,
    LogInfo,
    OpaqueCoroutine,
    OpaqueFunction,
    RegisterEventHandler,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
)
from robolink.launch.ros.launch.bases import Action, Event, EventHandler, LaunchError
from robolink.launch.ros.launch.event_handlers import (
    OnExecutionComplete,
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
    OnShutdown,
)
from robolink.launch.ros.launch.events import Shutdown as ShutdownEvent
from robolink.launch.ros.launch.process_events import ProcessExited


@pytest.fixture(autouse=True)
def _logs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "logs"))
    launch_logging.reset()
    yield
    launch_logging.reset()


def ran(*entities: Any, **options: Any) -> int:
    """Run a description and return the exit code."""
    service = LaunchService(**options)
    service.include_launch_description(LaunchDescription(list(entities)))
    return service.run()


def python(code: str, **options: Any) -> ExecuteProcess:
    """Return the action that runs a line of Python."""
    return ExecuteProcess(cmd=[sys.executable, "-S", "-c", code], **options)


# Without processes


def test_an_empty_launch_ends_at_once() -> None:
    assert ran() == 0


def test_lines_are_logged_as_ros_does(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert ran(LogInfo(msg="hello")) == 0
    assert "[INFO] [launch.user]: hello\n" in capsys.readouterr().out
    (folder,) = (each for each in (tmp_path / "logs").iterdir() if not each.is_symlink())
    assert "[INFO] [launch.user]: hello\n" in (folder / "launch.log").read_text()


def test_functions_coroutines_and_timers_run_on_the_loop() -> None:
    seen: list[Any] = []

    def here(context: LaunchContext) -> None:
        seen.append((asyncio.get_running_loop() is context.asyncio_loop, threading.current_thread().name))

    async def later(context: LaunchContext) -> None:
        await asyncio.sleep(0.01)
        seen.append("later")

    actions = [OpaqueFunction(function=here), OpaqueCoroutine(coroutine=later)]
    assert ran(*actions, TimerAction(period=0.05, actions=[OpaqueFunction(function=here)])) == 0
    assert seen == [(True, "MainThread"), "later", (True, "MainThread")]


def test_a_coroutine_is_cancelled_when_the_launch_ends() -> None:
    seen: list[str] = []

    async def forever(context: LaunchContext) -> None:
        try:
            await asyncio.sleep(1000)
        except asyncio.CancelledError:
            seen.append("cancelled")
            raise

    assert ran(OpaqueCoroutine(coroutine=forever), TimerAction(period=0.01, actions=[Shutdown()])) == 0
    assert seen == ["cancelled"]


def test_a_future_of_the_context_is_waited_for() -> None:
    seen: list[str] = []

    def wait(context: LaunchContext) -> None:
        assert context.asyncio_loop is not None
        future = context.asyncio_loop.create_future()
        future.add_done_callback(lambda _: seen.append("done"))
        context.add_completion_future(future)
        context.asyncio_loop.call_later(0.02, future.set_result, None)

    assert ran(OpaqueFunction(function=wait)) == 0
    assert seen == ["done"]


def test_an_action_with_a_future_is_complete_when_that_is() -> None:
    seen: list[str] = []

    class Slow(Action):
        future: asyncio.Future[None] | None = None

        def execute(self, context: LaunchContext) -> None:
            assert context.asyncio_loop is not None
            self.future = context.asyncio_loop.create_future()
            context.asyncio_loop.call_later(0.02, self.end)

        def end(self) -> None:
            assert self.future is not None
            seen.append("end")
            self.future.set_result(None)

        def get_asyncio_future(self) -> asyncio.Future[None] | None:
            return self.future

    slow = Slow()
    complete = OnExecutionComplete(target_action=slow, on_completion=lambda event, context: seen.append("complete"))
    assert ran(RegisterEventHandler(complete), slow) == 0
    assert seen == ["end", "complete"]


class Knock(Event):
    """An event of a program's own."""

    name = "tests.Knock"


def test_events_come_from_any_thread_and_wait_while_it_does_not_run() -> None:
    service, seen, is_there = LaunchService(), list[str](), threading.Event()

    def heard(context: LaunchContext) -> None:
        seen.append(type(context.locals.event).__name__)
        is_there.set()

    handler = EventHandler(
        matcher=lambda event: isinstance(event, (Knock, ShutdownEvent)), entities=OpaqueFunction(function=heard)
    )
    service.include_launch_description(LaunchDescription([RegisterEventHandler(handler)]))
    service.emit_event(Knock())
    assert service.context._event_queue.qsize() == 2

    def beside() -> None:
        assert is_there.wait(10)
        is_there.clear()
        service.emit_event(Knock())
        assert is_there.wait(10)
        service.shutdown()

    thread = threading.Thread(target=beside)
    thread.start()
    assert service.run(shutdown_when_idle=False) == 0
    thread.join()
    assert seen == ["Knock", "Knock", "Shutdown"]
    service.emit_event(Knock())
    assert service.run() == 0  # handlers stay
    assert seen[3:] == ["Knock", "Shutdown"]


def test_an_error_ends_the_launch_with_1_and_names_the_line(capsys: pytest.CaptureFixture[str]) -> None:
    seen: list[str] = []

    def fail(context: LaunchContext) -> None:
        raise ZeroDivisionError("here")

    at_end = RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: seen.append(event.reason)))
    assert ran(at_end, OpaqueFunction(function=fail)) == 1
    assert "ZeroDivisionError" in seen[0]
    assert "[ERROR] [launch]: Caught exception in launch: " in capsys.readouterr().out


def test_an_error_of_a_coroutine_ends_the_launch_with_1() -> None:
    async def fail() -> None:
        raise ValueError("no")

    assert ran(OpaqueCoroutine(coroutine=fail, ignore_context=True), TimerAction(period=60.0, actions=[])) == 1


def test_it_runs_in_a_thread_and_in_a_running_loop() -> None:
    codes: list[int] = []
    thread = threading.Thread(target=lambda: codes.append(ran(TimerAction(period=0.01, actions=[]))))
    thread.start()
    thread.join(20)

    async def main() -> int:
        service = LaunchService()
        service.include_launch_description(LaunchDescription([TimerAction(period=0.01, actions=[])]))
        assert service.event_loop is None
        code = await service.run_async()
        assert service.task is asyncio.current_task()
        return code

    assert [*codes, asyncio.run(main())] == [0, 0]


def test_it_runs_once_at_a_time() -> None:
    async def main() -> None:
        service = LaunchService()
        task = asyncio.create_task(service.run_async(shutdown_when_idle=False))
        await asyncio.sleep(0)
        with pytest.raises(LaunchError, match="runs already"):
            await service.run_async()
        ending = service.shutdown()
        assert ending is not None
        await ending
        assert await task == 0

    asyncio.run(main())


def test_run_in_a_running_loop_names_run_async() -> None:
    async def main() -> None:
        with pytest.raises(LaunchError, match=r"await run_async\(\)"):
            LaunchService().run()

    asyncio.run(main())


def test_cancelling_its_task_ends_it_with_1() -> None:
    async def main() -> int:
        task = asyncio.create_task(LaunchService().run_async(shutdown_when_idle=False))
        await asyncio.sleep(0.01)
        task.cancel()
        return await task

    assert asyncio.run(main()) == 1


def test_timers_end_with_the_launch_unless_they_should_not() -> None:
    reasons: list[str] = []
    at_end = RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: reasons.append(event.reason)))
    timers = [
        TimerAction(period=0.01, actions=[Shutdown(reason="first")]),
        TimerAction(period=0.05, actions=[Shutdown(reason="never")]),
        TimerAction(period=0.06, actions=[Shutdown(reason="second")], cancel_on_shutdown=False),
    ]
    assert ran(at_end, *timers) == 0
    assert reasons == ["first", "second"]


# With processes


@pytest.mark.processes
def test_output_and_ends_of_processes_are_events(capsys: pytest.CaptureFixture[str]) -> None:
    seen: list[Any] = []
    process = python("import sys; print('out'); print('err', file=sys.stderr); sys.exit(3)", name="it", output="screen")
    handlers = [
        OnProcessStart(target_action=process, on_start=lambda event, context: seen.append(event.pid)),
        OnProcessIO(
            target_action=process,
            on_stdout=lambda event: seen.append(("out", event.text)),
            on_stderr=lambda event: seen.append(("err", event.text)),
        ),
        OnProcessExit(target_action=process, on_exit=lambda event, context: seen.append(event.returncode)),
    ]
    assert ran(*map(RegisterEventHandler, handlers), process) == 0
    pid, *pieces, code = seen
    name = process.process_details["name"] if process.process_details else ""
    assert b"".join(text for kind, text in pieces if kind == "out") == b"out\n"
    assert b"".join(text for kind, text in pieces if kind == "err") == b"err\n"
    assert (code, process.return_code, name.startswith("it-")) == (3, 3, True)
    shown = capsys.readouterr().out
    assert f"[INFO] [{name}]: process started with pid [{pid}]\n" in shown
    assert f"[{name}] out\n" in shown
    assert f"[{name}] err\n" in shown
    assert f"[ERROR] [{name}]: process has died [pid {pid}, exit code 3, " in shown


@pytest.mark.processes
def test_two_services_run_one_after_the_other() -> None:
    for _ in range(2):
        process = python("input()", on_exit=[Shutdown()])
        assert ran(process, TimerAction(period=0.2, actions=[Shutdown()])) == 0
        assert process.return_code == -signal.SIGINT if os.name == "posix" else process.return_code


@pytest.mark.processes
def test_a_process_is_started_again_until_the_launch_ends() -> None:
    codes: list[int] = []

    def note(event: ProcessExited, context: LaunchContext) -> Shutdown | None:
        codes.append(event.returncode)
        return Shutdown() if len(codes) == 3 else None

    again = python("raise SystemExit(4)", respawn=True, on_exit=note)
    assert ran(again, python("raise SystemExit(5)", respawn=True, respawn_max_retries=1, on_exit=note)) == 0
    assert codes.count(5) <= 2
    assert len(codes) < 6


@pytest.mark.processes
def test_an_environment_arrives_and_what_is_kept_can_be_read() -> None:
    code = "import os; print(os.environ.get('GIVEN'), os.environ.get('ROBOLINK_TEST_SET'), flush=True)"
    whole = python(code, env={"GIVEN": "1"}, cached_output=True)
    added = python(code, additional_env={"GIVEN": "2"}, cached_output=True)
    try:
        assert ran(SetEnvironmentVariable("ROBOLINK_TEST_SET", "x"), whole, added) == 0
    finally:
        os.environ.pop("ROBOLINK_TEST_SET", None)
    assert [each.get_stdout().split() for each in (whole, added)] == [["1", "None"], ["2", "x"]]
    with pytest.raises(LaunchError, match="cached_output=True"):
        python("").get_stdout()


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such terminals")
def test_a_terminal_is_emulated() -> None:
    code = "import sys; sys.exit(sys.stdout.isatty() + 2 * sys.stderr.isatty())"
    plain, shown = python(code), python(code, emulate_tty=True)
    assert ran(plain, shown) == 0
    assert [plain.return_code, shown.return_code] == [0, 3]
    by_configuration = python(code)
    assert ran(SetLaunchConfiguration("emulate_tty", "true"), by_configuration) == 0
    assert by_configuration.return_code == 3


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="a process group is interrupted otherwise there")
def test_a_program_that_says_ctrl_c_has_interrupted_its_processes() -> None:
    """The next step comes after `sigterm_timeout`."""
    codes: list[int] = []

    def note(event: ProcessExited, context: LaunchContext) -> None:
        codes.append(event.returncode)

    def end(event: Event) -> EmitEvent:
        return EmitEvent(event=ShutdownEvent(reason="none", due_to_sigint=True))

    for noninteractive in (True, False):
        process = python("print('here', flush=True); input()", sigterm_timeout="0.2", on_exit=note)
        begun = OnProcessIO(target_action=process, on_stdout=end)
        assert ran(process, RegisterEventHandler(begun), noninteractive=noninteractive) == 0
    assert codes == [-signal.SIGINT, -signal.SIGTERM]


ENDED_FROM_OUTSIDE = """
import os, signal, sys, threading
import robolink.compat
from launch import LaunchDescription, LaunchService
from launch.actions import ExecuteProcess, RegisterEventHandler
from launch.event_handlers import OnProcessIO

CODE = "print('here', flush=True); input()"
child = ExecuteProcess(cmd=[sys.executable, "-S", "-c", CODE])
end = lambda event: os.kill(os.getpid(), signal.{name}) if b"here" in event.text else None
service = LaunchService()
service.include_launch_description(LaunchDescription([
    child, RegisterEventHandler(OnProcessIO(target_action=child, on_stdout=end))]))
code = service.run()
print("ended", code, child.return_code, signal.getsignal(signal.{name}) is not None)
"""


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="signals end a process at once there")
@pytest.mark.parametrize(("name", "code"), [("SIGINT", 0), ("SIGTERM", 1)])
def test_a_signal_stops_the_processes_in_order(name: str, code: int, tmp_path: Path) -> None:
    script = ENDED_FROM_OUTSIDE.replace("{name}", name)
    environ = {**os.environ, "ROBOLINK_COMPAT": "always", "ROS_LOG_DIR": str(tmp_path)}
    ran = subprocess.run(
        [sys.executable, "-c", script], env=environ, capture_output=True, text=True, timeout=30, check=False
    )
    assert ran.stdout.splitlines()[-1] == f"ended {code} -2 True", ran.stderr
