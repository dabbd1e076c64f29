"""Mailbox of a receiver to which an inbox delivers, on the thread that sweeps it: where a network has no threads.

So it is, too, where what arrives is prepared before it waits, or where nothing is dropped. KeepLast (`keep_last.py`) is
the other one, with the same face for its Receiver.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.running.ready_queue import NOTHING, ReadyQueue
from robolink.transport.history import Mailbox

if TYPE_CHECKING:
    from robolink.running.entity import Receiver


class Delivered(Mailbox):
    """Samples of a receiver until its turn comes.

    Args:
        depth: Largest number of items that wait; ALL is any number.
        receiver: Receiver whose items they are.
        prepare: Function of what arrives, which returns what is stored in its place, or None for nothing.
    """

    __slots__ = ()

    def __init__(self, depth: int, receiver: Receiver, prepare: Callable[[Any], Any] | None = None) -> None:
        super().__init__(depth, receiver.become_ready, receiver.overflowed, prepare)

    def begin(self, queue: ReadyQueue[Any], receiver: Receiver, *, has_turn: bool, has_turns: bool) -> None:
        """Announce what waits to an executor, as `KeepLast.begin` does."""
        self.listed = has_turn and not has_turns
        for _ in range(len(self) - has_turn):
            if not self.listed:
                receiver.become_ready()

    def end(self, queue: ReadyQueue[Any]) -> None:
        """Do nothing: what arrives goes to another inbox."""

    def take_next(self, receiver: Receiver) -> Any:
        """Return the oldest of what waits, or NOTHING; what waits behind it has its turn in the next round."""
        waiting = self.waiting
        if not waiting:
            self.listed = False
            return NOTHING
        taken = waiting.popleft()
        if not waiting:
            self.listed = False
        elif self.listed and receiver._queue_ is not None:
            receiver._queue_.ready.append(receiver)
        return taken
