"""Clocks: types, ROS time, jumps and whom they are told, sleeping."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest

from robolink import Clock, Context, Duration, Time, VirtualTime
from robolink.clock import ClockChange, JumpHandle, JumpThreshold, ROSClock, TimeJump
from robolink.clock_type import ClockType
from robolink.exceptions import NotInitializedException
from tests.support.transports import until

SECOND = 1_000_000_000
ANY = JumpThreshold(min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1))


def ros_time(seconds: float) -> Time:
    return Time(nanoseconds=int(seconds * SECOND), clock_type=ClockType.ROS_TIME)


@pytest.mark.parametrize("kind", list(ClockType))
def test_a_clock_tells_time_of_its_type(kind: ClockType) -> None:
    clock = Clock(clock_type=kind)
    assert clock.clock_type is kind
    assert clock.now().clock_type is kind
    assert isinstance(clock, ROSClock) is (kind is ClockType.ROS_TIME)
    assert kind.name in repr(clock)
    assert clock.now() <= clock.now()


def test_a_clock_needs_a_type() -> None:
    with pytest.raises(TypeError, match="ClockType"):
        Clock(clock_type="wall")  # type: ignore[arg-type] # what is tested


def test_a_virtual_clock_stands_until_somebody_sleeps() -> None:
    time = VirtualTime(start=5)
    clocks = [Clock(clock_type=kind, time_base=time) for kind in ClockType]
    assert [clock.now_ns() for clock in clocks] == [5] * len(clocks)
    time.sleep(10)
    assert [clock.now_ns() for clock in clocks] == [15] * len(clocks)
    assert clocks[0].wait_ns(20) == 5


def test_ros_time_is_what_it_was_set_to_while_active() -> None:
    clock = ROSClock(time_base=VirtualTime(start=7))
    clock.set_ros_time_override(ros_time(100))
    assert clock.now_ns() == 7
    clock._set_ros_time_is_active(True)
    assert clock.ros_time_is_active
    assert clock.now() == ros_time(100)
    assert clock.wait_ns(101 * SECOND) is None
    clock.set_ros_time_override(ros_time(102))
    assert clock.wait_ns(101 * SECOND) == -SECOND
    with pytest.raises(TypeError, match=r"\.time\.Time"):
        clock.set_ros_time_override(3)  # type: ignore[arg-type] # what is tested


@pytest.mark.parametrize(
    ("forward", "backward", "on_change"), [(0, None, True), (-1, None, True), (None, 0, True), (None, 1, True)]
)
def test_thresholds_have_signs(forward: int | None, backward: int | None, on_change: bool) -> None:
    with pytest.raises(ValueError, match="non-zero"):
        JumpThreshold(
            min_forward=None if forward is None else Duration(nanoseconds=forward),
            min_backward=None if backward is None else Duration(nanoseconds=backward),
            on_clock_change=on_change,
        )


def test_a_threshold_that_is_never_met_is_refused() -> None:
    with pytest.raises(ValueError, match="At least one"):
        JumpThreshold(min_forward=None, min_backward=None, on_clock_change=False)


def test_callbacks_of_a_jump_must_be_callable() -> None:
    clock = ROSClock()
    with pytest.raises(ValueError, match="One of"):
        clock.create_jump_callback(ANY)
    with pytest.raises(ValueError, match="pre_callback"):
        JumpHandle(clock=clock, threshold=ANY, pre_callback=1, post_callback=None)  # type: ignore[arg-type] # tested
    with pytest.raises(ValueError, match="post_callback"):
        JumpHandle(clock=clock, threshold=ANY, pre_callback=None, post_callback=1)  # type: ignore[arg-type] # tested
    with pytest.raises(TypeError, match="ClockChange"):
        TimeJump(1, Duration())  # type: ignore[arg-type] # what is tested


def test_a_jump_is_told_before_and_after() -> None:
    clock, told = ROSClock(), list[object]()
    clock._set_ros_time_is_active(True)
    clock.set_ros_time_override(ros_time(10))
    handle = clock.create_jump_callback(
        JumpThreshold(min_forward=Duration(seconds=1), min_backward=Duration(seconds=-1)),
        pre_callback=lambda: told.append("before"),
        post_callback=lambda jump: told.append((jump.clock_change, jump.delta.nanoseconds)),
    )
    clock.set_ros_time_override(ros_time(12))
    clock.set_ros_time_override(ros_time(12.5))
    clock.set_ros_time_override(ros_time(5))
    same = ClockChange.ROS_TIME_NO_CHANGE
    assert told == ["before", (same, 2 * SECOND), "before", (same, int(-7.5 * SECOND))]
    handle.unregister()
    handle.unregister()
    told.clear()
    clock.set_ros_time_override(ros_time(100))
    assert told == []


def test_a_change_of_the_source_is_told_to_whom_it_matters() -> None:
    clock, told = ROSClock(), list[ClockChange]()
    matters = JumpThreshold(min_forward=None, min_backward=None, on_clock_change=True)
    not_here = JumpThreshold(min_forward=Duration(nanoseconds=1), min_backward=None, on_clock_change=False)
    with (
        clock.create_jump_callback(matters, post_callback=lambda jump: told.append(jump.clock_change)),
        clock.create_jump_callback(not_here, pre_callback=lambda: told.clear()),
    ):
        clock._set_ros_time_is_active(True)
        clock._set_ros_time_is_active(True)
        clock._set_ros_time_is_active(False)
    assert told == [ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED]


# Sleeping


@pytest.mark.parametrize("kind", list(ClockType))
def test_sleeping_in_virtual_time_jumps(kind: ClockType, virtual: Context) -> None:
    clock = Clock(clock_type=kind, time_base=virtual.time)
    assert clock.sleep_for(Duration(seconds=3600), virtual)
    assert clock.now_ns() == 3600 * SECOND
    assert clock.sleep_until(Time(nanoseconds=0, clock_type=kind), virtual)
    assert clock.now_ns() == 3600 * SECOND


def test_sleeping_takes_its_time(context: Context) -> None:
    clock = Clock(clock_type=ClockType.STEADY_TIME)
    before = clock.now_ns()
    assert clock.sleep_for(Duration(seconds=0.02), context)
    assert clock.now_ns() - before >= 0.02 * SECOND


def test_sleeping_needs_a_time_of_the_same_type_and_a_context(context: Context) -> None:
    clock = Clock()
    with pytest.raises(ValueError, match="clock type"):
        clock.sleep_until(ros_time(1), context)
    with pytest.raises(NotInitializedException):
        clock.sleep_for(Duration(seconds=1))


def once_it_sleeps(clock: Clock, act: Callable[[], object]) -> None:
    """Do this in another thread as soon as somebody sleeps on this clock."""

    def wait() -> None:
        until(lambda: bool(clock._jumps))
        act()

    threading.Thread(target=wait).start()


def test_the_end_of_the_context_wakes_a_sleeper(context: Context) -> None:
    clock = Clock()
    once_it_sleeps(clock, context.shutdown)
    assert not clock.sleep_for(Duration(seconds=3600), context)


def test_a_sleeper_in_ros_time_wakes_when_it_is_time_or_the_source_changes(context: Context) -> None:
    clock = ROSClock()
    clock._set_ros_time_is_active(True)

    def act() -> None:
        for step in (1.0, 3.0, 6.0):
            clock.set_ros_time_override(ros_time(step))

    once_it_sleeps(clock, act)
    assert clock.sleep_until(ros_time(5), context)
    once_it_sleeps(clock, lambda: clock._set_ros_time_is_active(False))
    assert not clock.sleep_until(ros_time(9), context)


def test_sleeping_often_leaves_nothing_behind(virtual: Context) -> None:
    clock = Clock(time_base=virtual.time)
    for _ in range(100):
        clock.sleep_for(Duration(seconds=1), virtual)
    assert len(virtual._callbacks) < 10
