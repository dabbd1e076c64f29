"""Windows' way with Ctrl-C before Python 3.14: it does not interrupt a wait of the main thread, it comes behind it."""

from __future__ import annotations

import queue
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import pytest

LONGEST = 0.25
"""Longest wait in one piece, in seconds."""


class Spy:
    """Record of the waits of the main thread. Each is cut short; Ctrl-C comes at the end of one of them."""

    def __init__(self) -> None:
        self.waits: list[float | None] = []
        self.is_off = False
        """True while waits are nobody's business."""
        self.is_pressed = False
        """True once Ctrl-C has come."""
        self.until = 3
        """Number of waits after which Ctrl-C comes."""

    def note(self, seconds: float | None) -> float | None:
        """Return how long to wait in fact, if a thread waits for so many seconds."""
        if self.is_off or threading.current_thread() is not threading.main_thread():
            return seconds
        self.waits.append(seconds)
        if seconds is None or seconds > LONGEST:
            raise AssertionError(f"a wait of {seconds} s in one piece")
        return min(seconds, 0.001)

    def after(self) -> None:
        """Press Ctrl-C, if the main thread has waited long enough."""
        if not self.is_off and len(self.waits) >= self.until and threading.current_thread() is threading.main_thread():
            self.is_pressed = True
            raise KeyboardInterrupt


@contextmanager
def watched(until: int = 3) -> Iterator[Spy]:
    """Watch the waits of the main thread; the block ends by Ctrl-C after `until` of them."""
    spy = Spy()
    spy.until = until
    condition_wait, join, process_wait = threading.Condition.wait, threading.Thread.join, subprocess.Popen.wait
    start = threading.Thread.start

    class SimpleQueue(queue.SimpleQueue):  # type: ignore[type-arg]
        def get(self, block: bool = True, timeout: float | None = None) -> Any:
            if not block:
                return super().get(False)
            try:
                return super().get(True, spy.note(timeout))
            finally:
                spy.after()

    def wait(condition: threading.Condition, timeout: float | None = None) -> bool:
        try:
            return condition_wait(condition, spy.note(timeout))
        finally:
            spy.after()

    def joined(thread: threading.Thread, timeout: float | None = None) -> None:
        join(thread, spy.note(timeout))
        spy.after()

    def ended(process: Any, timeout: float | None = None) -> int:
        try:
            return process_wait(process, spy.note(timeout))
        finally:
            spy.after()

    def started(thread: threading.Thread) -> None:
        if threading.current_thread() is not threading.main_thread():
            start(thread)
            return
        before, spy.is_off = spy.is_off, True  # it waits until the thread has begun, which is at once
        try:
            start(thread)
        finally:
            spy.is_off = before

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(queue, "SimpleQueue", SimpleQueue)
        patch.setattr(threading.Condition, "wait", wait)
        patch.setattr(threading.Thread, "start", started)
        patch.setattr(threading.Thread, "join", joined)
        patch.setattr(subprocess.Popen, "wait", ended)
        with suppress(KeyboardInterrupt):
            yield spy
        if not spy.is_pressed:
            raise AssertionError(f"it ended by itself after {len(spy.waits)} waits")
