"""Message types that only the tests' own nodes know, and those nodes: for tests of type look-up."""

from __future__ import annotations

from typing import Annotated

from robolink import Context
from robolink.message import Action, AtMost, Message, Sequence, Service, boolean, float64, string
from robolink.qos import QoSProfile
from robolink.wire import EndpointKind, EndpointToken, format_token


class Wheel(Message):
    """One wheel."""

    radius: float64 = 0.1


class Cart(Message):
    """A cart that only the node which uses it knows."""

    wheels: Annotated[Sequence[Wheel], AtMost(4)]
    label: string


class Load(Service):
    """Load the cart."""

    class Request(Message):
        """What."""

        cart: Cart

    class Response(Message):
        """How it went."""

        ok: boolean


class Haul(Action):
    """Haul the cart."""

    class Goal(Message):
        """Where to."""

        cart: Cart

    class Result(Message):
        """What came."""

        arrived: boolean

    class Feedback(Message):
        """How far."""

        metres: float64


def seen(context: Context, name: str) -> EndpointToken:
    """What is announced under a name."""
    return context.graph.endpoints(*EndpointKind, name=name)[0]


def announced(context: Context, name: str, type_: str, hash_: str, node: str = "keeper") -> EndpointToken:
    """Announce a publisher that is not there."""
    token = EndpointToken(
        7, "a1", "1", "2", EndpointKind.PUBLISHER, "/", "/lab", node, name, type_, hash_, QoSProfile(depth=1)
    )
    context.transport.announce(format_token(token))
    return token
