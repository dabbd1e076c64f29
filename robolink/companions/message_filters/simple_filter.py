"""Base class of message filters: callbacks, which get each output."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any


class SimpleFilter:
    """Base class of filters: calls the registered callbacks with each output."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., Any], tuple[Any, ...]]] = {}
        self._numbers = itertools.count()

    def registerCallback(self, cb: Callable[..., Any], *args: Any) -> int:  # noqa: N802 - upstream's name
        """Register a callback.

        Args:
            cb: Called with each output.
            args: Further arguments of each call, after the output.

        Returns:
            The number of this connection.
        """
        number = next(self._numbers)  # upstream's is how many there are, which one that was removed makes wrong
        self.callbacks[number] = (cb, args)
        return number

    def unregisterCallback(self, conn: int) -> None:  # noqa: N802
        """Remove the callback of the connection `conn`; nothing if there is none."""
        self.callbacks.pop(conn, None)

    def signalMessage(self, *msg: Any) -> None:  # noqa: N802
        """Call all callbacks with `msg`, the output: one message, or one of each filter."""
        for callback, args in list(self.callbacks.values()):
            callback(*msg, *args)
