"""Thread beside a participant's: it does what may take a while, in order, so that samples never wait for the graph."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable

from robolink.logging import get_logger
from robolink.system import clocks, waits
from robolink.system.waits import get_within

QUIET, LONGEST = 0.005, 0.05
"""Idle work is done after so many seconds without other work, and at the latest after so many."""

Work = Callable[[], object]


class Worker:
    """Queue of work, done by one thread."""

    def __init__(self) -> None:
        self._todo: queue.SimpleQueue[Work | threading.Event | None] = queue.SimpleQueue()
        self._idle: dict[Work, None] = {}
        self._idle_until = 0.0
        self.latest = clocks.monotonic()
        """Time of the last news, by `clocks.monotonic`: when work was last done."""
        threading.Thread(target=self._run, name="robolink dds", daemon=True).start()

    def post(self, work: Work) -> None:
        """Do some work, after all that was posted before."""
        self._todo.put(work)

    def post_idle(self, work: Work) -> None:
        """Do some work once there has been nothing else for a moment; once, however often it is posted."""
        self.post(lambda: self._note_idle(work))

    def catch_up(self, seconds: float) -> bool:
        """Wait until all is done that was posted before, for so many seconds at most; return whether it is."""
        done = threading.Event()
        self._todo.put(done)
        return waits.wait(done, seconds)

    def close(self) -> None:
        """End the thread, once it has done what was posted before."""
        self._todo.put(None)

    def _note_idle(self, work: Work) -> None:
        if not self._idle:
            self._idle_until = clocks.monotonic() + LONGEST
        self._idle[work] = None

    def _run(self) -> None:
        while True:
            try:
                work = get_within(self._todo, self._patience()) if self._idle else self._todo.get()
            except queue.Empty:
                self._do_idle_work()
                continue
            if work is None:
                return
            if isinstance(work, threading.Event):
                work.set()
            else:
                self._do(work)
                self.latest = clocks.monotonic()

    def _patience(self) -> float:
        return min(QUIET, self._idle_until - clocks.monotonic())

    def _do_idle_work(self) -> None:
        idle, self._idle = self._idle, {}
        for work in idle:
            self._do(work)

    def _do(self, work: Work) -> None:
        try:
            work()
        except Exception as error:  # noqa: BLE001 - a watch may be anybody's, and the others want to hear of it too
            get_logger("robolink.dds").error(
                f"what comes of a change of the graph failed: {type(error).__name__}: {error}"
            )
