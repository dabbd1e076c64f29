"""Players of bags: what is published when; ranges, rates, pauses, steps, jumps, loops, latched topics, /clock."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.bag.playing import Player, PlayError, PlaySettings
from robolink.bag.selection import Selection
from robolink.bag.topic import BagError, BagTopic
from robolink.bag.writer import BagWriter
from robolink.exceptions import TransportError
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.service_msgs.msg import ServiceEventInfo
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import encode, type_hash
from robolink.publisher import Publisher
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.testing import System
from tests.support import bags
from tests.support.players import START, Played, counting, topic, write
from tests.support.seen_by_commands import spinning

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    return counting(tmp_path / "bag")


def test_messages_keep_their_distances_to_the_nanosecond(system: System, tmp_path: Path) -> None:
    gaps = [0.0, 0.000000001, 0.1, 0.100000002, 3.7]
    write(tmp_path / "bag", [topic("/count")], [(each, "/count", str(each)) for each in gaps])
    played = Played(system, [tmp_path / "bag"])

    played.run(5.0)

    assert played.times == gaps
    assert played.player.ended.is_set()


def test_a_rate_of_two_is_twice_as_fast(system: System, bag: Path) -> None:
    played = Played(system, [bag], PlaySettings(rate=2.0))
    played.run(10.0)
    assert played.times == [0.0, 0.5, 1.0, 1.5, 2.0]


def test_the_rate_can_be_changed_while_it_plays(system: System, bag: Path) -> None:
    played = Played(system, [bag])
    played.run(1.5)
    played.playback.set_rate(0.5)
    played.run(10.0)
    assert played.times == [0.0, 1.0, 2.5, 4.5, 6.5]
    with pytest.raises(PlayError, match="rate: expected"):
        played.playback.set_rate(0.0)


@pytest.mark.parametrize(
    ("settings", "texts", "times"),
    [
        (PlaySettings(start_offset=2.5), ["3", "4"], [0.5, 1.5]),
        (PlaySettings(duration=2.0), ["0", "1", "2"], [0.0, 1.0, 2.0]),
        (PlaySettings(start_offset=1.0, duration=0.5), ["1"], [0.0]),
        (PlaySettings(until=START + 10**9), ["0", "1"], [0.0, 1.0]),
        (PlaySettings(until=START + 10**9, duration=0.5), ["0"], [0.0]),
        (PlaySettings(delay=2.0), ["0", "1", "2", "3", "4"], [2.0, 3.0, 4.0, 5.0, 6.0]),
        (PlaySettings(start_offset=60.0), [], []),
    ],
)
def test_a_part_of_a_bag(
    system: System, bag: Path, settings: PlaySettings, texts: list[str], times: list[float]
) -> None:
    played = Played(system, [bag], settings)
    played.run(10.0)
    assert (played.texts, played.times) == (texts, times)
    assert played.player.ended.is_set()


def test_a_loop_begins_again_at_the_end(system: System, bag: Path) -> None:
    played = Played(system, [bag], PlaySettings(loop=True, duration=1.0, delay=0.5))
    assert played.run(3.9) == ["0", "1", "0", "1", "0"]
    assert played.times == [0.5, 1.5, 2.0, 3.0, 3.5]
    played.playback.stop()
    assert played.run(5.0) == []
    assert played.player.ended.is_set()


def test_a_loop_of_one_message_lets_time_pass(system: System, tmp_path: Path) -> None:
    played = Played(system, [counting(tmp_path / "bag", 1)], PlaySettings(loop=True))
    assert 10 <= len(played.run(0.1)) <= 11


def test_a_pause_stops_the_bag_and_not_the_time(system: System, bag: Path) -> None:
    played = Played(system, [bag])
    played.run(1.5)
    played.playback.pause()
    assert played.run(10.0) == []
    assert played.playback.time == START + 1_500_000_000
    played.playback.resume()
    played.run(10.0)
    assert played.times == [0.0, 1.0, 12.0, 13.0, 14.0]


def test_single_steps_and_bursts_while_it_pauses(system: System, bag: Path) -> None:
    played = Played(system, [bag], PlaySettings(start_paused=True))
    assert played.run(3.0) == []
    assert played.playback.play_next()
    assert played.run(0.0) == ["0"]
    assert played.playback.burst(2) == 2
    assert played.run(0.0) == ["1", "2"]
    assert played.playback.time == START + 2 * 10**9
    played.playback.resume()
    assert not played.playback.play_next()
    assert played.run(1.0) == ["3"]
    played.playback.pause()
    assert played.playback.burst(0) == 1
    assert played.run(0.0) == ["4"]


def test_seek_goes_forth_and_back(system: System, bag: Path) -> None:
    played = Played(system, [bag])
    played.run(0.5)
    assert played.playback.seek(START + 3 * 10**9)
    assert played.run(0.5) == ["3"]
    assert played.playback.seek(START + 500_000_000)
    assert played.run(1.0) == ["1"]
    assert not played.playback.seek(START - 1)
    assert not played.playback.seek(START + 5 * 10**9)
    assert played.run(10.0) == ["2", "3", "4"]
    assert played.playback.seek(START), "after the end, it goes on"
    assert played.run(10.0) == ["0", "1", "2", "3", "4"]


def test_seek_in_a_pause_stays_paused(system: System, bag: Path) -> None:
    played = Played(system, [bag], PlaySettings(start_paused=True))
    assert played.playback.seek(START + 2 * 10**9)
    assert played.run(5.0) == []
    assert played.playback.play_next()
    assert played.run(0.0) == ["2"]


def test_latched_topics_come_first_with_an_offset_and_after_a_seek(system: System, tmp_path: Path) -> None:
    said = [
        (0.0, "/map", "old"),
        (1.0, "/map", "map"),
        (2.0, "/count", "2"),
        (3.0, "/map", "new"),
        (4.0, "/count", "4"),
    ]
    path = write(tmp_path / "bag", [topic("/map", LATCHED), topic("/count")], said)
    played = Played(system, [path], PlaySettings(start_offset=1.5), ["/map", "/count"])
    assert played.run(1.0) == ["map", "2"]
    played.playback.seek(START + 3_500_000_000)
    assert played.run(10.0) == ["new", "4"]


def test_a_late_subscription_gets_what_is_latched(system: System, tmp_path: Path) -> None:
    said = [(0.0, "/tf_static", "a"), (0.1, "/tf_static", "b"), (5.0, "/count", "end")]
    path = write(tmp_path / "bag", [topic("/tf_static", LATCHED, LATCHED), topic("/count")], said)
    played = Played(system, [path], names=[])
    played.run(1.0)
    late = system.messages("/tf_static")
    played.run(0.1)
    assert [each.data for each in late] == ["a", "b"], "one of each publisher"


def test_publishers_offer_what_was_recorded(system: System, tmp_path: Path) -> None:
    best = QoSProfile(depth=3, reliability=ReliabilityPolicy.BEST_EFFORT)
    topics = [topic("/best", best), topic("/mixed", best, QoSProfile(depth=20)), topic("/map", LATCHED), topic("/none")]
    path = write(tmp_path / "bag", topics, [(0.0, "/best", "x")])
    override = QoSProfile(depth=7, durability=DurabilityPolicy.TRANSIENT_LOCAL)

    Played(system, [path], PlaySettings(qos_overrides={"/none": override}))
    system.run(0.1)

    found = {each.topic_name: each.qos_profile for each in _publishers(system)}
    assert found["/best"].reliability is ReliabilityPolicy.BEST_EFFORT
    assert found["/mixed"].reliability is ReliabilityPolicy.RELIABLE
    assert found["/mixed"].depth == 20
    assert found["/map"].durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert found["/none"].depth == 7


def _publishers(system: System) -> list[Publisher[Any]]:
    (node,) = [each for each in system._stage.nodes() if each.get_name() == "rosbag2_player"]
    return list(node.publishers)


def test_several_bags_are_merged_by_their_times(system: System, tmp_path: Path) -> None:
    one = write(tmp_path / "one", [topic("/count")], [(0.0, "/count", "a"), (2.0, "/count", "c")])
    two = write(tmp_path / "two", [topic("/count")], [(1.0, "/count", "b"), (3.0, "/count", "d")])
    played = Played(system, [one, two])
    played.run(10.0)
    assert played.texts == ["a", "b", "c", "d"]
    assert played.times == [0.0, 1.0, 2.0, 3.0]


def test_chosen_topics_alone_are_played(system: System, tmp_path: Path) -> None:
    path = write(tmp_path / "bag", [topic("/a"), topic("/b")], [(0.0, "/a", "a"), (0.0, "/b", "b")])
    played = Played(system, [path], PlaySettings(selection=Selection(topics=("/b",))), ["/a", "/b"])
    played.run(1.0)
    assert played.texts == ["b"]
    assert "/a" not in system.topics or not system.publishers("/a")


def test_the_clock_ticks_and_stops_with_a_pause(system: System, bag: Path) -> None:
    clocks: list[int] = []
    system.node.create_subscription(
        Clock, "/clock", lambda tick: clocks.append(tick.clock.sec * 10**9 + tick.clock.nanosec), 100
    )
    played = Played(system, [bag], PlaySettings(clock_rate=4.0))
    played.run(1.0)
    assert clocks == [START + each * 250_000_000 for each in range(5)]
    played.playback.pause()
    played.run(0.5)
    assert clocks[5:] == [START + 10**9] * 2


def test_the_clock_by_topic_comes_with_each_of_its_messages(system: System, bag: Path) -> None:
    clocks = system.messages("/clock", Clock)
    Played(system, [bag], PlaySettings(clock_topics=frozenset({"/count"}))).run(10.0)
    assert [each.clock.sec * 10**9 + each.clock.nanosec for each in clocks] == [
        START + each * 10**9 for each in range(5)
    ]


def test_messages_by_the_time_they_were_sent(system: System, bag: Path) -> None:
    played = Played(system, [bag], PlaySettings(order="sent"))
    played.run(10.0)
    assert played.texts == ["0", "1", "2", "3", "4"]


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        (PlaySettings(rate=-1.0), "rate: expected"),
        (PlaySettings(rate=float("nan")), "rate: expected"),
        (PlaySettings(delay=-1.0), "delay: expected"),
        (PlaySettings(order="any"), "message order"),
        (PlaySettings(selection=Selection(topics=("/none",))), "no topic is selected"),
    ],
)
def test_wrong_settings_are_refused(system: System, bag: Path, settings: PlaySettings, words: str) -> None:
    with pytest.raises(PlayError, match=words):
        Played(system, [bag], settings)


def test_an_empty_bag_and_none_are_refused(system: System, tmp_path: Path) -> None:
    write(tmp_path / "empty", [topic("/a")], [])
    with pytest.raises(PlayError, match="empty: there is no message to play"):
        Played(system, [tmp_path / "empty"])
    with pytest.raises(BagError, match="none"):
        Played(system, [tmp_path / "none"])


def test_two_types_of_one_topic_are_refused(system: System, bag: Path, tmp_path: Path) -> None:
    other = topic("/count")._replace(type_name="std_msgs/msg/Int32")
    write(tmp_path / "other", [other], [(0.0, "/count", "x")])
    with pytest.raises(BagError, match="is a std_msgs/msg/Int32 there, and a std_msgs/msg/String before"):
        Played(system, [bag, tmp_path / "other"])


def test_in_real_time_a_thread_of_its_own_plays(context: Context, tmp_path: Path) -> None:
    said = [(each / 1000, "/count", str(each)) for each in range(20)]
    path = write(tmp_path / "bag", [topic("/count")], said)
    node = Node("rosbag2_player", context=context)
    heard: list[str] = []
    all_came = threading.Event()

    def hear(message: String) -> None:
        heard.append(message.data)
        if len(heard) == 40:
            all_came.set()

    node.create_subscription(String, "/count", hear, 100)
    player = Player(node, [path])
    with spinning(node):
        player.start()
        assert player.wait(10.0)
        assert player.playback.begin(), "again, after its end"
        assert player.wait(10.0)
        assert all_came.wait(10.0)
    player.close()
    player.close()
    assert heard == 2 * [str(each) for each in range(20)]


def test_recorded_requests_can_be_sent_again(system: System, tmp_path: Path) -> None:
    got: list[bool] = []

    def serve(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        got.append(request.data)
        return response

    system.node.create_service(SetBool, "/light", serve)
    name = "/light/_service_event"
    kind = BagTopic(name, "std_srvs/srv/SetBool_Event", "cdr", type_hash(SetBool.Event))
    with BagWriter(tmp_path / "bag") as writer:
        number = writer.add_topic(kind)
        for event_type in (ServiceEventInfo.REQUEST_SENT, ServiceEventInfo.REQUEST_RECEIVED):
            info = ServiceEventInfo(event_type=event_type)
            event = SetBool.Event(info=info, request=[SetBool.Request(data=True)])
            writer.write(number, START, START, 0, encode(event))

    Played(system, [tmp_path / "bag"], PlaySettings(service_requests="service_introspection"), []).run(1.0)

    assert got == [True]
    assert name not in system.topics


def test_a_type_that_is_not_installed_is_the_bags(system: System, tmp_path: Path) -> None:
    text = "Part part\n" + "=" * 80 + "\nMSG: my_robot/Part\nint32 number\n"
    kinds = [
        BagTopic("/described", "my_robot/msg/Whole", "cdr", "", (), text),
        BagTopic("/raw", "my_robot/msg/Other", "cdr", "RIHS01_" + "ab" * 32),
        BagTopic("/neither", "my_robot/msg/Nothing"),
    ]
    with BagWriter(tmp_path / "bag") as writer:
        for kind in kinds:
            writer.write(writer.add_topic(kind), START, START, 0, b"\0\1\0\0\7\0\0\0")

    Played(system, [tmp_path / "bag"], names=[])
    system.run(1.0)

    assert system.topics == {"/described": "my_robot/msg/Whole", "/raw": "my_robot/msg/Other"}
    counts = {each.name: each.count for each in system.story.recorder.topics.values()}
    assert (counts["/described"], counts["/raw"]) == (1, 1)
    assert any("topic '/neither' is not played" in each.message for each in system.logs)


@pytest.mark.parametrize(("version", "storage"), [(8, "mcap"), (9, "mcap"), (8, "sqlite3"), (9, "sqlite3")])
def test_bags_of_rosbags_play(system: System, tmp_path: Path, version: int, storage: str) -> None:
    said = bags.ten_messages()
    bags.write_theirs(tmp_path / "bag", said, version=version, storage=storage)
    played = Played(system, [tmp_path / "bag"], names=["/chatter", "/map"])
    played.run(20.0)
    assert played.texts == [f"hello {number}" for number in range(10)]
    assert played.times == [float(number) for number in range(10)]


def test_an_error_of_the_network_ends_the_playing_with_one_line(
    system: System, bag: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    played = Played(system, [bag])

    def refuse(*_: object) -> bool:
        raise TransportError("too large")

    monkeypatch.setattr(played.player._publishers, "publish", refuse)
    played.run(3.0)

    assert played.player.ended.is_set()
    assert [each.message for each in system.logs] == ["playing ends: too large"]
