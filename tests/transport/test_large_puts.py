"""A large payload is given to Zenoh, which copies it, only if somebody gets it from there."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.qos import QoSProfile
from robolink.transport import zenoh_handles
from tests.support.transports import CHATTER, PLAIN, Ear, Network, latched, until

LARGE = bytes(1_000_000)


class CountedPublisher:
    """Zenoh's publisher, with a count of its puts."""

    def __init__(self, publisher: Any) -> None:
        self._publisher, self.puts = publisher, 0

    def put(self, *arguments: Any, **options: Any) -> None:
        self.puts += 1
        self._publisher.put(*arguments, **options)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._publisher, name)


@pytest.fixture
def counted(zenoh_net: Network, monkeypatch: pytest.MonkeyPatch) -> tuple[Any, CountedPublisher]:
    """Return an outlet and its publisher; it asks before each put who listens."""
    monkeypatch.setattr(zenoh_handles, "MATCH_LASTS", 0.0)
    outlet: Any = zenoh_net.session().advertise(CHATTER, PLAIN)
    outlet._used = outlet._matcher = publisher = CountedPublisher(outlet._used)
    return outlet, publisher


def puts_of(outlet: Any, publisher: CountedPublisher) -> int:
    before = publisher.puts
    outlet.put(LARGE, b"")
    return publisher.puts - before


def test_a_large_payload_stays_in_a_session_that_alone_listens(
    zenoh_net: Network, counted: tuple[Any, CountedPublisher]
) -> None:
    outlet, publisher = counted
    own = Ear(zenoh_net.sessions[0])
    assert puts_of(outlet, publisher) == 0
    assert own.take(1) == [LARGE]


@pytest.mark.parametrize("qos", [PLAIN, latched(3)], ids=["volatile", "latched"])
def test_another_session_gets_it_as_soon_as_it_listens(
    zenoh_net: Network, counted: tuple[Any, CountedPublisher], qos: QoSProfile
) -> None:
    own, other = Ear(zenoh_net.sessions[0]), Ear(zenoh_net.session(), qos=qos)
    until(lambda: puts_of(*counted) == 1 and not other.arrived.empty())
    assert other.take(1) == [LARGE]
    assert own.take(1) == [LARGE]
    other.handle.close()
    until(lambda: puts_of(*counted) == 0)


def test_a_latched_subscription_of_the_same_session_gets_it(
    zenoh_net: Network, counted: tuple[Any, CountedPublisher]
) -> None:
    plain, kept = Ear(zenoh_net.sessions[0]), Ear(zenoh_net.sessions[0], qos=latched(3))
    until(lambda: puts_of(*counted) == 1 and not kept.arrived.empty())
    assert kept.take(1) == [LARGE]
    assert plain.take(1) == [LARGE]
