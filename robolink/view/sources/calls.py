"""Calls of services with serialized requests, whose answers come as futures of the server's loop."""

from __future__ import annotations

import asyncio
import contextlib
from collections import OrderedDict
from typing import Any

from robolink.client import Client
from robolink.exceptions import RobolinkError, ServiceError, SessionReplacedError
from robolink.message import Service
from robolink.node import Node

MOST_CLIENTS = 32
"""Clients of services that are kept for the next call."""


class Caller:
    """Caller of any services, for one node.

    Args:
        node: Node whose clients call; nobody needs to spin it.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients: OrderedDict[tuple[str, type[Any]], Client] = OrderedDict()
        self._busy: dict[Client, int] = {}

    async def call(self, name: str, cls: type[Service], request: bytes, within: float) -> bytes:
        """Call a service, and return its serialized response.

        Args:
            name: Full name of the service.
            cls: Its class.
            request: Serialized request.
            within: Longest wait, in seconds.

        Raises:
            ServiceError: (a RuntimeError) if nobody answers in time, or nobody serves it.
        """
        loop = asyncio.get_running_loop()
        answer: asyncio.Future[bytes] = loop.create_future()

        def arrived(item: Any) -> None:
            """Note an answer, or the end of all, on a thread of the network."""
            with contextlib.suppress(RuntimeError):  # the loop has ended
                loop.call_soon_threadsafe(self._note, name, answer, item)

        client = self._client(name, cls)
        self._busy[client] = self._busy.get(client, 0) + 1
        handle = client._send_(request, arrived)
        try:
            return await asyncio.wait_for(answer, within)
        except asyncio.TimeoutError:
            raise ServiceError(f"service {name}: no answer within {within:g} s") from None
        finally:
            handle.close()
            self._busy[client] -= 1
            self._tidy()

    def _note(self, name: str, answer: asyncio.Future[bytes], item: Any) -> None:
        if answer.done():
            return
        if item is None:
            answer.set_exception(ServiceError(f"service {name}: nobody serves it, or the server went away"))
            return
        try:
            answer.set_result(self._node.context.transport.read(item).payload)
        except SessionReplacedError as error:
            answer.set_exception(ServiceError(f"service {name}: {error}"))
        except RobolinkError as error:
            answer.set_exception(ServiceError(f"service {name}: the answer cannot be read: {error}"))

    def _client(self, name: str, cls: type[Any]) -> Client:
        key = (name, cls)
        found = self._clients.get(key)
        if found is None:
            found = self._clients[key] = self._node.create_client(cls, name)
        self._clients.move_to_end(key)
        return found

    def _tidy(self) -> None:
        """End the clients that were not used for long."""
        for key, client in list(self._clients.items()):
            if len(self._clients) <= MOST_CLIENTS:
                return
            if not self._busy.get(client):
                del self._clients[key]
                self._busy.pop(client, None)
                self._node.destroy_client(client)
