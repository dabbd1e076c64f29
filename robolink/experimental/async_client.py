"""Clients of an AsyncNode."""

from __future__ import annotations

import asyncio
import threading
from typing import Any

from robolink.client import BaseClient
from robolink.experimental.loop_entity import leave
from robolink.experimental.loops import call_at
from robolink.message import Message
from robolink.task import Future

GRACE = 1.0
"""Longest time, in seconds, from a call until its node must be running, since nobody would take the answer."""


class AsyncClient(BaseClient):
    """Client of a service whose calls are awaited; made by `AsyncNode.create_client`."""

    _waiting: dict[Future[Any], asyncio.Future[Any]]

    async def call(self, request: Message) -> Any:
        """Call the service and return its response; end the wait by `asyncio.timeout`, or by a cancellation.

        As in rclpy, it waits for ever if nobody serves, or if the server goes away; a warning says so.

        Args:
            request: Request of the service's type.

        Raises:
            TypeError: if the request is of another type.
            InvalidHandle: (a RuntimeError) if the client has been destroyed.
            RuntimeError: if its node does not run a second after the call: nobody would take the answer.
            CancelledError: of asyncio, if the client is destroyed meanwhile.
        """
        loop = asyncio.get_running_loop()
        future = self._ask(request, fails=False)
        waiting: asyncio.Future[Any] = loop.create_future()
        self._pending[future] = waiting
        thread = threading.get_ident()

        def complete() -> None:
            if not waiting.done():
                waiting.set_result(future.result())

        def on_answer() -> None:
            complete() if threading.get_ident() == thread and not loop.is_closed() else call_at(loop, complete)

        future.when_done(on_answer)
        check = None if self.executor is not None else loop.call_later(GRACE, self._check_is_run, waiting)
        try:
            return await waiting
        finally:
            if check is not None:
                check.cancel()
            self._pending.pop(future, None)
            self.remove_pending_request(future)

    def _check_is_run(self, waiting: asyncio.Future[Any]) -> None:
        if self.executor is None and not waiting.done():
            waiting.set_exception(
                RuntimeError(
                    f"service {self.service_name}: nobody takes the answer, since the node does not run: call within"
                    " `async with node:`, or while `node.run()` is awaited"
                )
            )

    @property
    def _pending(self) -> dict[Future[Any], asyncio.Future[Any]]:
        """The calls under way, and what awaits them."""
        if "_waiting" not in vars(self):
            self._waiting = {}
        return self._waiting

    async def wait_for_service(self, *, check_interval: float = 0.1) -> None:
        """Wait until somebody serves this name with this type; end the wait by `asyncio.timeout`.

        Args:
            check_interval: Time between two looks, in seconds.

        Raises:
            InvalidHandle: (a RuntimeError) if the client has been destroyed.
        """
        while not self.service_is_ready():
            await asyncio.sleep(check_interval)

    def destroy(self) -> None:
        """End the client, and cancel its calls. Safe to call twice."""
        if self._destroyed:
            return
        super().destroy()
        for waiting in list(self._pending.values()):
            call_at(waiting.get_loop(), waiting.cancel)
        leave(self, "clients")
