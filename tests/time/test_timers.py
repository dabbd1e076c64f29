"""Timers and rates: when they call, that they do not drift, and what may be done to them in their own callbacks."""

from __future__ import annotations

import functools
import math
import threading
import time
from collections.abc import Callable

import pytest

import robolink
from robolink import Clock, Context, Node
from robolink.clock_type import ClockType
from robolink.exceptions import InvalidHandle, ROSInterruptException
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.running.timebase import SystemTime
from robolink.testing import System
from robolink.timer import Timer, TimerInfo
from tests.support.spins import spin_for, spin_until

MILLISECOND = 1_000_000
PATIENCE = 30.0


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    executor.add_node(made)
    return made


@pytest.fixture
def calls() -> list[int]:
    return []


def note_time(node: Node, calls: list[int]) -> Callable[[], None]:
    return lambda: calls.append(node.context.time.now() // MILLISECOND)


def test_a_timer_calls_every_period(node: Node, executor: SingleThreadedExecutor, calls: list[int]) -> None:
    timer = node.create_timer(0.1, note_time(node, calls))
    assert timer.time_until_next_call() == 100 * MILLISECOND
    spin_for(executor, 0.55)
    assert calls == [100, 200, 300, 400, 500]
    assert timer.time_since_last_call() == 50 * MILLISECOND
    assert not timer.is_ready()


def test_a_timer_does_not_drift(node: Node, executor: SingleThreadedExecutor, calls: list[int]) -> None:
    """A callback takes 30 ms, then one 250 ms: what is missed is left out, and the beat is kept."""

    def work() -> None:
        calls.append(node.context.time.now() // MILLISECOND)
        node.context.time.sleep((250 if len(calls) == 3 else 30) * MILLISECOND)

    node.create_timer(0.1, work)
    spin_for(executor, 0.95)
    assert calls == [100, 200, 300, 550, 600, 700, 800, 900]


def test_a_timer_in_real_time_keeps_its_beat(context: Context) -> None:
    with SingleThreadedExecutor(context=context) as executor:
        node, late = Node("node", context=context), list[int]()
        executor.add_node(node)
        begin, period = node.get_clock().now_ns(), 5 * MILLISECOND
        timer = node.create_timer(0.005, lambda: late.append(node.get_clock().now_ns() - timer.next_call_ns + period))
        first = timer.next_call_ns
        assert begin <= first - period <= node.get_clock().now_ns()
        spin_until(executor, lambda: len(late) == 40)
        beats, off = divmod(timer.next_call_ns - first, period)
    assert min(late) >= 0
    assert (beats >= 40, off) == (True, 0)


def test_a_timer_survives_an_executor_that_wakes_too_early(
    node: Node, executor: SingleThreadedExecutor, calls: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The clock of the timer and the one that the executor waits by are not one: the time of day is slewed."""
    timer = node.create_timer(0.1, note_time(node, calls))
    clock = node.get_clock()
    ahead = 3 * MILLISECOND
    monkeypatch.setattr(clock, "_read", lambda: node.context.time.now() - ahead)
    spin_for(executor, 0.35)
    assert calls == [103, 203, 303]
    assert not timer.is_canceled()


def test_a_timer_goes_on_when_its_clock_is_set_back(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    offset = 0

    class Settable(SystemTime):
        @staticmethod
        def now() -> int:
            return time.time_ns() + offset

    with SingleThreadedExecutor(context=context) as executor:
        node, calls = Node("node", context=context), list[int]()
        executor.add_node(node)
        clock = Clock(clock_type=ClockType.SYSTEM_TIME, time_base=Settable())
        node.create_timer(0.01, lambda: calls.append(1), clock=clock)
        spin_until(executor, lambda: len(calls) == 2)
        offset = -3600 * 10**9
        spin_until(executor, lambda: len(calls) == 4)


def test_a_callback_may_ask_when_it_should_have_been_called(node: Node, executor: SingleThreadedExecutor) -> None:
    infos: list[TimerInfo] = []

    def callback(info: TimerInfo) -> None:
        infos.append(info)

    def partly(_: str, info: TimerInfo) -> None:
        infos.append(info)

    node.create_timer(0.1, callback)
    node.create_timer(0.1, functools.partial(partly, "first"))
    node.create_timer(0.1, lambda: node.context.time.sleep(5 * MILLISECOND))
    spin_for(executor, 0.25)
    assert [each.expected_call_time.nanoseconds // MILLISECOND for each in infos] == [100, 100, 200, 200]
    assert all(each.actual_call_time >= each.expected_call_time for each in infos)


def test_cancel_and_reset(node: Node, executor: SingleThreadedExecutor, calls: list[int]) -> None:
    timer = node.create_timer(0.1, note_time(node, calls))
    timer.cancel()
    assert timer.is_canceled()
    assert timer.time_until_next_call() is None
    spin_for(executor, 0.25)
    timer.reset()
    assert not timer.is_canceled()
    spin_for(executor, 0.25)
    assert calls == [350, 450]


def test_a_timer_may_begin_later(node: Node, executor: SingleThreadedExecutor, calls: list[int]) -> None:
    timer = node.create_timer(0.1, note_time(node, calls), autostart=False)
    spin_for(executor, 0.3)
    assert timer.is_canceled()
    timer.reset()
    spin_for(executor, 0.1)
    assert calls == [400]


@pytest.mark.parametrize(
    ("act", "expected"),
    [
        (Timer.cancel, [100]),
        (Timer.destroy, [100]),
        (Timer.reset, [100, 200, 300]),
        (lambda timer: (timer.cancel(), timer.reset()), [100, 200, 300]),
    ],
)
def test_a_timer_may_be_changed_in_its_own_callback(
    node: Node,
    executor: SingleThreadedExecutor,
    calls: list[int],
    act: Callable[[Timer], object],
    expected: list[int],
) -> None:
    def callback() -> None:
        calls.append(node.context.time.now() // MILLISECOND)
        act(timer)

    timer = node.create_timer(0.1, callback)
    spin_for(executor, 0.35)
    assert calls == expected


def test_a_new_period_counts_from_the_next_call(node: Node, executor: SingleThreadedExecutor, calls: list[int]) -> None:
    timer = node.create_timer(0.1, note_time(node, calls))
    spin_for(executor, 0.15)
    timer.timer_period_ns = 50 * MILLISECOND
    assert timer.timer_period_ns == 50 * MILLISECOND
    spin_for(executor, 0.15)
    assert calls == [100, 200, 250, 300]


def test_a_timer_that_another_callback_cancels_when_both_are_due(
    node: Node, executor: SingleThreadedExecutor, calls: list[int]
) -> None:
    node.create_timer(0.1, lambda: second.cancel())
    second = node.create_timer(0.1, note_time(node, calls))
    spin_for(executor, 0.5)
    assert calls == []


def test_a_destroyed_timer_is_of_no_use(node: Node) -> None:
    timer = node.create_timer(0.1, lambda: None)
    assert node.destroy_timer(timer)
    assert not node.destroy_timer(timer)
    timer.destroy()
    assert list(node.timers) == []
    for use in (timer.reset, timer.cancel, timer.is_ready, timer.time_until_next_call):
        with pytest.raises(InvalidHandle):
            use()


@pytest.mark.parametrize(
    ("period", "error"),
    [(-0.1, "cannot be negative, got -0.1 s"), (math.nan, "of seconds, got nan"), (math.inf, "of seconds, got inf")],
)
def test_a_period_that_is_none_is_refused(node: Node, period: float, error: str) -> None:
    with pytest.raises(ValueError, match=error):
        node.create_timer(period, lambda: None)
    assert list(node.timers) == []


def test_another_callback_may_take_a_timers_place(node: Node, executor: SingleThreadedExecutor) -> None:
    heard: list[object] = []

    def with_info(*, when: TimerInfo) -> None:
        heard.append(when)

    timer = node.create_timer(0.1, lambda: heard.append("plain"))
    spin_for(executor, 0.1)
    timer.callback = with_info
    spin_for(executor, 0.1)
    assert heard[0] == "plain"
    assert isinstance(heard[1], TimerInfo)
    assert heard[1].expected_call_time.nanoseconds == 200 * MILLISECOND


def test_what_a_timer_info_cannot_be() -> None:
    with pytest.raises(ValueError, match="must not be negative"):
        TimerInfo(expected_call_time=-1)
    with pytest.raises(TypeError, match="ClockType"):
        TimerInfo(clock_type=1)  # type: ignore[arg-type] # what is tested


def test_a_coroutine_as_timer_callback(node: Node, executor: SingleThreadedExecutor, calls: list[int]) -> None:
    async def callback() -> None:
        calls.append(node.context.time.now() // MILLISECOND)
        await pause
        calls.append(-node.context.time.now() // MILLISECOND)

    pause = executor.create_future()
    node.create_timer(0.1, callback)
    node.create_timer(0.25, lambda: pause.set_result(None), node._rate_group)
    spin_for(executor, 0.32)
    assert calls == [100, -250, 250, -250, 300, -300]


def test_a_timer_without_a_callback_says_so_when_it_is_due(
    node: Node, executor: SingleThreadedExecutor, capsys: pytest.CaptureFixture[str]
) -> None:
    timer, called = node.create_timer(0.5, None), list[None]()
    timer.callback = lambda: called.append(None)
    spin_for(executor, 0.6)
    timer.callback = None
    with pytest.raises(TypeError, match=r"^the timer of 0\.5 s that was made at .*test_timers\.py:\d+ has None for a"):
        spin_for(executor, 1.0)
    assert called == [None]
    assert capsys.readouterr().err == ""  # it is for whoever spins to tell


def test_a_timer_calls_only_what_can_be_called(node: Node) -> None:
    with pytest.raises(TypeError, match=r"must be callable, got 3 \(a decimal number has a point: 1\.0\)$"):
        node.create_timer(0.5, 3)  # type: ignore[arg-type]
    assert list(node.timers) == []


def test_a_rate_sleeps_the_rest_of_each_period_in_one_thread(node: Node, executor: SingleThreadedExecutor) -> None:
    rate, woke = node.create_rate(10.0), list[int]()
    for work in (30, 99, 0):
        executor.spin_once(timeout_sec=0)
        node.context.time.sleep(work * MILLISECOND)
        rate.sleep()
        woke.append(node.context.time.now() // MILLISECOND)
    assert woke == [100, 200, 300]


def test_a_rate_that_would_never_return_with_ros_2_is_warned_of_once(
    node: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    rate, inside, slept = node.create_rate(10.0), node.create_rate(10.0), list[int]()
    for _ in range(2):
        rate.sleep()

    def work() -> None:
        timer.cancel()
        for _ in range(3):
            inside.sleep()
        slept.append(1)

    timer = node.create_timer(0.1, work)
    spin_until(executor, lambda: bool(slept))
    reasons = ["nothing spins its node", "the thread that sleeps is the one that spins"]
    assert [each in line.message for each, line in zip(reasons, log_lines, strict=True)] == [True, True]


def test_a_tick_that_comes_while_nobody_sleeps_is_kept(node: Node, executor: SingleThreadedExecutor) -> None:
    rate, woke = node.create_rate(10.0), list[int]()
    for _ in range(3):
        executor.spin_once()
        rate.sleep()
        woke.append(node.context.time.now() // MILLISECOND)
    assert woke == [100, 200, 300]


def test_of_several_ticks_that_nobody_slept_for_one_is_kept(node: Node, executor: SingleThreadedExecutor) -> None:
    rate, woke = node.create_rate(10.0), list[int]()
    spin_for(executor, 0.35)
    for _ in range(3):
        rate.sleep()
        woke.append(node.context.time.now() // MILLISECOND)
    assert woke == [350, 400, 500]


def test_work_that_takes_longer_than_a_period_is_followed_by_no_pause(
    node: Node, executor: SingleThreadedExecutor
) -> None:
    rate = node.create_rate(10.0)
    for _ in range(20):
        node.context.time.sleep(110 * MILLISECOND)
        executor.spin_once(timeout_sec=0)
        rate.sleep()
    assert node.context.time.now() == 2200 * MILLISECOND


def works(args: list[str] | None = None) -> None:
    robolink.init(args=args)
    node = Node("works")
    threading.Thread(target=robolink.spin, args=(node,), daemon=True).start()
    rate = node.create_rate(10.0)
    for _ in range(20):
        time.sleep(0.11)
        rate.sleep()
    node.get_logger().info("done")
    robolink.shutdown()


def test_nor_is_it_beside_a_thread_that_spins() -> None:
    with System() as system:
        system.start(works)
        system.expect_log("done")
        assert system.time == pytest.approx(2.2)


def test_a_sleep_that_is_broken_off_leaves_its_tick(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    rate = node.create_rate(10.0)
    with monkeypatch.context() as patch:
        patch.setattr(node.context.time, "wait_until", interrupt)
        with pytest.raises(KeyboardInterrupt):
            rate.sleep()
    rate._tick()
    rate.sleep()
    assert node.context.time.now() == 0


def interrupt(*_: object) -> None:
    raise KeyboardInterrupt


def test_a_rate_in_a_callback_sleeps_by_the_clock(node: Node, executor: SingleThreadedExecutor) -> None:
    rate, woke = node.create_rate(10.0), list[int]()

    def callback() -> None:
        timer.cancel()
        for _ in range(3):
            rate.sleep()
            woke.append(node.context.time.now() // MILLISECOND)

    timer = node.create_timer(0.15, callback)
    spin_for(executor, 1.0)
    assert woke == [150, 200, 300]  # the tick at 100 came while nobody slept


def test_a_rate_beside_a_thread_that_spins(context: Context) -> None:
    executor, node = SingleThreadedExecutor(context=context), Node("node", context=context)
    executor.add_node(node)
    begin = node.get_clock().now_ns()
    rate = node.create_rate(200.0)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    for _ in range(5):
        rate.sleep()
    assert node.get_clock().now_ns() - begin >= 5 * 5 * MILLISECOND
    assert node.destroy_rate(rate)
    with pytest.raises(RuntimeError, match="has been destroyed"):
        rate.sleep()
    executor.shutdown()
    thread.join(PATIENCE)


def test_destroying_a_rate_wakes_who_sleeps_by_it(context: Context) -> None:
    node = Node("node", context=context)
    rate = node.create_rate(0.01)
    threading.Timer(0.02, node.destroy_rate, (rate,)).start()
    rate.sleep()
    with pytest.raises(RuntimeError, match="has been destroyed"):
        rate.sleep()


def test_a_rate_whose_timer_was_destroyed_cannot_sleep(node: Node) -> None:
    rate = node.create_rate(1.0)
    node.destroy_timer(next(node.timers))
    with pytest.raises(InvalidHandle):
        rate.sleep()


def test_the_end_of_the_context_wakes_a_sleeping_rate(context: Context) -> None:
    rate = Node("node", context=context).create_rate(0.01)
    threading.Timer(0.02, context.shutdown).start()
    with pytest.raises(ROSInterruptException):
        rate.sleep()


def test_a_rate_must_be_above_zero(node: Node) -> None:
    with pytest.raises(ValueError, match="frequency must be > 0"):
        node.create_rate(0.0)
