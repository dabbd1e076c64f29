"""Results of goals, and the requests that wait for them: each is answered once its goal has ended."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import CallbackGroup
from robolink.service import RequestHeader
from robolink.timer import Timer

if TYPE_CHECKING:
    from robolink.node import Node


class Results:
    """The results of an action server's goals, by the goals' ids, as far as there are any yet.

    `answer(response, header)` is called for each request, `forget(goal_id)` for each goal whose result has been kept
    for `timeout` seconds of the node's clock; below 0 it is kept for ever.
    """

    def __init__(
        self,
        answer: Callable[[Any, RequestHeader], None],
        forget: Callable[[bytes], None],
        timeout: float,
        group: CallbackGroup,
        node: Node,
    ) -> None:
        self._answer, self._forget = answer, forget
        self._timeout, self._clock = int(timeout * 1e9), node.get_clock()
        self._lock = threading.RLock()
        self._askers: dict[bytes, list[RequestHeader]] = {}
        self._responses: dict[bytes, Any] = {}
        self._expiring: deque[tuple[int, bytes]] = deque()
        self.timer = Timer(
            self._expire, group, max(0, self._timeout), self._clock, context=node.context, autostart=False
        )
        """Timer that expires results; the executor runs it."""

    def expect(self, goal_id: bytes) -> None:
        """Register a goal that will have a result."""
        with self._lock:
            self._askers[goal_id] = []

    def ask(self, goal_id: bytes, header: RequestHeader) -> bool:
        """Answer a request now or later; False for a goal that is not known."""
        with self._lock:
            response = self._responses.get(goal_id)
            if response is None and goal_id not in self._askers:
                return False
            if response is None:
                self._askers[goal_id].append(header)
                return True
        self._answer(response, header)
        return True

    def set(self, goal_id: bytes, response: Any) -> None:
        """Answer all requests for a goal. A goal that was forgotten meanwhile, or has a result, is left as it is."""
        with self._lock:
            askers = self._askers.pop(goal_id, None)
            if askers is None:
                return
            self._responses[goal_id] = response
            if self._timeout >= 0:
                self._expiring.append((self._clock.now_ns() + self._timeout, goal_id))
                if self.timer.is_canceled():
                    self._wake_in(self._timeout)
        for header in askers:
            self._answer(response, header)

    def _expire(self) -> None:
        now, over = self._clock.now_ns(), []
        with self._lock:
            while self._expiring and self._expiring[0][0] <= now:
                over.append(self._expiring.popleft()[1])
                del self._responses[over[-1]]
            if self._expiring:
                self._wake_in(self._expiring[0][0] - now)
            elif not self.timer.is_canceled():
                self.timer.cancel()
        for goal_id in over:
            self._forget(goal_id)

    def _wake_in(self, nanoseconds: int) -> None:
        self.timer.timer_period_ns = nanoseconds
        self.timer.reset()

    def close(self) -> None:
        """Remove all results; whoever still waits learns that no answer comes."""
        with self._lock:
            self.timer.destroy()
            askers, self._askers = self._askers, {}
            self._responses.clear()
            self._expiring.clear()
            self._timeout = -1
        for header in (each for waiting in askers.values() for each in waiting):
            header.query.close()
