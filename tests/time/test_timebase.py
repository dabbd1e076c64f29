"""Time bases: virtual time jumps and does what was noted for a moment; skewed clocks go wrong by rule."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.running.inbox import Inbox
from robolink.running.timebase import SkewedTime, SystemTime, TimeBase, VirtualTime

NS = st.integers(0, 10**15)


def test_acts_are_done_as_time_comes_in_the_order_of_time_and_asking() -> None:
    time, done = VirtualTime(), list[tuple[str, int]]()
    for name, at in (("c", 30), ("a", 10), ("b", 10), ("late", 100)):
        time.at(at, lambda name=name: done.append((name, time.now())))  # type: ignore[misc]
    inbox = Inbox()
    time.wait(inbox, 50)
    assert done == [("a", 10), ("b", 10)]  # a wait may be shorter than was asked for
    time.sleep(40)
    assert (done[2:], time.now()) == ([("c", 30)], 50)
    assert time.wait(inbox, None) is None
    assert (done[3:], time.now()) == ([("late", 100)], 100)


def test_an_act_for_the_past_is_done_at_the_next_jump_and_may_ask_for_more() -> None:
    time, done = VirtualTime(100), list[int]()
    time.at(5, lambda: time.at(110, lambda: done.append(time.now())))
    time.sleep(1)
    assert (done, time.now()) == ([], 101)
    time.sleep(20)
    assert (done, time.now()) == ([110], 121)


def test_virtual_time_waits_until_it_holds_or_jumps() -> None:
    time = VirtualTime()
    time.wait_until(lambda: True, 50)
    assert time.now() == 0
    time.wait_until(lambda: False, 50)
    assert time.now() == 50
    asked = iter([False, False, True])
    time.wait_until(lambda: next(asked), None)
    assert time.now() == 50


@pytest.mark.parametrize("time", [SystemTime(), VirtualTime(), SkewedTime(SystemTime())])
def test_taking_from_a_queue(time: TimeBase) -> None:
    source: queue.SimpleQueue[int] = queue.SimpleQueue()
    with pytest.raises(queue.Empty):
        time.take(source, time.steady() + 1000)
    source.put(1)
    assert time.take(source, time.steady() + 10**12) == 1
    threading.Timer(0.01, source.put, [2]).start()
    assert time.take(source, None) == 2


def test_the_systems_time_asks_again_and_again() -> None:
    time, asked = SystemTime(), iter([False, True])
    time.wait_until(lambda: next(asked), None)
    begin = time.steady()
    time.wait_until(lambda: False, begin + 10**6)
    assert time.steady() >= begin + 10**6


def test_a_skewed_clock_is_ahead_and_drifts() -> None:
    base = VirtualTime(10**9)
    clock = SkewedTime(base, ahead=500, drift=-0.25)
    assert (clock.now(), clock.steady()) == (10**9 + 500, 10**9)
    base.sleep(1000)
    assert (clock.now(), clock.steady()) == (10**9 + 500 + 750, 10**9 + 750)
    clock.sleep(750)
    assert base.now() == 10**9 + 2000
    clock.wait(Inbox(), clock.steady() + 3)
    assert base.now() == 10**9 + 2004


@given(st.floats(-0.9, 10.0), NS, NS)
def test_a_moment_of_a_skewed_clock_has_come_when_its_base_says_so(drift: float, passed: int, later: int) -> None:
    base = VirtualTime(7)
    clock = SkewedTime(base, drift=drift)
    base.sleep(passed)
    until = clock.steady() + later
    base.sleep(clock.on_base(until) - base.now())
    assert until <= clock.steady() <= until + 11


@pytest.mark.parametrize("drift", [-1.0, -2.0, float("nan"), float("inf"), -1.0 + 1e-10])
def test_a_clock_cannot_stand_still_or_go_back(drift: float) -> None:
    with pytest.raises(ValueError, match="drift must be above -1"):
        SkewedTime(VirtualTime(), drift=drift)


def host_time() -> TimeBase:
    from robolink.host.pace import HostTime

    made = HostTime(0)
    made.scheduler.close()
    return made


BASES = {
    "system": (SystemTime, False, False, None, 0.0, False),
    "virtual": (VirtualTime, True, True, 0, 1.0, True),
    "host": (host_time, False, True, None, 1.0, True),
    "skewed": (lambda: SkewedTime(VirtualTime(), ahead=5), True, True, 5, 1.0, True),
    "skewed system": (lambda: SkewedTime(SystemTime(), ahead=5), False, False, None, 0.0, False),
}


@pytest.mark.parametrize(("make", "stands", "news", "stamp", "pace", "repeats"), BASES.values(), ids=BASES)
def test_what_differs_between_time_bases(
    make: Callable[[], TimeBase], stands: bool, news: bool, stamp: int | None, pace: float, repeats: bool
) -> None:
    time = make()
    assert (time.stands_still_for_threads(), time.ends_are_news(), time.fastest_pace()) == (stands, news, pace)
    clock = time.log_clock()
    assert (None if clock is None else clock()) == stamp
    assert (time.random_ids(b"gid").getrandbits(128) == time.random_ids(b"gid").getrandbits(128)) is repeats


def test_only_real_time_and_an_endless_wait_block_the_thread() -> None:
    blocked: list[float | None] = []

    def wait(time: TimeBase, until: int | None) -> int:
        time.wait_notified(lambda: False, until, blocked.append)
        return time.steady()

    virtual = VirtualTime()
    assert wait(virtual, 70) == 70
    assert blocked == []
    wait(virtual, None)
    wait(SystemTime(), None)
    assert blocked == [None, None]
    system = SystemTime()
    wait(system, system.steady() + 10**12)
    wait(system, 0)
    assert blocked[2] == pytest.approx(1000.0, abs=100.0)
    assert blocked[3] == 0.0
    fast = SkewedTime(virtual, drift=1.0)
    assert wait(fast, fast.steady() + 100) >= 100
    assert virtual.now() == 120  # half of it, by the clock behind


@pytest.mark.parametrize("time", [SystemTime(), VirtualTime(), SkewedTime(SystemTime())])
def test_taking_soon_gives_up_within_a_moment(time: TimeBase) -> None:
    source: queue.SimpleQueue[int] = queue.SimpleQueue()
    with pytest.raises(queue.Empty):
        time.take_soon(source, None)
    source.put(1)
    assert time.take_soon(source, None) == 1
    source.put(2)
    assert time.take_soon(source, 0) == 2
