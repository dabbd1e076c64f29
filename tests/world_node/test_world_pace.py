"""Pacing of a simulated world and its real-time factor: pure arithmetic."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.world_node.runner import BACKLOG, Pace, Rate, RateMeter, judged, listed

MS = 1_000_000
SECOND = 1_000_000_000


def all_due(pace: Pace, now: int) -> tuple[int, float]:
    """Ask until nothing is due any more, as the node does between the others' turns."""
    steps, given_up = pace.due(now)
    while pace.behind:
        more, lost = pace.due(now)
        assert 0 < more <= pace.turn
        steps, given_up = steps + more, given_up + lost
    return steps, given_up


def test_the_pace_does_not_drift_and_catches_up() -> None:
    pace = Pace(start=7, dt=10 * MS, rtf=1.0)
    assert [all_due(pace, 7 + now * MS)[0] for now in (0, 9, 10, 25, 100, 590)] == [0, 0, 1, 1, 8, 49]
    steps, given_up = all_due(pace, 7 + 3590 * MS)
    assert steps == 50
    assert given_up == pytest.approx(2.5)
    assert all_due(pace, 7 + 3600 * MS) == (1, 0.0)


def test_a_turn_is_short_however_much_is_due() -> None:
    pace = Pace(start=0, dt=10 * MS, rtf=1000.0)
    assert pace.due(SECOND // 10) == (1, 0.0)
    assert pace.behind
    assert all_due(pace, SECOND // 10)[0] == 10_000 - 1


def test_short_steps_are_made_in_bunches() -> None:
    assert (Pace(0, MS, 1.0).turn, Pace(0, MS, 1.0).period) == (10, 0.01)
    assert Pace(0, 10 * MS, 0.5).period == pytest.approx(0.02)
    assert Pace(0, 10 * MS, 1000.0).period == pytest.approx(0.001)


def test_as_fast_as_it_goes_knows_no_clock() -> None:
    pace = Pace(0, MS, 0.0)
    assert [pace.due(now) for now in (0, 0, 123)] == [(10, 0.0)] * 3
    assert not pace.behind


def test_of_a_number_of_steps_all_are_made_and_no_more() -> None:
    pace = Pace(0, MS, 0.0, left=25)
    assert [pace.due(0)[0] for _ in range(4)] == [10, 10, 5, 0]
    assert pace.left == 0


@given(
    st.sampled_from([MS, 3 * MS, 10 * MS, 100 * MS]),
    st.floats(0.001, 100.0),
    st.lists(st.integers(0, SECOND), max_size=10),
)
def test_what_is_made_and_given_up_is_what_time_asks_for(dt: int, rtf: float, waits: list[int]) -> None:
    pace, now, made = Pace(0, dt, rtf), 0, 0.0
    for wait in waits:
        now += wait
        steps, given_up = all_due(pace, now)
        assert steps * dt <= max(BACKLOG * rtf * SECOND, pace.turn * dt) + 1
        made += steps * dt + given_up * SECOND
    # each time that something is given up the start is rounded to a nanosecond of real time
    assert made == pytest.approx(now * rtf, abs=dt + (len(waits) + 1) * max(rtf, 1.0) + 1e-6 * now * rtf)


def test_the_factor_is_measured_over_the_last_seconds() -> None:
    meter = RateMeter()
    simulated = [0, 1, 2, 3, 3, 3, 3]
    found = [meter.mark(now * SECOND, each * SECOND) for now, each in enumerate(simulated)]
    assert found == [None, 1.0, 1.0, 1.0, pytest.approx(2 / 3), pytest.approx(1 / 3), 0.0]
    meter.restart()
    assert meter.mark(9 * SECOND, 9 * SECOND) is None


@pytest.mark.parametrize(
    ("rate", "level", "words"),
    [
        (Rate(1.0, 0.99), b"\x00", "0.99 times real time"),
        (Rate(1.0, 0.5), b"\x01", "falls behind: 0.5 times real time, 1 is asked for"),
        (Rate(0.0, 250.0), b"\x00", "250 times real time"),
        (Rate(1.0, None), b"\x00", "just started"),
        (Rate(1.0, 0.0, running=False), b"\x00", "paused"),
    ],
)
def test_a_rate_is_judged(rate: Rate, level: bytes, words: str) -> None:
    assert judged(rate) == (level, words)


def test_robots_are_listed_at_any_number() -> None:
    assert listed([]) == "no robot"
    assert listed(["a", "b"]) == "a, b"
    assert listed([f"r{i}" for i in range(100)]) == "100 robots: r0, r1, r2, r3, r4 ... r99"
