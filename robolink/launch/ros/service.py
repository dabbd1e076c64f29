"""Runner of a LaunchService: joins the visit of launch descriptions, the supervisor of processes and an asyncio loop.

All of the launch happens on the loop's thread: handlers, functions, coroutines. The supervisor has a thread of its own,
from the first process on. What it notices comes to the loop; what follows goes back as requests of a director.
"""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from robolink.exceptions import RobolinkError
from robolink.launch.entry import Entry
from robolink.launch.planning import as_process, processes
from robolink.launch.ros.entries import EntryMaker
from robolink.launch.ros.launch import logging as launch_logging
from robolink.launch.ros.launch.bases import LaunchContext, LaunchError
from robolink.launch.ros.launch.conditions import evaluate_condition_expression
from robolink.launch.ros.launch.events import Shutdown
from robolink.launch.ros.launch.processes import ExecuteLocal
from robolink.launch.ros.launch.signals import AsyncSafeSignalManager
from robolink.launch.ros.launch.utilities import perform_substitutions
from robolink.launch.ros.output import Output
from robolink.launch.ros.reactions import Reactions
from robolink.launch.ros.visit import Visit
from robolink.supervisor import Process, Supervisor
from robolink.supervisor.director import End, Request, Signal, Stop, Tell
from robolink.workspace import user_workspace

if TYPE_CHECKING:
    from robolink.launch.ros.stage import NodeThread
    from robolink.node import Node

_FOR_EVER = float("inf")
_NOT_STARTED = 127


class Runner:
    """One run of a LaunchService.

    Args:
        context: Context of the launch, with what was emitted before.
        debug: True lets asyncio check more, and the log have all.
    """

    def __init__(self, context: LaunchContext, *, debug: bool = False) -> None:
        self._context, self._debug = context, debug
        self._level = launch_logging.launch_config.level
        launch_logging.launch_config.level = _DEBUG if debug else _INFO
        self._logger = launch_logging.get_logger("launch")
        home = user_workspace(None)
        self._visit = Visit(context, EntryMaker(home, context.said.append), _program())
        self._stage = _Stage(self)
        self._reactions: Reactions[Process] = Reactions(self._visit, self._stage, outlives=True)
        self._outputs: dict[str, Output] = {}
        self._supervision: _Supervision | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._interrupted: Shutdown | None = None
        self._to_restart: dict[str, None] = {}
        """Names of the processes that have ended and are to be started again."""
        self._code = 0
        self._is_abandoned = False

    async def run(self, *, shutdown_when_idle: bool) -> int:
        """Run until all has ended, and return the exit code; `shutdown_when_idle` ends it when nothing is left."""
        self._loop = asyncio.get_running_loop()
        self._woken = asyncio.Event()
        if self._debug:
            self._loop.set_debug(True)
        with self._being_the_loop(), self._handling_signals():
            launch_logging.log_launch_config(logger=self._logger)
            try:
                await self._until_idle(shutdown_when_idle=shutdown_when_idle)
            except asyncio.CancelledError:
                self._logger.error("run task was canceled")
                self._code = 1
            except GeneratorExit:  # its loop went away in the middle of it: nothing can be awaited
                self._is_abandoned = True
                raise
            finally:
                if not self._is_abandoned:
                    await self._end()
                elif self._supervision is not None:
                    self._supervision.stop()
        return self._code

    @contextmanager
    def _being_the_loop(self) -> Iterator[None]:
        context = self._context
        context._set_asyncio_loop(self._loop)
        context.is_shutdown = False
        context.on_change = self._wake
        try:
            yield
        finally:
            context._set_asyncio_loop(None)
            context.on_change = None

    @contextmanager
    def _handling_signals(self) -> Iterator[None]:
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        task = asyncio.current_task()
        assert task is not None

        def terminate(number: int) -> None:
            self._logger.error(f"{signal.Signals(number).name}: the processes are stopped, and this ends")
            task.cancel()

        with AsyncSafeSignalManager(self._loop) as manager:
            manager.handle(signal.SIGINT, self._interrupt)
            manager.handle(signal.SIGTERM, terminate)
            if sys.platform != "win32":
                manager.handle(signal.SIGQUIT, terminate)
            yield

    def _interrupt(self, _: int) -> None:
        """Handle Ctrl-C: unlike a program's event it has reached no process, since each is in a session of its own."""
        text = "user interrupted with ctrl-c (SIGINT)"
        if self._interrupted is not None:
            self._logger.warning(f"{text} again, ignoring...")
            return
        self._logger.warning(text)
        self._interrupted = Shutdown(reason="ctrl-c (SIGINT)", due_to_sigint=True)
        self._context.emit_event_sync(self._interrupted)

    # The loop

    async def _until_idle(self, *, shutdown_when_idle: bool) -> None:
        self.take(self._reactions.begin(self.now))
        while True:
            self._woken.clear()
            self.take(self._reactions.settle(self.now))
            left = self._left()
            if not left and not self._context.emitted:
                if self._context.is_shutdown:
                    return
                if shutdown_when_idle:
                    self._context.emit_event_sync(Shutdown(reason="idle"))
                    continue
            woken = self._loop.create_task(self._woken.wait())
            try:
                await asyncio.wait([*left, woken], return_when=asyncio.FIRST_COMPLETED)
            finally:
                if not self._loop.is_closed():
                    woken.cancel()

    def _left(self) -> list[asyncio.Future[Any]]:
        """Return the futures for which it waits; one that failed ends the launch."""
        visit, context = self._visit, self._context
        futures = [*(future for _, future in visit.futures), *context.awaited]
        for each in futures:
            if each.done() and not each.cancelled() and (error := each.exception()) is not None:
                self._fail(f"{type(error).__name__}: {error}" if str(error) else type(error).__name__)
        visit.futures = [pair for pair in visit.futures if not pair[1].done()]
        context.awaited = [each for each in context.awaited if not each.done()]
        return [*(future for _, future in visit.futures), *context.awaited]

    @property
    def now(self) -> float:
        """Time of the loop, in seconds."""
        return self._loop.time()

    def _wake(self) -> None:
        """Look for what is new, soon; called from any thread."""
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._woken.set)

    def call(self, act: Callable[[float], Sequence[Request[Process]]]) -> None:
        """Call `act` with the time on the loop, and carry out what it returns; from any thread."""
        self._loop.call_soon_threadsafe(lambda: self.take(act(self.now)))

    def take(self, requests: Sequence[Request[Process]]) -> None:
        """Carry out requests, and plan the next timer."""
        stored: list[Request[Process]] = []
        for each in requests:
            if isinstance(each, Tell):
                level = logging.getLevelName({"WARN": "WARNING", "FATAL": "CRITICAL"}.get(each.severity, each.severity))
                launch_logging.get_logger("launch.user").log(level, each.text)
            elif isinstance(each, End):
                stored += self._ended(each)
            else:
                if isinstance(each, (Signal, Stop)):
                    self._note_signal(each)
                stored.append(each)
        if stored:
            self._supervised().request(stored)
        self._plan_timer()
        self._woken.set()

    def _plan_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        due = self._reactions.deadline
        if due is not None:
            self._timer = self._loop.call_at(due, lambda: self.take(self._reactions.woken(max(due, self.now))))

    def _ended(self, request: End) -> list[Request[Process]]:
        """Return the requests that stop all processes, since the launch ends, or since it has failed."""
        if request.code:
            self._fail(request.reason)
            return []
        event = self._reactions.shutdown_event
        is_interrupted = event.due_to_sigint and not self._context.noninteractive and event is not self._interrupted
        for name in self._to_restart:
            self._complete(name)
        return [Stop(name, is_interrupted) for name in (*self._reactions.alive, *self._to_restart)]

    def _fail(self, reason: str) -> None:
        text = f"Caught exception in launch: {reason}"
        self._logger.error(text)
        self._code = 1
        if not self._context.is_shutdown:
            self._context.emit_event_sync(Shutdown(reason=text))

    def _note_signal(self, request: Signal | Stop) -> None:
        if isinstance(request, Stop) and request.is_interrupted:
            return
        number = signal.SIGINT if isinstance(request, Stop) else signal.Signals(request.number)
        if request.name in self._reactions.alive:
            self._logger.info(f"sending signal '{number.name}' to process[{self._name_of(request.name)}]")

    async def _end(self) -> None:
        """Stop what still runs, which is nothing after an orderly end."""
        if self._timer is not None:
            self._timer.cancel()
        if self._supervision is not None:
            await self._supervision.end()
        self._stage.close()

    # What the supervisor notices, on the loop

    def _supervised(self) -> _Supervision:
        if self._supervision is None:
            self._supervision = _Supervision(self, self._loop)
        return self._supervision

    def _name_of(self, name: str) -> str:
        action = self._reactions.action_of(name)
        return str((action.process_details or {}).get("name", name)) if action is not None else name

    def planned(self, process: Process) -> Process:
        """Return a process as its action wants it; where its lines go is settled, too."""
        action = self._reactions.action_of(process.name)
        if action is None or action.process_details is None:
            return process
        self._outputs[process.name] = Output(action, self._context)
        details = action.process_details
        is_command = not process.holds_interrupts
        if not is_command:
            details["cmd"] = list(process.argv)
        elif action.process_description.env is not None:
            process = replace(process, env={}, base=details["env"])
        if process.base is None:
            process = replace(process, base=dict(self._context.environment))
        with self._visit.placing(action):
            patience = self._patience(action)
        rules = replace(process.rules, on_exit="ignore", patience=patience)
        terminal = _is_terminal(action, self._context)
        if action.log_cmd:
            words = " ".join(each for each in details["cmd"] if each.strip())
            self._log(process.name).info(f"process details: cmd='{words}', cwd='{details['cwd']}'")
        return replace(process, rules=rules, apart=True, terminal=terminal)

    def _patience(self, action: ExecuteLocal) -> tuple[float, float]:
        first, second = (
            _number(name, perform_substitutions(self._context, given))
            for name, given in (
                ("sigterm_timeout", action.sigterm_timeout),
                ("sigkill_timeout", action.sigkill_timeout),
            )
        )
        return first, second

    def _log(self, name: str) -> Any:
        return launch_logging.get_logger(self._name_of(name))

    def started(self, name: str, pid: int) -> None:
        """Handle that a process runs."""
        self._to_restart.pop(name, None)
        self._log(name).info(f"process started with pid [{pid}]")
        self.take(self._reactions.started(name, pid, self.now))
        if self._context.is_shutdown:  # it was requested before the end, and started behind it
            self._supervised().request([Stop(name)])

    def wrote(self, name: str, piece: bytes, fd: int) -> None:
        """Handle a piece of what a process writes."""
        self._outputs[name].write(piece, fd)  # first: who hears of the event looks at all that was written
        self.take(self._reactions.line(name, piece, self.now, fd))

    def exited(self, name: str, returncode: int, *, is_over: bool) -> None:
        """Handle that a process has ended; `is_over` unless it is started again."""
        action = self._reactions.action_of(name)
        assert action is not None
        if not is_over:
            self._to_restart[name] = None
        if name in self._reactions.alive:
            self._outputs[name].flush()
            self._tell_end(action, name, returncode)
            self.take(self._reactions.exited(name, returncode, self.now))
        else:
            self._log(name).error("the process cannot be started")
        if not is_over and self._context.is_shutdown:
            self._supervised().request([Stop(name)])
            self._to_restart.pop(name, None)
        if name not in self._to_restart:
            action.complete()
        self._woken.set()

    def _complete(self, name: str) -> None:
        action = self._reactions.action_of(name)
        if action is not None:
            action.complete()

    def _tell_end(self, action: ExecuteLocal, name: str, returncode: int) -> None:
        details = action.process_details or {}
        if returncode == 0:
            self._log(name).info(f"process has finished cleanly [pid {details.get('pid')}]")
            return
        words = " ".join(each for each in details.get("cmd", []) if each.strip())
        self._log(name).error(f"process has died [pid {details.get('pid')}, exit code {returncode}, cmd '{words}'].")


_INFO, _DEBUG = 20, 10


def _program() -> Path:
    """Return the program's own file, for errors that have no better place."""
    return Path(sys.argv[0] if sys.argv and sys.argv[0] else "launch").absolute()


def _is_terminal(action: ExecuteLocal, context: LaunchContext) -> bool:
    if "emulate_tty" in context.launch_configurations:
        return evaluate_condition_expression(context, [*_text(context.launch_configurations["emulate_tty"])])
    return bool(action.emulate_tty)


def _text(value: object) -> list[Any]:
    from robolink.launch.ros.launch.utilities import normalize_to_list_of_substitutions

    return normalize_to_list_of_substitutions(str(value))


def _number(name: str, text: str) -> float:
    try:
        return max(0.0, float(text))
    except ValueError:
        raise LaunchError(f"{name} is a number of seconds, got '{text:.60}'") from None


class _Stage:
    """Stage of the reactions of a LaunchService."""

    def __init__(self, runner: Runner) -> None:
        self._runner = runner
        self._node: NodeThread | None = None

    def plan(self, entries: list[Entry]) -> Sequence[Process]:
        """Return the processes in which entries run."""
        return [self._runner.planned(as_process(each)) for each in processes(entries)]

    def with_node(self, act: Callable[[Node], object]) -> None:
        """Call `act` with the launcher's own node, on its thread."""
        if self._node is None:
            from robolink.launch.ros.stage import NodeThread, own_context

            self._node = NodeThread(own_context, self._say)
        self._node(act)

    def _say(self, text: str) -> None:
        self.post(lambda now: [Tell(text)])

    def post(self, act: Callable[[float], Sequence[Request[Process]]]) -> None:
        """Call `act` with the time on the loop."""
        self._runner.call(act)

    def close(self) -> None:
        """Leave the network."""
        if self._node is not None:
            self._node.__exit__()


class _Supervision:
    """Supervisor on a thread of its own, and the director by which the loop leads it.

    Args:
        runner: The runner that hears of the processes.
        loop: The loop on which it hears of them.
    """

    def __init__(self, runner: Runner, loop: asyncio.AbstractEventLoop) -> None:
        self._runner, self._loop = runner, loop
        self._ended: asyncio.Future[None] = loop.create_future()
        self.deadline: float | None = _FOR_EVER
        self._output: TextIO = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 - its end closes it
        self._supervisor = Supervisor([], output=self._output, director=lambda _: self)
        self._thread = threading.Thread(target=self._run, name="launch-supervisor", daemon=True)
        self._thread.start()

    hears_lines = True

    def request(self, requests: Sequence[Request[Process]]) -> None:
        """Carry out requests on the supervisor's thread."""
        self._supervisor.direct(lambda now: requests)

    def stop(self) -> None:
        """Ask what still runs to stop; returns at once."""
        if not self._supervisor.is_end_requested:
            self._supervisor.stop()

    async def end(self) -> None:
        """Wait for the end of what still runs, after it was asked to stop; a cancellation of the wait asks harder."""
        self.deadline = None
        self.request([])
        while not self._ended.done():
            self.stop()
            try:
                await asyncio.shield(self._ended)
            except asyncio.CancelledError:
                self._supervisor.stop(in_hurry=True)
        self._thread.join()

    def _run(self) -> None:
        try:
            self._supervisor.run()
        except RobolinkError as error:
            text = str(error)
            self._hand_on(lambda: self._runner.take([Tell(text)]))
        finally:
            self._output.close()
            self._hand_on(self._ended.set_result, None)

    def _hand_on(self, callback: Callable[..., object], *args: Any) -> None:
        try:
            self._loop.call_soon_threadsafe(callback, *args)
        except RuntimeError:  # the loop was closed in the middle of everything: nobody leads the processes any more
            self.stop()

    # What it hears as a director, on the supervisor's thread

    def begin(self, now: float) -> Sequence[Request[Process]]:
        """Begin with nothing."""
        return ()

    def started(self, name: str, pid: int, now: float) -> Sequence[Request[Process]]:
        """Hand on that a process runs."""
        self._hand_on(self._runner.started, name, pid)
        return ()

    def exited(self, name: str, returncode: int, now: float) -> Sequence[Request[Process]]:
        """Hand on that a process has ended."""
        self._hand_on(self._exited, name, returncode)
        return ()

    def _exited(self, name: str, returncode: int) -> None:
        states = {each.name: each.state for each in self._supervisor.status()}
        self._runner.exited(name, returncode, is_over=states.get(name) in ("ended", "stopped"))

    def left_out(self, name: str, now: float) -> Sequence[Request[Process]]:
        """Nothing that was planned is left out."""
        return ()

    def line(self, name: str, line: bytes, now: float, fd: int | None = None) -> Sequence[Request[Process]]:
        """Hand on what a process writes."""
        self._hand_on(self._runner.wrote, name, line, fd or 1)
        return ()

    def stopping(self, now: float) -> Sequence[Request[Process]]:
        """Nothing follows: the loop itself has asked for it."""
        return ()

    def woken(self, now: float) -> Sequence[Request[Process]]:
        """Nothing is planned here."""
        return ()
