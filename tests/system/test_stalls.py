"""A process that stands still, or whose cable is out, stalls nobody else; nor does who joins a latched topic late.

`python -m tests.support.stalls` plays the same scenes longer and says how late what was. Here only what is far beyond a
busy machine's pauses fails: with the threads that Zenoh once was given here, the others stood for 5 to 10 s.
"""

from __future__ import annotations

import sys

import pytest

if sys.platform == "win32":
    pytest.skip("there is no SIGSTOP", allow_module_level=True)

from tests.support.stalls import Harm, cut_the_cable, freeze, join_late, no_hosts, play

pytestmark = pytest.mark.processes

LONG = 2.0
"""Seconds: a pause that is no machine's fault."""


def check_unharmed(harms: dict[str, Harm]) -> None:
    for name, harm in harms.items():
        assert harm.sent > 0, name
        assert harm.lost <= harm.sent / 100, (name, harm)
        assert harm.late < LONG, (name, harm)
        assert harm.blocked < LONG, (name, harm)


@pytest.mark.parametrize("order", ["abc", "cab"])
def test_a_frozen_process_stalls_nobody_else(order: str) -> None:
    check_unharmed(play(order, freeze(8.0)))


@pytest.mark.skipif(bool(no_hosts()), reason=no_hosts() or "-")
def test_a_cable_that_is_out_stalls_nobody_on_this_side() -> None:
    check_unharmed(cut_the_cable("cab", 8.0))


def test_a_subscriber_that_is_stopped_takes_nothing_from_the_others() -> None:
    """Of 10 kB each, so that what waits for it soon fills all buffers: nobody waits for it then."""
    harms = play("abc", freeze(6.0), "--keep-all", "--rate", "500", "--bytes", "10000", names="abc")
    stopped = harms.pop("c")
    check_unharmed(harms)
    assert [harm.lost for harm in harms.values()] == [0, 0]
    assert stopped.lost > 0
    assert stopped.told >= stopped.lost


@pytest.mark.parametrize("shared_memory", [True, False])
@pytest.mark.parametrize("size", [100_000, 1_000_000, 10_000_000])
def test_a_late_joiner_has_a_large_latched_message_at_once(size: int, shared_memory: bool) -> None:
    took, harms = join_late(size, shared_memory=shared_memory)
    assert took < LONG
    assert all(harm.late < LONG for harm in harms.values())
