"""Threads of hosted programs: they take turns with all others, so that each run is the same."""

from __future__ import annotations

import contextlib
import ctypes
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Executor, Future
from concurrent.futures import thread as pools
from typing import Any

from robolink.exceptions import ExternalShutdownException
from robolink.host.call_sites import frame_of, place_of
from robolink.host.participants import Killed, ProgramLike, Runner, SchedulerLike, Wait
from robolink.logging import get_logger
from robolink.running.defaults import use_defaults
from robolink.text.tracebacks import formatted

_QUIET = (Killed, SystemExit, ExternalShutdownException)


def take_part(thread: threading.Thread, program: ProgramLike, start: Callable[[threading.Thread], None]) -> None:
    """Start a thread that runs when it is its turn, for the first time when the thread that starts it waits."""
    scheduler = program.host.scheduler
    runner = Runner(scheduler, program)
    runner.thread, runner.is_daemon = thread, thread.daemon
    thread.daemon = True  # whatever it is for its program: it must not keep this process from ending
    thread._robolink_runner = runner  # type: ignore[attr-defined]
    first = runner.wait = Wait(runner, None, None)
    act = thread.run

    def run() -> None:
        scheduler.runners.belong(runner)
        use_defaults(program.defaults)
        runner.park()
        first.version, runner.wait = 1, None
        vars(pools)["_threads_queues"].pop(thread, None)  # of a pool: Python would wait for it at the end
        try:
            if first.error is None:
                act()
        except _QUIET:
            pass
        except BaseException as error:  # noqa: BLE001 - it ends this thread alone, as in every program
            if runner.killed:  # its locks are another's now, say
                return
            get_logger("robolink").error(f"a thread of {program.name} ended:\n{formatted(error)}")
        finally:
            runner.is_done = True
            scheduler.leave(runner)

    thread.run = run  # type: ignore[method-assign]
    scheduler.runners.add(runner)
    scheduler.due.append(first)
    start(thread)


def tell_of(runner: Runner) -> None:
    """Warn of a program's thread that is still there, and would keep its process from ending."""
    thread, program = runner.thread, runner.program
    if thread is None or program is None or runner.is_host or runner.is_done or runner.is_daemon or runner.is_idle:
        return
    place = place_of(frame_of(runner)) or "an unknown place"
    get_logger("robolink").warning(f"{program.name}: its thread {thread.name} goes on after its end, at {place}")


def end_thread(thread: threading.Thread) -> None:
    """Raise `Killed` in a thread where it is, as far as Python can: not within C."""
    raise_in, killed = ctypes.pythonapi.PyThreadState_SetAsyncExc, ctypes.py_object(Killed)
    theirs, ours = ctypes.c_ulong(thread.ident or 0), ctypes.c_ulong(threading.get_ident())
    # Before 3.13 this bids all threads look, again and again, until one has met an exception. While theirs stays in C,
    # or when it has just ended, all go slowly, and 3.11 does not leave a function that is traced, as for coverage: so
    # we meet one ourselves, with no call of Python in between. Theirs is met once others want Python's lock.
    try:
        raise_in(theirs, killed)
        raise_in(ours, killed)
        for _ in range(1000):
            pass
    except Killed:
        pass


class HostedPool(Executor):
    """Thread pool for callbacks of a program's multi-threaded executor."""

    def __init__(self, program: ProgramLike, size: int) -> None:
        self._program, self._size = program, size
        self._jobs: deque[tuple[Callable[..., Any], tuple[Any, ...]]] = deque()
        self._idle: deque[Runner] = deque()
        self._threads: list[threading.Thread] = []
        self._is_closed = False

    def submit(self, fn: Callable[..., Any], /, *args: Any, **_: Any) -> Future[Any]:
        """Call a function in a thread. Raises RuntimeError after `shutdown`."""
        if self._is_closed:
            raise RuntimeError("cannot schedule new futures after shutdown")
        self._jobs.append((fn, args))
        if self._idle:
            self._wake(self._idle.popleft())
        elif len(self._threads) < self._size:
            thread = threading.Thread(target=self._work, name="robolink callbacks", daemon=True)
            self._threads.append(thread)
            thread.start()
        return Future()

    def _work(self) -> None:
        scheduler = self._program.host.scheduler
        me = scheduler.runner()
        assert me is not None
        while not self._is_closed:
            while self._jobs:
                act, args = self._jobs.popleft()
                act(*args)
            self._idle.append(me)
            me.is_idle = True
            scheduler.wait()
            me.is_idle = False
            with contextlib.suppress(ValueError):
                self._idle.remove(me)

    def _wake(self, runner: Runner) -> None:
        self._program.host.scheduler.due.append(runner.wait)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Begin no more calls, and wait for the threads to end."""
        self._is_closed = True
        while self._idle:
            self._wake(self._idle.popleft())
        for thread in self._threads if wait else ():
            thread.join()


class Worker(threading.Thread):
    """Worker thread: runs what is due when it is its turn."""

    _acts_as_main = False

    def __init__(self, scheduler: SchedulerLike, work: Callable[[Runner], None]) -> None:
        super().__init__(name="robolink host", daemon=True)
        self.runner = Runner(scheduler)
        self.runner.is_host = True
        self.runner.thread = self
        self._work = work
        self.start()

    @property
    def daemon(self) -> bool:  # type: ignore[override]
        """True until it runs: it keeps no process from ending. Threads that a program starts inherit False from it."""
        return not self._acts_as_main

    def run(self) -> None:
        """Run turns until the host is closed."""
        self._acts_as_main = True
        try:
            self._work(self.runner)
        except Killed:
            return
