"""Ready queue in order of arrival, without rounds: that of an EventsExecutor.

Each message, request and tick of a timer has a turn of its own, behind all that became ready before it. So a backlog of
one topic keeps everybody else waiting, as in rclpy's EventsExecutor.
"""

from __future__ import annotations

from collections.abc import Callable

from robolink.running.ready_queue import EntityT, ReadyQueue


class ArrivalQueue(ReadyQueue[EntityT]):
    """Ready entities in the order in which they became ready, and timers by deadline."""

    in_rounds = False

    def begin(self, accepts: Callable[[EntityT], bool] | None = None) -> bool:
        """Append all that is ready to the turns, in the order of arrival. False if there is nothing to do."""
        ready = self.ready
        for _ in range(len(ready)):  # one by one, since other threads may append
            self.turns.append(ready.popleft())
        return bool(self.turns)

    def unblock(self) -> None:
        """Let what was blocked try again, before all others, in the order in which it came."""
        blocked = [*self.blocked]
        self.blocked.clear()
        self.turns.extendleft(reversed(blocked))
