"""Warning of a deadlock: a callback spins without a timeout, and something ready waits for that very callback."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from robolink.running.entity import Entity
from robolink.running.execution import logger_of
from robolink.running.ready_queue import ReadyQueue

if TYPE_CHECKING:
    from robolink.running.ports import SpunNode

_HELD = (
    "a callback spins and waits without a timeout_sec: {} is ready, but cannot run before that callback has returned, "
    "since their callback group runs one at a time. Return instead of spinning, give the spin a timeout_sec, or give "
    "one of the two a callback group of its own"
)


class DeadlockWarning:
    """Logs once what is ready in a queue and held back by the callback that spins in the calling thread."""

    def __init__(self, queue: ReadyQueue[Entity], nodes: Iterable[SpunNode]) -> None:
        self._queue, self._nodes = queue, nodes
        self._has_warned = False

    def watching(self, stop: Callable[[], bool] | None, is_held_here: Callable[[Entity], bool]) -> Callable[[], bool]:
        """Return `stop`, or never, for a callback that spins without an end: it warns as well.

        Who spins until a future is done is told only of a service that is asked from here: that future may hang on it.
        """

        def look() -> bool:
            with self._queue.lock:
                kept = () if self._has_warned else (*self._queue.blocked, *self._queue.ready)
                waiting = [each for each in kept if is_held_here(each)]
            held = next((each for each in waiting if stop is None or self._is_asked_here(each.origin)), None)
            if held is not None:
                self._has_warned = True
                logger_of(held).warning(_HELD.format(_named(held.origin)))
            return False

        return look if stop is None else lambda: stop() or look()

    def _is_asked_here(self, entity: Entity) -> bool:
        """Return whether it is a service whose answer a client of one of the nodes waits for."""
        name = getattr(entity, "service_name", None)
        return any(each.service_name == name and each.is_waiting for node in self._nodes for each in node.clients)


def _named(entity: Entity) -> str:
    kind = type(entity).__name__.lower()
    name = getattr(entity, "topic_name", None) or getattr(entity, "service_name", None)
    return f"the {kind} of {name}" if name else f"a {kind}"
