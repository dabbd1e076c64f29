"""How a host runs programs in real time: each in a thread of its own, side by side."""

from __future__ import annotations

import heapq
import itertools
import os
import queue
import sys
import threading
import time
import weakref
from collections.abc import Callable
from concurrent.futures import thread as pools
from typing import TYPE_CHECKING

from robolink.defaults import use_defaults
from robolink.oneprocess.hosted import HostedContext
from robolink.oneprocess.parts import Killed
from robolink.oneprocess.surroundings import set_environment
from robolink.oneprocess.threads import end_thread
from robolink.queues import get_within
from robolink.timebase import SystemTime

if TYPE_CHECKING:
    from robolink.oneprocess.program import Program

LOOK_UP = 0.1
"""Seconds after which a wait ends by itself: on Windows Ctrl-C does not end one."""

LAST_WAIT = 1.0
"""Seconds that threads have to end once their programs have."""

START_PATIENCE = 1.0
"""Seconds that a program has to read its command line, before the next one gets its own."""


class RealPace:
    """Lets programs go on by the computer's clock; `run_until` does in its caller's thread what `at` has noted."""

    turns = None
    context_type = HostedContext

    def __init__(self) -> None:
        self.time = SystemTime()
        self._incoming: queue.SimpleQueue[tuple[int, Callable[[], object]] | None] = queue.SimpleQueue()
        self._heap: list[tuple[int, int, Callable[[], object]]] = []
        self._serial = itertools.count()
        self._threads: dict[Program, threading.Thread] = {}
        self.threads: weakref.WeakSet[threading.Thread] = weakref.WeakSet()
        """What programs have started."""
        self._starting = threading.Lock()

    def begin(self, program: Program) -> None:
        """Begin a program in a thread of its own; give it the process's command line and environment to read."""
        read = threading.Event()
        thread = threading.Thread(target=self._live, args=(program, read.set), name=program.name, daemon=True)
        self._threads[program] = thread
        program.on_read = read.set
        with self._starting:
            argv, environment = sys.argv, {name: os.environ.get(name) for name in program.env}
            sys.argv = program.argv
            os.environ.update(program.env)
            thread.start()
            read.wait(START_PATIENCE)
            sys.argv = argv
            set_environment(environment)

    def _live(self, program: Program, read: Callable[[], None]) -> None:
        program.defaults.in_main_thread = lambda: threading.current_thread() is self._threads[program]
        use_defaults(program.defaults)
        try:
            program.begin()
        except Killed:
            return
        finally:
            read()

    def run_until(self, condition: Callable[[], bool], until: int) -> bool:
        """Wait until the condition, asked whenever something has happened, holds or it is `until`."""
        while not condition() and self.time.steady() < until:
            wake_at = min(until, self._heap[0][0]) if self._heap else until
            try:
                came = get_within(self._incoming, min(LOOK_UP, max(0.0, (wake_at - self.time.steady()) / 1e9)))
            except queue.Empty:
                came = None
            if came is not None:
                heapq.heappush(self._heap, (came[0], next(self._serial), came[1]))
            while self._heap and self._heap[0][0] <= self.time.steady():
                heapq.heappop(self._heap)[2]()
        return condition()

    def at(self, time_ns: int, act: Callable[[], object]) -> None:
        """Have `act()` called when it is so late, by who runs the host; from any thread, or a signal's handler."""
        self._incoming.put((time_ns, act))

    def interrupt(self, program: Program) -> None:
        """Interrupt a program."""
        program.interrupt()

    def break_in(self, program: Program, error: BaseException | None) -> None:
        """End what the program's main thread sleeps for; executors have been woken by their contexts."""
        if error is not None:
            program.interrupted.set()

    def unwind(self, program: Program) -> None:
        """Have the program's main thread end where it is, as far as Python can: not within C."""
        thread = self._threads.get(program)
        program.interrupted.set()
        if thread is not None and thread.is_alive() and thread is not threading.current_thread():
            end_thread(thread)

    def end_daemons(self, program: Program) -> None:
        """Do nothing: Python ends no thread."""

    def note_exit(self) -> None:
        """Let whoever runs the host look around."""
        self._incoming.put(None)

    def close(self) -> None:
        """Wait a moment for the threads of programs to end; what is left keeps this process from nothing."""
        ends, queues = time.monotonic() + LAST_WAIT, vars(pools)["_threads_queues"]
        for thread in (*self._threads.values(), *self.threads):
            if queues.pop(thread, None) is None:  # else one of a pool, for which the interpreter would wait
                thread.join(max(0.0, ends - time.monotonic()))
