"""Fixtures for tests of peers of Humble: the peer, and contexts that speak its dialect."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from robolink import Context
from tests.support.humble_peer import Peer
from tests.support.transports import Network


@pytest.fixture
def peer(net: Network) -> Peer:
    return Peer(net.session())


@pytest.fixture
def make_context(net: Network, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Context]]:
    """Make contexts of one network, which talk as Humble does where that is asked for."""
    made: list[Context] = []

    def make(distro: str = "") -> Context:
        monkeypatch.setenv("ROBOLINK_ROS_DISTRO", distro)
        context = Context(transport=net.session())
        context.init([], domain_id=0)
        made.append(context)
        return context

    yield make
    for context in made:
        context.try_shutdown()
