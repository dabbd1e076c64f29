"""Helpers for tests of both sides: publish until the node hears it, call and answer, and wait for a token."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

from robolink.client import Client
from robolink.exceptions import ServiceError
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.service import Service
from tests.support.interop import PATIENCE, Robot, until
from tests.support.ros2_peer import (
    Peer,
    PeerClient,
    PeerQuery,
    Received,
    packed_ints,
    unpacked_ints,
)


def until_heard(node: Robot, put: Callable[[], object], got: list[Any]) -> None:
    """Have the peer publish until the node hears it."""

    def arrived() -> bool:
        put()
        return bool(got)

    node.spin_until(arrived)


def add(query: PeerQuery) -> None:
    query.reply(packed_ints(sum(unpacked_ints(query.payload))))


def sum_of(client: Client, a: int, b: int) -> int:
    """Call until it is answered: the server's token may come before it can be reached."""
    answers: list[int] = []

    def answered() -> bool:
        with contextlib.suppress(ServiceError):
            answers.append(client.try_call(AddTwoInts.Request(a=a, b=b), timeout_sec=PATIENCE).sum)
        return bool(answers)

    until(answered)
    return answers[0]


def replies_to(client: PeerClient, node: Robot, payload: bytes) -> list[Received]:
    """Call until it is answered, while robolink spins."""
    replies: list[Received] = []

    def answered() -> bool:
        replies.extend(node.while_spinning(lambda: client.call(payload)))
        return bool(replies)

    until(answered)
    return replies


def serve_sums(node: Robot) -> tuple[Service, list[int]]:
    """The service /add, and the first numbers of what it is asked."""

    def serve(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        asked.append(request.a)
        response.sum = request.a + request.b
        return response

    asked: list[int] = []
    return node.create_service(AddTwoInts, "add", serve), asked


def announced(peer: Peer, *parts: str) -> str:
    """The token of robolink's that has these parts, as soon as the peer's liveliness get shows it."""
    found: list[str] = []

    def shown() -> bool:
        found[:] = [token for token in peer.tokens() if all(part in token for part in parts)]
        return bool(found)

    until(shown, lambda: f"no {parts} in {peer.tokens()}")
    return found[0]
