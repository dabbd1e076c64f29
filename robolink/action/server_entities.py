"""Parts of an action server: services that answer later, executions that are due, and the results of goals."""

from __future__ import annotations

import inspect
import threading
from collections import deque
from collections.abc import Callable, Coroutine
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import CallbackGroup
from robolink.message import Message
from robolink.running.entity import NOTHING, Entity
from robolink.running.ready_queue import TASK
from robolink.service import RequestHeader, Service
from robolink.timer import Timer

if TYPE_CHECKING:
    from robolink.node import BaseNode
    from robolink.running.ports import Loop


async def run_to_its_end(callback: Callable[..., Any], *args: Any) -> Any:
    """Call a function, or a coroutine function, to its end."""
    result = callback(*args)
    return await result if inspect.iscoroutine(result) else result


class LateService(Service):
    """A service that answers later: its callback is ``async callback(request, header)``.

    It answers by `send_response` with that header, whenever it will; if it raises, the caller learns that no answer
    comes.
    """

    def respond(self, request: Message, header: RequestHeader) -> Any:
        """Start the callback of a request."""
        return self._see_to(self.callback(request, header), header)

    async def _see_to(self, work: Coroutine[Any, Any, None], header: RequestHeader) -> None:
        try:
            await work
        except BaseException:
            header.query.close()
            raise


class Executions(Entity):
    """Queue of the goals to execute. It is in no callback group, so that an action can be cancelled meanwhile."""

    serves = True

    def __init__(self, execute: Callable[..., Coroutine[Any, Any, None]]) -> None:
        super().__init__()
        self._execute = execute
        self._due: deque[tuple[Any, ...]] = deque()

    def add(self, *args: Any) -> None:
        """Schedule `execute(*args)` on the executor, once there is one. From any thread."""
        self._due.append(args)
        queue = self._queue_
        if queue is not None:
            queue.post(self)

    def attach(self, executor: Loop, has_turn: bool = False) -> None:
        """Attach to an executor; what is due is ready there."""
        super().attach(executor, has_turn)
        self.place = TASK, 0, 0, 0  # as in rclpy: who waits for the answer has seen what the execution sent at once
        executor._queue_.ready.extend([self] * (len(self._due) - has_turn))

    def take(self) -> Any:
        """Return the oldest execution that is due."""
        return self._due.popleft() if self._due else NOTHING

    def execute(self, taken: tuple[Any, ...]) -> Any:
        """Start an execution."""
        return self._execute(*taken)


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
        node: BaseNode,
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
