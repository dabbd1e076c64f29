"""A router, a peer of bare Zenoh calls and a node of robolink's, all of which meet."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.support.interop import Robot, robot
from tests.support.ros2_peer import (
    Peer,
    router,
)


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    with router() as listening:
        yield listening


@pytest.fixture
def peer(port: int, domain: int) -> Iterator[Peer]:
    made = Peer(port, domain)
    yield made
    made.close()


@pytest.fixture
def node(port: int, domain: int) -> Iterator[Robot]:
    with robot(port, domain) as made:
        yield made
