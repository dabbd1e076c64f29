"""Two machines on `lan`: each sees the other's node at once, whichever of them is there first."""

from __future__ import annotations

import pytest

from tests.support import stalls
from tests.support.meetings import seconds_on_lan

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts"),
]


@pytest.mark.parametrize("first", [0, 1])
def test_who_comes_second_is_seen_before_another_second_of_scouting(first: int) -> None:
    """Some 0.4 s on a quiet machine (`python -m tests.support.meetings`); the best of three, as a busy one is late."""
    assert any(seconds_on_lan(first=first) < 1.0 for _ in range(3))
