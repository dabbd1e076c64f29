"""Lanes of a mirror: what one side's transport brings waits in a queue, and one thread carries it to the other side."""

from __future__ import annotations

import functools
import queue
import threading
from collections.abc import Callable
from typing import Any, Protocol

import msgspec

from robolink.exceptions import OverwrittenError, TransportClosedError, TransportError
from robolink.logging import get_logger
from robolink.transport.base import Transport

MOST_WAITING = 20_000
"""Most samples that wait in a lane; beyond it the oldest are dropped, as a depth would do."""

MOST_BYTES_WAITING = 128 << 20
"""Most bytes that wait in a lane, estimated by the size of the sample whose turn it is."""

FEW = 32
"""Number of waiting samples below which no size is asked for."""


class Target(Protocol):
    """Receiver of what a lane carries."""

    droppable: bool
    """True if it is data of a topic, which may be dropped in a flood; a call or an action of the mirror is not."""

    def deliver(self, content: Any) -> None:
        """Take one item, on the lane's thread."""


class Action:
    """Target of the mirror's own actions, which take their turn behind the samples that came before them."""

    droppable = False

    def deliver(self, content: Callable[[], object]) -> None:
        """Run the action."""
        content()


_ACTION = Action()


class Lane:
    """Queue from one transport to the other.

    Sinks are C from end to end, as in `robolink.running.inbox`: a transport's thread makes a struct that queues itself.

    Args:
        source: Transport whose sinks put items here.
    """

    def __init__(self, source: Transport) -> None:
        self.dropped = 0
        """Number of samples that were dropped, since the other side was too slow for them."""
        self.failed = 0
        """Number of items that could not be carried: too large, overwritten by their sender, or refused."""
        self._size = source.size
        self._queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._arrival = msgspec.defstruct(
            "Arrival", ["target", "content"], namespace={"__post_init__": self._queue.put}, gc=False
        )
        self._thread: threading.Thread | None = None
        self._is_over = False

    def sink(self, target: Target) -> functools.partial[Any]:
        """Return the sink that a transport is given: it queues its argument for `target`, without Python code."""
        return functools.partial(self._arrival, target)

    def post(self, action: Callable[[], object]) -> None:
        """Run `action` on the lane's thread, behind what waits there already."""
        self._arrival(_ACTION, action)

    def start(self, name: str) -> None:
        """Carry what comes on a thread of this name, until `stop`."""
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """End the thread, if there is one; but for a few samples it drops those that wait."""
        self._is_over = True
        if self._thread is not None:
            self._queue.put(None)
            self._thread.join()
            self._thread = None

    def step(self) -> bool:
        """Carry what waits now, where no thread does; return whether there was anything."""
        waiting = self._queue.qsize()
        for _ in range(waiting):
            self._carry(self._queue.get_nowait())
        return waiting > 0

    def _run(self) -> None:
        get, carry = self._queue.get, self._carry
        while (arrival := get()) is not None:
            carry(arrival)

    def _carry(self, arrival: Any) -> None:
        target, content = arrival.target, arrival.content
        try:
            if target.droppable and (behind := self._queue.qsize()) > FEW and self._is_flooded(behind, content):
                self._drop()
                return
            target.deliver(content)
        except TransportClosedError:  # one of the sides ends just now
            pass
        except OverwrittenError:
            self.failed += 1
        except TransportError as error:
            self._fail(str(error))
        except Exception as error:  # noqa: BLE001 - what one sample does must not end the others
            self._fail(f"{type(error).__name__}: {error}")

    def _is_flooded(self, behind: int, content: Any) -> bool:
        return self._is_over or behind > MOST_WAITING or behind * self._size(content) > MOST_BYTES_WAITING

    def _drop(self) -> None:
        self.dropped += 1
        if self.dropped == 1 and not self._is_over:
            get_logger("robolink.dds").warning(
                "messages come faster than the other side takes them: the oldest are dropped (said once)"
            )

    def _fail(self, reason: str) -> None:
        self.failed += 1
        if self.failed == 1:
            get_logger("robolink.dds").warning(f"something cannot be carried over: {reason} (said once)")
