"""What an action server has beside publishers: services that answer when it suits, and executions that are due."""

from __future__ import annotations

import inspect
from collections import deque
from collections.abc import Callable, Coroutine
from typing import TYPE_CHECKING, Any

from robolink.entity import NOTHING, Entity
from robolink.message import Message
from robolink.service import RequestHeader, Service

if TYPE_CHECKING:
    from robolink.executors import Executor


async def run_to_its_end(callback: Callable[..., Any], *args: Any) -> Any:
    """Call a function, or a coroutine function, to its end."""
    result = callback(*args)
    return await result if inspect.iscoroutine(result) else result


class LateService(Service):
    """A service whose callback is ``async callback(request, header)``.

    It answers by `send_response` with that header, whenever it will; when it raises, the caller learns that no answer
    comes.
    """

    def respond(self, request: Message, header: RequestHeader) -> Any:
        """Have the callback see to the request."""
        return self._see_to(self.callback(request, header), header)

    async def _see_to(self, work: Coroutine[Any, Any, None], header: RequestHeader) -> None:
        try:
            await work
        except BaseException:
            header.query.close()
            raise


class Executions(Entity):
    """Goals whose execution is due. It is in no callback group, so that an action can be cancelled meanwhile."""

    serves = True

    def __init__(self, execute: Callable[..., Coroutine[Any, Any, None]]) -> None:
        super().__init__()
        self._execute = execute
        self._due: deque[tuple[Any, ...]] = deque()

    def add(self, *args: Any) -> None:
        """Have `execute(*args)` run by the executor, once there is one. From any thread."""
        self._due.append(args)
        executor = self.executor
        if executor is not None:
            executor.post(self)

    def attach(self, executor: Executor, queued: int = 0) -> None:
        """Belong to this executor; what is due is ready there."""
        super().attach(executor, queued)
        executor.ready.extend([self] * (len(self._due) - queued))

    def take(self) -> Any:
        """Give what has been due longest."""
        return self._due.popleft() if self._due else NOTHING

    def execute(self, taken: tuple[Any, ...]) -> Any:
        """Begin it."""
        return self._execute(*taken)
