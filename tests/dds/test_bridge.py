"""Which of two bridges between the same networks stays: both decide the same, whatever they know of each other."""

from __future__ import annotations

import itertools

import pytest

from robolink.dds.bridge import one_that_stays, others_in
from robolink.wire import RUNNING, STARTING, BridgeToken, format_bridge


def bridge(session: str, state: str, network: str = "dds") -> BridgeToken:
    return BridgeToken(0, session, network, "here", state, session)


@pytest.mark.parametrize("states", [*itertools.product([STARTING, RUNNING], repeat=2)], ids="-".join)
def test_of_two_one_stays(states: tuple[str, str]) -> None:
    ends = [
        one_that_stays(own, states[at], [bridge(other, states[1 - at])]) is not None
        for at, (own, other) in enumerate((("a", "b"), ("b", "a")))
    ]
    assert sorted(ends) == [False, True]


def test_one_that_runs_stays_though_its_id_is_larger() -> None:
    assert one_that_stays("a", STARTING, [bridge("b", RUNNING)]) == bridge("b", RUNNING)
    assert one_that_stays("b", RUNNING, [bridge("a", STARTING)]) is None
    # While one changes its state, both of its tokens are there.
    assert one_that_stays("a", STARTING, [bridge("b", STARTING), bridge("b", RUNNING)]) is not None


def test_nobody_ends_where_there_is_no_other() -> None:
    assert one_that_stays("a", STARTING, []) is None


def test_other_bridges_are_those_to_dds() -> None:
    tokens = [*map(format_bridge, (bridge("a", RUNNING), bridge("b", RUNNING), bridge("c", RUNNING, "can")))]
    assert others_in([*tokens, "robolink_bridge/nonsense"], "a") == [bridge("b", RUNNING)]
