"""Periodic background thread: calls `look()` every N seconds while a `with` block is open."""

from __future__ import annotations

import threading
from types import TracebackType
from typing import TypeVar

from robolink.system import waits

ThreadT = TypeVar("ThreadT", bound="PeriodicThread")


class PeriodicThread:
    """Periodic thread: calls `look` every `every` seconds, the first time after `first` seconds if that is given."""

    def __init__(self, name: str, every: float, first: float | None = None) -> None:
        self._every, self._first = every, every if first is None else first
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._work, name=name, daemon=True)

    def look(self) -> None:
        """Do one period's work."""
        raise NotImplementedError

    def __enter__(self: ThreadT) -> ThreadT:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._closed.set()
        waits.join(self._thread, 1.0)

    def _work(self) -> None:
        pause = self._first
        while not self._closed.wait(pause):
            self.look()
            pause = self._every
