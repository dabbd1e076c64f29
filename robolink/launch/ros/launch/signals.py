"""Signals as calls of an asyncio loop (`launch.utilities.AsyncSafeSignalManager`)."""

from __future__ import annotations

import signal
from collections.abc import Callable
from types import FrameType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import asyncio

_Handler = Callable[[int], Any]


class AsyncSafeSignalManager:
    """Handlers of signals that run on a loop, while the block of this context manager runs; then others are as before.

    Use it in the main thread, the only one that Python lets handle signals.

    Args:
        loop: The loop.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._handlers: dict[int, _Handler] = {}
        self._before: dict[int, Any] = {}
        self._is_entered = False

    def __enter__(self) -> AsyncSafeSignalManager:
        self._is_entered = True
        for number in self._handlers:
            self._install(number)
        return self

    def __exit__(self, *_: object) -> None:
        self._is_entered = False
        for number in list(self._before):
            self._restore(number)

    def handle(self, signum: int, handler: _Handler | None) -> _Handler | None:
        """Let `handler` be called with the number of each signal `signum`; None leaves that alone from here on.

        Returns:
            The handler before, None if there was none.
        """
        before = self._handlers.pop(signum, None)
        if handler is not None:
            self._handlers[signum] = handler
            if self._is_entered and signum not in self._before:
                self._install(signum)
        elif signum in self._before:
            self._restore(signum)
        return before

    def _install(self, number: int) -> None:
        self._before[number] = signal.signal(number, self._received)

    def _restore(self, number: int) -> None:
        before = self._before.pop(number)
        signal.signal(number, signal.SIG_DFL if before is None else before)

    def _received(self, number: int, _: FrameType | None) -> None:
        """Hand a signal to the loop, which this wakes, too."""
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._call, number)

    def _call(self, number: int) -> None:
        handler = self._handlers.get(number)
        if handler is not None:
            handler(number)
