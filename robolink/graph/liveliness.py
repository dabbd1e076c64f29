"""Liveliness of publishers between the ends of a topic: who asserts it, and what a subscription sees of it."""

from __future__ import annotations

import itertools
from collections.abc import Callable

from robolink.exceptions import RobolinkError, WireError
from robolink.graph.endpoint import Endpoint
from robolink.qos import LivelinessPolicy, QoSProfile, resolved
from robolink.running.expectations import Liveliness
from robolink.transport.base import Handle
from robolink.wire import EndpointToken, assertion_pattern, format_assertion, parse_assertion

_LONGEST = 2**62
"""Shortest span, in nanoseconds, that stands for ever: an infinite one is a little longer."""


def is_manual(qos: QoSProfile) -> bool:
    """Return whether a publisher of this profile asserts its liveliness itself."""
    return resolved(qos).liveliness is LivelinessPolicy.MANUAL_BY_TOPIC


def deadline_ns(qos: QoSProfile) -> int | None:
    """Return a profile's deadline in nanoseconds; None if there is none."""
    return _finite(resolved(qos).deadline.nanoseconds)


def lease_ns(qos: QoSProfile) -> int | None:
    """Return a profile's lease duration in nanoseconds; None if there is none."""
    return _finite(resolved(qos).liveliness_lease_duration.nanoseconds)


def _finite(nanoseconds: int) -> int | None:
    return nanoseconds if nanoseconds < _LONGEST else None


def assertions(endpoint: Endpoint) -> Callable[[], None]:
    """Return a function that tells the subscriptions of a publisher's topic that it is alive."""
    number = itertools.count(1).__next__

    def tell() -> None:
        text = format_assertion(endpoint.domain_id, endpoint.name, endpoint.gid, number())
        endpoint.transport.announce(text).close()

    return tell


def watch_publishers(endpoint: Endpoint, liveliness: Liveliness, steady: Callable[[], int]) -> Handle:
    """Note which publishers of a subscription's topic come and go, and which assert that they are alive.

    Args:
        endpoint: Endpoint of the subscription, before it is announced.
        liveliness: What is told of them; its messages are noted by the subscription.
        steady: Clock, in nanoseconds.

    Returns:
        Handle that ends it.
    """

    def on_match(gid: bytes, token: EndpointToken, came: bool) -> None:
        if came:
            liveliness.match(gid, steady(), automatic=not is_manual(token.qos))
        else:
            liveliness.unmatch(gid)

    def on_assertion(text: str, alive: bool) -> bool:
        try:
            gid = parse_assertion(text)
        except (WireError, RobolinkError):  # somebody's nonsense
            return False
        if alive:
            liveliness.note(gid, steady())
        return False

    endpoint.on_match = on_match
    return endpoint.transport.watch(assertion_pattern(endpoint.domain_id, endpoint.name), on_assertion)
