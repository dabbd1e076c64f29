"""Messages that belong together come together; the rules are checked against their plainest form."""

from __future__ import annotations

import itertools
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robolink import Context
from robolink.clock import ROSClock
from robolink.companions.message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    Chain,
    DeltaFilter,
    InputAligner,
    PathDeltaFilter,
    SimpleFilter,
    Subscriber,
    TimeSequencer,
    TimeSynchronizer,
)
from robolink.companions.message_filters.input_aligner import QueueStatus
from robolink.companions.message_filters.synchronizers import nearest_together
from robolink.duration import Duration
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.geometry_msgs.msg import PointStamped
from robolink.interfaces.std_msgs.msg import Header, String
from robolink.node import Node
from robolink.qos import qos_profile_sensor_data
from robolink.time import ClockType, Time
from tests.support.spins import spin_until


def stamped(nanoseconds: int, frame: str = "") -> PointStamped:
    sec, nanosec = divmod(nanoseconds, 10**9)
    return PointStamped(header=Header(stamp=TimeMsg(sec=sec, nanosec=nanosec), frame_id=frame))


def ros(seconds: float) -> Time:
    return Time(seconds=seconds, clock_type=ClockType.ROS_TIME)


def stamps_of(messages: Any) -> tuple[int, ...]:
    return tuple(Time.from_msg(each.header.stamp).nanoseconds for each in messages)


class Collected:
    """The sets of stamps that a synchronizer has put out."""

    def __init__(self, synchronizer: SimpleFilter) -> None:
        self.sets: list[tuple[int, ...]] = []
        synchronizer.registerCallback(lambda *messages: self.sets.append(stamps_of(messages)))


def test_callbacks_get_the_message_and_their_own_arguments() -> None:
    source, seen = SimpleFilter(), list[Any]()
    assert source.registerCallback(lambda *args: seen.append(args), 7, "x") == 0
    assert source.registerCallback(lambda *args: seen.append(args)) == 1
    source.signalMessage("a", "b")
    assert seen == [("a", "b", 7, "x"), ("a", "b")]


def test_a_callback_may_register_another() -> None:
    source, seen = SimpleFilter(), list[str]()
    source.registerCallback(lambda message: source.registerCallback(seen.append))
    source.signalMessage("first")
    source.signalMessage("second")
    assert seen == ["second"]


def test_a_subscriber_puts_out_the_messages_of_a_topic(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node = Node("n", context=virtual)
    executor.add_node(node)
    subscriber = Subscriber(node, String, "chatter", qos_profile=qos_profile_sensor_data)
    by_name = Subscriber(node=node, msg_type=String, topic="chatter")
    seen: list[str] = []
    for each in (subscriber, by_name):
        each.registerCallback(lambda message: seen.append(message.data))
    node.create_publisher(String, "chatter", 10).publish(String(data="hey"))
    spin_until(executor, lambda: len(seen) == 2)
    assert seen == ["hey", "hey"]
    assert subscriber.getTopic() == "chatter"
    assert subscriber.topic_name == "/chatter"  # the subscription's
    with pytest.raises(AttributeError, match="no_such"):
        _ = subscriber.no_such


# --- a cache ----------------------------------------------------------------------------------------------------


def test_a_cache_answers_by_time() -> None:
    source, passed = SimpleFilter(), list[Any]()
    cache = Cache(source, 3)
    cache.registerCallback(passed.append)
    assert (cache.getLast(), cache.getOldestTime(), cache.getLastestTime()) == (None, None, None)
    messages = [stamped(second * 10**9) for second in range(5)]
    for each in messages:
        source.signalMessage(each)
    assert passed == messages
    assert cache.cache_msgs == messages[2:]
    assert (cache.getOldestTime(), cache.getLastestTime()) == (ros(2), ros(4))
    assert cache.getLast() is messages[4]
    assert cache.getInterval(ros(2.5), ros(4)) == messages[3:]
    assert cache.getElemAfterTime(ros(2.5)) is messages[3]
    assert cache.getElemBeforeTime(ros(2.5)) is messages[2]
    assert (cache.getElemAfterTime(ros(9)), cache.getElemBeforeTime(ros(1))) == (None, None)
    with pytest.raises(AssertionError):
        cache.getInterval(ros(2), ros(1))


@given(st.lists(st.integers(0, 50), max_size=12), st.integers(1, 5), st.integers(0, 50))
def test_a_cache_whose_messages_come_in_any_order(stamps: list[int], size: int, asked: int) -> None:
    source = SimpleFilter()
    cache = Cache(source, size)
    for each in stamps:
        source.signalMessage(stamped(each))
    kept = stamps[-size:]
    time = Time(nanoseconds=asked, clock_type=ClockType.ROS_TIME)
    after, before = cache.getElemAfterTime(time), cache.getElemBeforeTime(time)
    assert [*stamps_of([after] if after else [])] == sorted(each for each in kept if each >= asked)[:1]
    assert [*stamps_of([before] if before else [])] == sorted(each for each in kept if each <= asked)[-1:]
    assert stamps_of(cache.cache_msgs) == tuple(kept)


def test_messages_without_a_stamp(virtual: Context, log_lines: list[Record]) -> None:
    node = Node("n", context=virtual)
    subscriber = Subscriber(node, String, "chatter")
    cache = Cache(subscriber, 5)
    for _ in range(3):
        subscriber.signalMessage(String())
    assert cache.getLast() is None
    assert ["String has no header" in each.message for each in log_lines] == [True]
    by_arrival = Cache(subscriber, 5, allow_headerless=True)
    subscriber.signalMessage(String(data="now"))
    assert by_arrival.getLast().data == "now"
    assert by_arrival.getLastestTime() == node.get_clock().now()  # virtual time stands still here


def test_a_stamp_before_0_ends_no_node(log_lines: list[Record]) -> None:
    inputs = [SimpleFilter(), SimpleFilter()]
    cache, nearly, exactly = Cache(inputs[0], 5), ApproximateTimeSynchronizer(inputs, 5, 0.1), list[Any]()
    TimeSynchronizer(inputs, 5).registerCallback(lambda *them: exactly.append(them))
    nearly.registerCallback(lambda *_: pytest.fail("these have no time"))
    for each in inputs:
        each.signalMessage(stamped(-2 * 10**9))
        each.signalMessage(stamped(-1))
    assert [len(them) for them in exactly] == [2, 2]
    assert cache.getLast() is None
    assert ["is left out for its stamp" in each.message for each in log_lines] == [True, True]


# --- the very same stamp ------------------------------------------------------------------------------------------


ARRIVALS = st.lists(st.tuples(st.integers(0, 2), st.integers(0, 8)), max_size=40)


@given(ARRIVALS, st.integers(1, 4))
@example([(0, 0), (0, 1), (1, 0), (1, 1), (2, 1), (2, 0)], 2)
def test_sets_of_the_same_stamp(arrivals: list[tuple[int, int]], size: int) -> None:
    sources = [SimpleFilter() for _ in range(3)]
    collected = Collected(TimeSynchronizer(sources, size))
    queues: list[list[int]] = [[], [], []]
    expected = []
    for index, stamp in arrivals:
        sources[index].signalMessage(stamped(stamp))
        queue = queues[index]
        queue[:] = [*(each for each in queue if each != stamp), stamp][-size:]
        if all(stamp in each for each in queues):
            expected.append((stamp,) * 3)
            for each in queues:
                each[:] = [later for later in each if later > stamp]
    assert collected.sets == expected


@pytest.mark.parametrize("kind", [TimeSynchronizer, lambda fs, size: ApproximateTimeSynchronizer(fs, size, 0.1)])
def test_it_goes_on_after_the_clock_was_set_back(kind: Any) -> None:
    sources = [SimpleFilter(), SimpleFilter()]
    collected = Collected(kind(sources, 3))
    for second in (100, 101, 102, 103):
        sources[0].signalMessage(stamped(second * 10**9))
    for second in (1, 2, 3):
        for source in sources:
            source.signalMessage(stamped(second * 10**9))
    assert collected.sets == [(second * 10**9,) * 2 for second in (1, 2, 3)]


@pytest.mark.parametrize("kind", [TimeSynchronizer, lambda fs, size: ApproximateTimeSynchronizer(fs, size, 0.1)])
def test_a_callback_may_fail_or_put_in_more(kind: Any) -> None:
    sources = [SimpleFilter(), SimpleFilter()]
    synchronizer, seen = kind(sources, 5), list[int]()

    def again(one: Any, _: Any) -> None:
        (stamp,) = stamps_of([one])
        seen.append(stamp)
        if stamp == 1:
            for source in sources:
                source.signalMessage(stamped(2 * 10**9))
            raise ValueError("mine")

    synchronizer.registerCallback(again)
    sources[0].signalMessage(stamped(1))
    with pytest.raises(ValueError, match="mine"):
        sources[1].signalMessage(stamped(1))
    assert seen == [1, 2 * 10**9]


# --- nearly the same stamp ------------------------------------------------------------------------------------------


@given(
    st.integers(0, 40),
    st.lists(st.lists(st.integers(0, 40), max_size=5, unique=True), min_size=1, max_size=3),
    st.integers(0, 20),
)
def test_the_nearest_that_fit_are_chosen(stamp: int, others: list[list[int]], slop: int) -> None:
    near = [
        sorted((each for each in stamps if abs(each - stamp) < slop), key=lambda it: abs(it - stamp))
        for stamps in others
    ]
    fitting = (list(each) for each in itertools.product(*near) if max(*each, stamp) - min(*each, stamp) < slop)
    assert nearest_together(stamp, others, slop) == next(fitting, None)


def test_many_topics_at_odds_take_no_time() -> None:
    low, high = list(range(100, 150)), list(range(250, 300))
    assert nearest_together(200, [low] * 7 + [high], 101) is None  # 50 ** 8 ways to choose


@given(ARRIVALS, st.integers(1, 4), st.integers(0, 4))
def test_approximate_sets_are_together_and_no_message_is_used_twice(
    arrivals: list[tuple[int, int]], size: int, slop: int
) -> None:
    sources = [SimpleFilter() for _ in range(3)]
    synchronizer = ApproximateTimeSynchronizer(sources, size, 0.0)
    synchronizer.slop = Duration(nanoseconds=slop)
    used: list[int] = []
    sets: list[tuple[int, ...]] = []
    synchronizer.registerCallback(lambda *them: used.extend(map(id, them)))
    synchronizer.registerCallback(lambda *them: sets.append(stamps_of(them)))
    kept = []
    for index, stamp in arrivals:
        kept.append(stamped(stamp))
        sources[index].signalMessage(kept[-1])
    assert all(max(each) - min(each) < slop for each in sets)
    assert len(used) == len(set(used))


def test_messages_without_a_stamp_are_taken_by_their_arrival(virtual: Context, log_lines: list[Record]) -> None:
    node = Node("n", context=virtual)
    inputs = [Subscriber(node, String, "a"), Subscriber(node, PointStamped, "b")]
    refusing, seen = ApproximateTimeSynchronizer(inputs, 5, 0.1), list[Any]()
    taking = ApproximateTimeSynchronizer(inputs, 5, 0.1, allow_headerless=True)
    by_arrival = ApproximateTimeSynchronizer(inputs, 5, 0.1, sync_arrival_time=True)
    for name, each in (("refusing", refusing), ("taking", taking), ("arrival", by_arrival)):
        each.registerCallback(lambda *them: seen.append(them[-1]), name)
    now = node.get_clock().now().nanoseconds
    for stamp in (now, 10**9):
        inputs[0].signalMessage(String())
        inputs[1].signalMessage(stamped(stamp))
    assert seen == ["taking", "arrival", "arrival"]
    assert len([each for each in log_lines if "no header" in each.message]) == 1


def test_times_of_rclpy_are_stamps_too() -> None:
    sources = [SimpleFilter(), SimpleFilter()]
    synchronizer, seen = ApproximateTimeSynchronizer(sources, 2, 0.1), list[Any]()
    synchronizer.registerCallback(lambda *them: seen.append(them))
    for source in sources:
        source.signalMessage(SimpleNamespace(header=SimpleNamespace(stamp=ROSClock().now())))
    assert len(seen) == 1


def test_by_topics_in_a_system(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node = Node("n", context=virtual)
    executor.add_node(node)
    both = ApproximateTimeSynchronizer([Subscriber(node, PointStamped, each) for each in "ab"], 10, 0.05)
    collected = Collected(both)
    publishers = [node.create_publisher(PointStamped, each, 10) for each in "ab"]
    for tick in range(5):
        for offset, publisher in enumerate(publishers):
            publisher.publish(stamped(tick * 10**9 + offset * 10**7))
    spin_until(executor, lambda: len(collected.sets) == 5)
    assert collected.sets == [(tick * 10**9, tick * 10**9 + 10**7) for tick in range(5)]


def test_a_set_earlier_than_one_that_went_out_is_dropped() -> None:
    inputs = [SimpleFilter(), SimpleFilter()]
    synchronizer = TimeSynchronizer(inputs, 10)
    collected = Collected(synchronizer)
    inputs[0].signalMessage(stamped(1))
    inputs[1].signalMessage(stamped(2))
    inputs[0].signalMessage(stamped(2))
    assert collected.sets == [(2, 2)]
    inputs[1].signalMessage(stamped(1))
    assert collected.sets == [(2, 2)]
    assert [list(queue) for queue in synchronizer.queues] == [[], [1]]


def test_an_offset_of_a_topic_is_taken_off_its_stamps() -> None:
    inputs = [SimpleFilter(), SimpleFilter()]
    collected = Collected(ApproximateTimeSynchronizer(inputs, 5, 1e-9 * 3, queue_offset=[0, 100]))
    inputs[0].signalMessage(stamped(10))
    inputs[1].signalMessage(stamped(10))
    inputs[1].signalMessage(stamped(111))
    assert collected.sets == [(10, 111)]


def test_the_fourth_argument_of_older_programs_allows_messages_without_a_header(virtual: Context) -> None:
    source = SimpleFilter()
    seen: list[Any] = []
    synchronizer = ApproximateTimeSynchronizer([source], 5, 0.1, True)
    synchronizer.registerCallback(seen.append)
    source.signalMessage(String(data="a"))
    assert (synchronizer.allow_headerless, seen) == (True, [String(data="a")])


def by_data(message: Any) -> Time:
    return Time(nanoseconds=int(message.data))


@pytest.mark.parametrize(
    "make",
    [
        lambda fs: TimeSynchronizer(fs, 5, time_getter=by_data),
        lambda fs: ApproximateTimeSynchronizer(fs, 5, 0.1, time_getter=by_data),
    ],
)
def test_the_time_may_be_a_function_of_the_message(make: Any) -> None:
    inputs, seen = [SimpleFilter(), SimpleFilter()], list[Any]()
    cache = Cache(inputs[0], 5, time_getter=by_data)
    make(inputs).registerCallback(lambda *them: seen.append(them))
    for each in inputs:
        each.signalMessage(String(data="7"))
    assert seen == [(String(data="7"), String(data="7"))]
    assert cache.getLatestTime() == by_data(String(data="7")) == cache.getLastestTime()


def test_exact_sets_need_a_time() -> None:
    source = SimpleFilter()
    TimeSynchronizer([source], 5)
    with pytest.raises(ValueError, match="String has no header with a stamp: pass a time_getter"):
        source.signalMessage(String(data="a"))


def test_a_removed_callback_gets_nothing_and_its_number_is_not_given_again() -> None:
    source, seen = SimpleFilter(), list[str]()
    first = source.registerCallback(lambda _: seen.append("first"))
    source.registerCallback(lambda _: seen.append("second"))
    source.unregisterCallback(first)
    source.unregisterCallback(first)
    source.registerCallback(lambda _: seen.append("third"))
    source.signalMessage(1)
    assert seen == ["second", "third"]


def test_a_chain_hands_on_from_filter_to_filter() -> None:
    source, seen = SimpleFilter(), list[Any]()
    chain = Chain(source)
    chain.registerCallback(seen.append)
    source.signalMessage(String(data="a"))
    changes, lengths = PathDeltaFilter(["data"]), DeltaFilter([lambda message: len(message.data)])
    chain.addFilter(changes)
    chain.addFilter(lengths)
    for text in ("b", "b", "c", "cc"):
        source.signalMessage(String(data=text))
    assert [each.data for each in seen] == ["a", "b", "cc"]
    assert (chain.getFilter(0), chain.getFilter(1)) == (changes, lengths)
    with pytest.raises(KeyError):
        chain.getFilter(2)
    with pytest.raises(RuntimeError, match="Already connected"):
        chain.connectInput(source)


def test_only_changes_of_fields_pass() -> None:
    source, seen = SimpleFilter(), list[Any]()
    PathDeltaFilter(["header.frame_id", "point.x"], source).registerCallback(seen.append)
    messages = [stamped(at, frame) for at, frame in enumerate("aabba")]
    for each in messages:
        source.signalMessage(each)
    assert stamps_of(seen) == (0, 2, 4)


def test_fields_that_cannot_be_compared_are_named() -> None:
    by_path = PathDeltaFilter(["header.stmp"])
    by_path.add(stamped(1))
    with pytest.raises(RuntimeError, match=r"Header has no field 'stmp' \(path 'header.stmp'\)"):
        by_path.add(stamped(2))
    by_value = DeltaFilter([lambda message: message.header])
    by_value.add(stamped(1))
    with pytest.raises(TypeError, match="fields of bool, int, float, str, not of Header"):
        by_value.add(stamped(2))
    with pytest.raises(RuntimeError, match="already has an incoming connection"):
        DeltaFilter([], SimpleFilter()).connectInput(SimpleFilter())


def aligned(timeout: float, count: int) -> tuple[InputAligner, list[SimpleFilter], list[tuple[int, ...]]]:
    inputs, seen = [SimpleFilter() for _ in range(count)], list[tuple[int, ...]]()
    aligner = InputAligner(Duration(nanoseconds=timeout), *inputs)
    for index in range(count):
        aligner.registerCallback(index, lambda message, at: seen.append((at, *stamps_of([message]))), index)
    return aligner, inputs, seen


def test_messages_of_several_topics_come_in_the_order_of_their_stamps() -> None:
    aligner, inputs, seen = aligned(10, 2)
    for index, stamp in ((0, 5), (1, 3), (0, 8), (1, 9)):
        inputs[index].signalMessage(stamped(stamp))
    aligner.setInputPeriod(0, Duration(nanoseconds=4))
    aligner.setInputPeriod(1, Duration(nanoseconds=4))
    aligner.dispatchMessages()
    assert seen == [(1, 3), (0, 5), (0, 8), (1, 9)]
    inputs[1].signalMessage(stamped(13))
    aligner.dispatchMessages()
    assert seen[4:] == []  # the first input is due at 12
    inputs[1].signalMessage(stamped(22))
    aligner.dispatchMessages()
    assert seen[4:] == [(1, 13), (1, 22)]
    inputs[0].signalMessage(stamped(21))
    assert aligner.getQueueStatus(0) == QueueStatus(False, 0, 2, 1)
    assert aligner.getQueueStatus(1) == QueueStatus(True, 0, 4, 0)


def test_an_aligner_takes_other_inputs() -> None:
    aligner, inputs, seen = aligned(10, 2)
    aligner.connectInput(inputs[0])
    aligner.registerCallback(0, lambda message: seen.append((7, *stamps_of([message]))))
    for each in inputs:
        each.signalMessage(stamped(5))
    aligner.dispatchMessages()
    assert seen == [(7, 5)]


def test_an_aligner_and_a_sequencer_in_a_system(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node = Node("listener", context=virtual)
    executor.add_node(node)
    source, aligned_at, sequenced_at = SimpleFilter(), list[tuple[int, int]](), list[tuple[int, int]]()
    aligner = InputAligner(Duration(seconds=1), source)
    aligner.setupDispatchTimer(node, Duration(seconds=0.1))
    sequencer = TimeSequencer(source, 0.5, 0.1, 0, node)
    start = node.get_clock().now().nanoseconds

    def since(message: Any) -> tuple[int, int]:
        return stamps_of([message])[0] - start, (node.get_clock().now().nanoseconds - start) // 10**8

    aligner.registerCallback(0, lambda message: aligned_at.append(since(message)))
    sequencer.registerCallback(lambda message: sequenced_at.append(since(message)))
    for offset in (3, 1, 2):
        source.signalMessage(stamped(start + offset))
    spin_until(executor, lambda: len(sequenced_at) == 3)
    assert aligned_at == [(1, 1), (2, 1), (3, 1)]
    assert sequenced_at == [(1, 6), (2, 6), (3, 6)]
    source.signalMessage(stamped(start))
    sequencer.shutdown()
    assert sequencer.messages == []
    assert sequencer.last_time.nanoseconds == start + 3


def test_a_sequencer_drops_what_is_too_much_and_what_has_no_stamp(
    virtual: Context, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    node = Node("listener", context=virtual)
    executor.add_node(node)
    sequencer = TimeSequencer(None, 0.0, 0.1, 2, node)
    for stamp in (3, 1, 2):
        sequencer.add(stamped(stamp))
    assert [stamp for stamp, _, _ in sorted(sequencer.messages)] == [2, 3]
    sequencer.add(String(data="a"))
    assert "String has no header.stamp" in log_lines[-1].message
    with pytest.raises(TypeError, match="expected a Time, got str"):
        TimeSequencer(None, 0.0, 0.1, 2, node, "data").add(String(data="a"))
    sequencer.connectInput(SimpleFilter())
    with pytest.raises(RuntimeError, match="Already connected"):
        sequencer.connectInput(SimpleFilter())
