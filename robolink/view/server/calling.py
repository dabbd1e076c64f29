"""Service calls of clients, in CDR and in JSON, with the answer or one line of why there is none."""

from __future__ import annotations

import asyncio
from typing import Any

import msgspec

from robolink.exceptions import RobolinkError
from robolink.message import Service, decode, encode, from_builtins, to_builtins
from robolink.system.terminal import shown
from robolink.view.protocol import answers
from robolink.view.protocol.requests import ProtocolError, ServiceCall
from robolink.view.server.outbox import Listener
from robolink.view.server.publishing import json_of
from robolink.view.sources.live import LiveSource

ANSWER_WITHIN = 300.0
"""Longest wait for an answer, in seconds."""

RESULT_WITHIN = 24 * 3600.0
"""Longest wait for the result of an action, which comes when its goal has ended."""

MOST_CALLS = 100
"""Calls of one client that may be under way."""


class Calling:
    """Calls of one client.

    Args:
        client: Client that is answered.
        system: System whose services it calls.
    """

    def __init__(self, client: Listener, system: LiveSource) -> None:
        self._client, self._system = client, system
        self._tasks: set[asyncio.Task[None]] = set()

    def begin(self, call: ServiceCall) -> None:
        """Call a service, and answer the client later."""
        if len(self._tasks) >= MOST_CALLS:
            self._refuse(call, f"more than {MOST_CALLS} calls are under way")
            return
        task = asyncio.get_running_loop().create_task(self._call(call))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _call(self, call: ServiceCall) -> None:
        try:
            body = await self._answer(call)
        except RobolinkError as error:
            self._refuse(call, str(error))
        except Exception as error:  # noqa: BLE001 - no call may end the server
            self._refuse(call, f"the call failed: {error!r}")
        else:
            self._client.send(answers.service_response(call.service_id, call.call_id, call.encoding, body))

    async def _answer(self, call: ServiceCall) -> bytes:
        entry = self._system.services.get(call.service_id)
        cls = self._system.service_class(call.service_id)
        if entry is None or cls is None:
            raise ProtocolError(f"there is no service {call.service_id}")
        request = _request(cls, call, entry.name)
        is_result = entry.name.endswith("/_action/get_result")
        within = RESULT_WITHIN if is_result else ANSWER_WITHIN
        response = await self._system.caller.call(entry.name, cls, request, within)
        if call.encoding == "cdr":
            return response
        return msgspec.json.encode(to_builtins(decode(cls.Response, response)))

    def _refuse(self, call: ServiceCall, why: str) -> None:
        text = shown(why, 1000)
        self._client.say(answers.service_call_failure(call.service_id, call.call_id, text))

    def close(self) -> None:
        """Abandon all calls."""
        for each in list(self._tasks):
            each.cancel()


def _request(cls: type[Service], call: ServiceCall, name: str) -> bytes:
    """Return the serialized request; raises RobolinkError for what is not a request of the type."""
    made: Any = cls.Request
    try:
        if call.encoding == "json":
            return encode(from_builtins(made, json_of(call.payload, name) if call.payload else {}))
        decode(made, call.payload)
    except RobolinkError as error:
        raise ProtocolError(f"service {name}: not called: {error}") from None
    return call.payload
