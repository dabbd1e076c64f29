"""Two networks in memory, with and without a mirror between them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.support.mirrored import Half, Mirrored


@pytest.fixture
def scene() -> Iterator[Mirrored]:
    made = Mirrored()
    yield made
    made.close()


@pytest.fixture
def joined(scene: Mirrored) -> Mirrored:
    scene.join()
    return scene


@pytest.fixture(params=["there", "back"])
def pair(joined: Mirrored, request: pytest.FixtureRequest) -> tuple[Mirrored, Half, Half]:
    """The scene, and its two halves in either order."""
    halves = joined.halves if request.param == "there" else joined.halves[::-1]
    return joined, *halves
