"""Entities of an action server: services that answer later, and executions that are due."""

from __future__ import annotations

import inspect
from collections import deque
from collections.abc import Callable, Coroutine
from typing import TYPE_CHECKING, Any

from robolink.message import Message
from robolink.running.entity import NOTHING, Entity
from robolink.running.ready_queue import TASK
from robolink.service import RequestHeader, Service

if TYPE_CHECKING:
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
