"""A router that is killed under load: all is found again, and whatever does not come is counted."""

from __future__ import annotations

import pytest

from tests.support import stalls
from tests.support.rounds import scenes

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are three hosts"),
]


def test_nothing_is_lost_in_silence_when_a_router_is_killed() -> None:
    """`python -m tests.support.rounds` plays this and the other faults often, and says how soon all is well again."""
    found = scenes(0.3, under_load=0.3)["router"]()
    assert (found.silent, found.ended) == (0, 0)
    assert found.published > 0
    assert found.answered > 0
