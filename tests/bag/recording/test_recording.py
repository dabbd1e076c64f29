"""Recordings: what is published gets into the bag, whenever its topic comes; pauses, splits, snapshots, losses."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from robolink import Context, Node, type_lookup
from robolink.bag.recording import News, Recording, RecordingError, RecordSettings, Selection, listener
from robolink.bag.recording.writing import WritableBag
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.message import decode, type_hash
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.wire import unpack_attachment
from tests.support.carts import Cart
from tests.support.fake_bags import FakeBag
from tests.support.seen_by_commands import spinning
from tests.support.transports import Network
from tests.support.waits import wait_until

LATCHED = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
EVERYTHING = Selection(all_topics=True, exclude_topics=("/rosout", "/parameter_events"))


class Made:
    """Recordings of one test, with their bag and their news."""

    def __init__(self, node: Node) -> None:
        self.node, self.bag = node, FakeBag()
        self.told: list[str] = []
        self.failures: list[str] = []
        self.failed = threading.Event()
        self.made: list[Recording] = []

    def __call__(self, selection: Selection = EVERYTHING, settings: RecordSettings | None = None) -> Recording:
        news = News(self.told.append, self.told.append, self._fail)
        recording = Recording(self.node, "bag", selection, settings, news, make_bag=self._open)
        self.made.append(recording)
        recording.start()
        return recording

    def _open(self, path: Path, settings: RecordSettings) -> WritableBag:
        return self.bag

    def _fail(self, reason: str) -> None:
        self.failures.append(reason)
        self.failed.set()


@pytest.fixture
def made(context: Context) -> Iterator[Made]:
    made = Made(Node("recorder", context=context))
    yield made
    made.bag.open_gate.set()
    for each in made.made:
        each.stop()


@pytest.fixture
def talker(context: Context) -> Node:
    return Node("talker", context=context)


@contextmanager
def joined(net: Network) -> Iterator[Context]:
    context = Context(transport=net.session())
    context.init([])
    with context:
        yield context


def numbers(bag: FakeBag, topic: str = "/count") -> list[int]:
    return [decode(Int32, each.data).data for each in bag.of(topic)]


def test_everything_is_recorded_with_its_times_and_numbers(made: Made, talker: Node) -> None:
    publisher = talker.create_publisher(Int32, "/count", LATCHED)
    recording = made()
    for number in range(100):
        publisher.publish(Int32(data=number))
    assert recording.stop() == "metadata"
    assert numbers(made.bag) == list(range(100))
    found = made.bag.of("/count")
    assert [each.sequence for each in found] == list(range(1, 101))
    assert all(0 <= each.log_time - each.publish_time < 30e9 for each in found)
    assert [each.log_time for each in found] == sorted(each.log_time for each in found)
    (topic,) = (each for each in made.bag.topics if each.name == "/count")
    assert (topic.type_name, topic.type_hash) == ("std_msgs/msg/Int32", type_hash(Int32))
    assert topic.message_definition.endswith("int32 data\n")
    assert [each.durability for each in topic.offered_qos] == [DurabilityPolicy.TRANSIENT_LOCAL]
    figures = recording.figures()
    assert (figures.messages, figures.bytes, figures.topics) == (100, 800, 1)
    assert (figures.dropped, figures.lost, figures.waiting, figures.error) == ({}, {}, 0, "")


def test_messages_within_a_step_of_a_coarse_clock_have_times_of_their_own(
    made: Made, talker: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Python's own clock on Windows stands still for 15.6 ms: here it always does."""
    begin = time.time_ns()
    monkeypatch.setattr(time, "time_ns", lambda: begin)
    publisher = talker.create_publisher(Int32, "/count", LATCHED)
    recording = made()
    for number in range(5):
        publisher.publish(Int32(data=number))
    recording.stop()
    found = made.bag.of("/count")
    assert len({each.log_time for each in found}) == 5
    assert all(each.log_time >= each.publish_time > begin for each in found)


def test_a_topic_that_comes_later_and_what_was_latched_before_are_recorded(net: Network) -> None:
    with joined(net) as one, joined(net) as other:
        talker = Node("talker", context=one)
        latched = talker.create_publisher(Int32, "/latched", LATCHED)
        for number in range(3):
            latched.publish(Int32(data=number))
        made = Made(Node("recorder", context=other))
        recording = made()
        made.bag.wait_for("/latched", 2)
        assert numbers(made.bag, "/latched") == [1, 2]
        late = talker.create_publisher(Int32, "/late", 10)
        wait_until(lambda: late.get_subscription_count() == 1)
        wait_until(lambda: late._outlets._all[0].matched)
        late.publish(Int32(data=7))
        made.bag.wait_for("/late", 1)
        recording.stop()
        assert numbers(made.bag, "/late") == [7]


def test_a_latched_publisher_on_a_plain_topic_is_listened_to_anew_and_nothing_comes_twice(
    made: Made, talker: Node, context: Context
) -> None:
    plain = talker.create_publisher(Int32, "/count", 10)
    recording = made()
    plain.publish(Int32(data=1))
    other = Node("other", context=context)
    latched = other.create_publisher(Int32, "/count", LATCHED)
    plain.publish(Int32(data=2))
    latched.publish(Int32(data=3))
    recording.stop()
    assert numbers(made.bag) == [1, 2, 3]
    assert recording.figures().lost == {}


def test_a_type_that_is_not_installed_is_recorded_as_its_publisher_describes_it(made: Made, talker: Node) -> None:
    publisher = talker.create_publisher(Cart, "/cart", 10)
    with spinning(talker):
        recording = made()
        publisher.publish(Cart(label="first"))
        topic = made.bag.wait_for_topic("/cart")
        publisher.publish(Cart(label="second"))
        recording.stop()
    assert topic.message_definition.endswith("MSG: carts/Wheel\nfloat64 radius 0.1\n")
    assert [decode(Cart, each.data).label for each in made.bag.of("/cart")] == ["first", "second"]


def test_a_type_that_nobody_describes_is_recorded_in_bytes_and_told_once(
    made: Made, talker: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(type_lookup, "ANSWER_WITHIN", 0.05)
    carts = [talker.create_publisher(Cart, f"/cart{number}", 10) for number in range(3)]
    count = talker.create_publisher(Int32, "/count", 10)
    recording = made()
    for each in carts:
        each.publish(Cart(label="here"))
    count.publish(Int32(data=1))
    made.bag.wait_for("/count", 1)
    for number in range(3):
        assert made.bag.wait_for_topic(f"/cart{number}").message_definition == ""
    recording.stop()
    assert [len(made.bag.of(f"/cart{number}")) for number in range(3)] == [1, 1, 1]
    (told,) = (each for each in made.told if "Cart" in each and "Subscribed" not in each)
    assert "which is not installed" in told
    assert told.endswith("(it is recorded without its definition)")
    assert recording.figures().waiting == 0


def test_a_second_type_of_a_topic_is_left_out_and_told_once(made: Made, talker: Node, context: Context) -> None:
    talker.create_publisher(Int32, "/count", 10).publish(Int32(data=1))
    recording = made()
    other = Node("other", context=context)
    wrong = other.create_publisher(String, "/count", 10)
    wrong.publish(String(data="one"))
    other.create_publisher(String, "/count", 10)
    recording.stop()
    assert made.bag.of("/count") == []
    said = [each for each in made.told if "left out" in each]
    what = "what /other publishes there as std_msgs/msg/String is left out"
    assert said == [f"topic '/count' is recorded as std_msgs/msg/Int32: {what}"]


def test_a_pause_lets_messages_pass_but_not_what_is_latched(made: Made, talker: Node) -> None:
    plain = talker.create_publisher(Int32, "/count", 10)
    latched = talker.create_publisher(Int32, "/latched", LATCHED)
    recording = made(settings=RecordSettings(start_paused=True))
    assert recording.is_paused
    plain.publish(Int32(data=1))
    for number in range(5):
        latched.publish(Int32(data=number))
    wait_until(lambda: len(recording._listener.topics["/latched"].retained or ()) == 2)
    recording.toggle_paused()
    made.bag.wait_for("/latched", 2)
    plain.publish(Int32(data=2))
    made.bag.wait_for("/count", 1)
    recording.pause()
    plain.publish(Int32(data=3))
    recording.stop()
    assert numbers(made.bag) == [2]
    assert numbers(made.bag, "/latched") == [3, 4]
    assert recording.figures().lost == {}
    assert recording.figures().paused


def test_what_has_no_room_is_dropped_counted_by_topic_and_told(made: Made, talker: Node) -> None:
    made.bag.open_gate.clear()
    small = talker.create_publisher(Int32, "/count", 10)
    large = talker.create_publisher(String, "/text", 10)
    recording = made(settings=RecordSettings(max_cache_size=10_000))
    for number in range(10):
        small.publish(Int32(data=number))
        large.publish(String(data="x" * 4000))
    wait_until(lambda: recording.figures().dropped.get("/text", 0) >= 8)
    made.bag.open_gate.set()
    recording.stop()
    figures = recording.figures()
    assert figures.dropped["/text"] == 10 - len(made.bag.of("/text")) == 8
    assert figures.dropped.get("/count", 0) == 10 - len(made.bag.of("/count"))
    assert any(each.startswith("/text: 8 messages dropped, 8 in all: they come faster than") for each in made.told)


def test_messages_lost_on_the_way_are_counted_and_told(made: Made, talker: Node, context: Context) -> None:
    publisher = talker.create_publisher(Int32, "/count", 10)
    recording = made()
    publisher.publish(Int32(data=1))
    for _ in range(3):
        publisher._endpoint.attachment()  # numbers that nothing is sent with
    publisher.publish(Int32(data=2))
    recording.stop()
    assert numbers(made.bag) == [1, 2]
    assert recording.figures().lost == {"/count": 3}
    assert "/count: 3 messages lost on the way, 3 in all: the network did not bring them" in made.told


def test_a_full_disk_ends_the_recording_with_one_line_and_closes_the_bag(made: Made, talker: Node) -> None:
    made.bag.room = 5
    publisher = talker.create_publisher(Int32, "/count", 10)
    recording = made()
    for number in range(10):
        publisher.publish(Int32(data=number))
    assert made.failed.wait(30)
    with pytest.raises(RecordingError, match="nothing is being recorded"):
        recording.split()
    assert recording.stop() == "metadata"
    assert made.failures == ["bag_0.mcap: No space left on device"]
    assert recording.figures().error == made.failures[0]
    assert made.bag.closed
    assert numbers(made.bag) == list(range(5))


def test_a_split_begins_a_file_with_what_is_to_be_repeated(made: Made, talker: Node) -> None:
    plain = talker.create_publisher(Int32, "/count", 10)
    latched = talker.create_publisher(Int32, "/latched", LATCHED)
    recording = made(settings=RecordSettings(repeat_all_latched=True))
    for number in range(3):
        latched.publish(Int32(data=number))
    plain.publish(Int32(data=1))
    made.bag.wait_for("/count", 1)
    recording.split()
    plain.publish(Int32(data=2))
    recording.stop()
    first, second = ([(each.topic, decode(Int32, each.data).data) for each in file] for file in made.bag.files)
    assert first == [("/latched", 0), ("/latched", 1), ("/latched", 2), ("/count", 1)]
    assert second == [("/latched", 1), ("/latched", 2), ("/count", 2)]
    assert [each.log_time for each in made.bag.messages] == sorted(each.log_time for each in made.bag.messages)


def test_a_snapshot_has_the_last_bytes_and_each_is_a_file(made: Made, talker: Node) -> None:
    publisher = talker.create_publisher(Int32, "/count", 10)
    recording = made(settings=RecordSettings(snapshot_mode=True, max_cache_size=1000))
    assert not recording.snapshot()
    for number in range(100):
        publisher.publish(Int32(data=number))
    topic = recording._listener.topics["/count"]
    wait_until(lambda: sum(topic.gaps.last.values()) == 100 and recording.figures().waiting > 0)
    assert recording.snapshot()
    assert numbers(made.bag)[-1] == 99
    assert 1 <= len(numbers(made.bag)) <= 5
    publisher.publish(Int32(data=100))
    wait_until(lambda: recording.figures().waiting > 0)
    assert recording.snapshot()
    publisher.publish(Int32(data=101))
    recording.stop()
    assert [decode(Int32, each.data).data for each in made.bag.files[1]] == [100]
    assert recording.figures().dropped == {}


def test_sim_time_begins_with_the_clock_and_stamps_by_it(made: Made, talker: Node) -> None:
    clock = talker.create_publisher(Clock, "/clock", 10)
    publisher = talker.create_publisher(Int32, "/count", LATCHED)
    publisher.publish(Int32(data=0))
    recording = made(settings=RecordSettings(use_sim_time=True))
    publisher.publish(Int32(data=1))
    assert "waiting for /clock" in made.told[0]
    clock.publish(Clock(clock=Time(sec=10, nanosec=5)))
    made.bag.wait_for("/count", 2)
    clock.publish(Clock(clock=Time(sec=11)))
    publisher.publish(Int32(data=2))
    recording.stop()
    assert [each.log_time for each in made.bag.of("/count")] == [10_000_000_005, 10_000_000_005, 11_000_000_000]
    assert numbers(made.bag) == [0, 1, 2]


def test_topics_that_nobody_publishes_yet_are_recorded_on_request(made: Made, talker: Node) -> None:
    talker.create_subscription(String, "/awaited", lambda _: None, 10)
    made(settings=RecordSettings(include_unpublished=True))
    assert made.bag.wait_for_topic("/awaited").offered_qos == ()
    talker.create_publisher(String, "/awaited", 10).publish(String(data="here"))
    made.bag.wait_for("/awaited", 1)


def test_static_topics_are_listened_to_before_anybody_publishes(made: Made, talker: Node) -> None:
    static = {"/static": String, "/left_out": String}
    chosen = Selection(topics=("/static", "/left_out"), exclude_topics=("/left_out",))
    made(chosen, RecordSettings(static_topics=static, no_discovery=True))
    assert talker.count_subscribers("/static") == 1
    assert talker.count_subscribers("/left_out") == 0
    talker.create_publisher(String, "/static", 10).publish(String(data="first"))
    assert [decode(String, each.data).data for each in made.bag.wait_for("/static", 1)] == ["first"]
    assert made.bag.wait_for_topic("/static").message_definition.endswith("string data\n")


def test_topics_that_nobody_subscribes_to_are_left_out_on_request(made: Made, talker: Node) -> None:
    recording = made(settings=RecordSettings(ignore_leaf_topics=True))
    talker.create_publisher(Int32, "/leaf", 10)
    talker.create_publisher(Int32, "/used", 10)
    talker.create_subscription(Int32, "/used", lambda _: None, 10)
    made.bag.wait_for_topic("/used")
    recording.stop()
    assert [each.name for each in made.bag.topics] == ["/used"]


def test_without_discovery_only_what_is_there_is_recorded(made: Made, talker: Node) -> None:
    talker.create_publisher(Int32, "/there", 10)
    recording = made(settings=RecordSettings(no_discovery=True))
    talker.create_publisher(Int32, "/late", 10)
    made.bag.wait_for_topic("/there")
    recording.stop()
    assert [each.name for each in made.bag.topics] == ["/there"]


def test_an_override_is_the_profile_of_the_subscription(made: Made, talker: Node) -> None:
    talker.create_publisher(Int32, "/count", 10)
    wanted = QoSProfile(depth=7, reliability=ReliabilityPolicy.RELIABLE)
    made(settings=RecordSettings(qos_overrides={"/count": wanted}))
    (info,) = talker.get_subscriptions_info_by_topic("/count")
    assert (info.qos_profile.depth, info.qos_profile.reliability) == (7, ReliabilityPolicy.RELIABLE)


def test_a_recording_starts_once_and_stops_twice(made: Made) -> None:
    recording = made()
    with pytest.raises(RecordingError, match="starts once"):
        recording.start()
    assert recording.stop() == recording.stop() == "metadata"


def test_times_before_1970_end_no_recording(
    made: Made, talker: Node, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A bag has no such times: an MCAP cannot say them. A sender's clock, or /clock, may be wrong all the same."""
    monkeypatch.setattr(listener, "unpack_attachment", lambda text: unpack_attachment(text)._replace(timestamp=-5))
    clock = talker.create_publisher(Clock, "/clock", 10)
    count = talker.create_publisher(Int32, "/count", 10)
    recording = made(Selection(topics=("/count",)), settings=RecordSettings(use_sim_time=True))
    clock.publish(Clock(clock=Time(sec=-10)))
    wait_until(lambda: count.get_subscription_count() == 1)
    count.publish(Int32(data=1))
    recording.stop()
    assert [(each.log_time, each.publish_time) for each in made.bag.of("/count")] == [(0, 0)]
