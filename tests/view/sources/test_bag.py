"""A bag in the view: played, paused, sought and at other speeds, by Foxglove's operations."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from websockets.sync.client import connect

from robolink.bag.reader import Bag, open_bag
from robolink.bag.topic import BagTopic
from robolink.bag.writer import BagWriter
from robolink.view.protocol.requests import PlaybackControl
from robolink.view.server import Settings, View
from robolink.view.sources.bag import BagSource
from tests.support.bags import CHATTER, MAP, START, ten_messages, text, write
from tests.support.view_clients import Client

SECOND = 10**9
PLAYING, PAUSED, ENDED = 0, 1, 3


@contextmanager
def playing(path: Path, subprotocol: str = "foxglove.sdk.v1") -> Iterator[Client]:
    """Show a bag of ten messages, a second apart."""
    write(path, ten_messages())
    with open_bag(path) as bag, View(BagSource(bag), Settings(port=0)) as view:
        address = f"ws://127.0.0.1:{view.port}/?token={view.token}"
        with connect(address, subprotocols=[subprotocol], compression=None) as socket:  # type: ignore[list-item]
            yield Client(socket)


def control(client: Client, play: bool, speed: float = 1.0, seek: int | None = None, name: str = "me") -> None:
    raw = struct.pack("<BBfBQI", 3, not play, speed, seek is not None, seek or 0, len(name)) + name.encode()
    client.socket.send(raw)


def state(client: Client, name: str = "me") -> tuple[int, int, float, bool]:
    """Return the state that answers a request: status, time, speed, and whether the time jumped."""
    while True:
        for each in client.binary:
            if each[0] == 5 and each[19:] == name.encode():
                client.binary.remove(each)
                status, now, speed, jumped, _ = struct.unpack_from("<BQfBI", each, 1)
                return status, now, speed, bool(jumped)
        client.listen()


@pytest.mark.parametrize("subprotocol", ["robolink.v1", "foxglove.sdk.v1", "foxglove.websocket.v1"])
def test_a_bag_is_played_from_its_begin_to_its_end(tmp_path: Path, subprotocol: str) -> None:
    with playing(tmp_path / "bag", subprotocol) as client:
        info = client.wait_for("serverInfo")
        assert {"playbackControl", "time"} <= set(info["capabilities"])
        assert info["dataStartTime"] == {"sec": START // SECOND, "nsec": 0}
        assert info["dataEndTime"] == {"sec": START // SECOND + 9, "nsec": 0}
        assert info["robolink"]["bag"] == str(tmp_path / "bag")
        subscription = client.subscribe("/chatter")
        control(client, True, 100)
        assert state(client)[::2] == (PLAYING, 100)
        heard = [client.next(subscription) for _ in range(6)]
        assert heard == [each.data for each in ten_messages() if each.topic == "/chatter"]
        assert state(client, "")[0] in {PLAYING, PAUSED}
        while (found := state(client, ""))[0] != ENDED:
            pass
        assert found[1] == START + 9 * SECOND
        control(client, True, 100, None, "again")
        assert state(client, "again")[3]  # at the end, play begins again
        assert client.next(subscription) == text("hello 1")


def test_a_seek_shows_what_was_last_at_that_time(tmp_path: Path) -> None:
    with playing(tmp_path / "bag") as client:
        control(client, False)
        assert state(client)[0] == PAUSED
        chatter = client.subscribe("/chatter")
        latched = client.subscribe("/map")
        assert client.next(latched) == text("hello 0")
        control(client, False, 2.0, START + 5 * SECOND + 1, "seek")
        assert client.next(chatter) == text("hello 5")
        assert client.next(latched) == text("hello 3")  # what a late subscription would have: the depth is 1
        assert state(client, "seek") == (PAUSED, START + 5 * SECOND + 1, 2.0, True)
        control(client, True, 100, None, "on")
        assert client.next(chatter) == text("hello 7")
        control(client, False, 1.0, 0, "before")  # before the begin is the begin
        assert state(client, "before")[1] == START
        control(client, False, 1.0, START + 5 * SECOND + 1, "back")
        assert state(client, "back")[1] == START + 5 * SECOND + 1
        client.send("unsubscribe", subscriptionIds=[latched])
        late = client.subscribe("/map")
        assert client.next(late) == text("hello 3")
        control(client, False, 1.0, START + 60 * SECOND, "end")  # behind the end is the end, with its last message
        assert state(client, "end")[:2] == (PAUSED, START + 9 * SECOND)
        while client.next(late) != text("hello 9"):
            pass


@pytest.mark.parametrize(
    "request_", [{"op": "advertise", "channels": [{"id": 1, "topic": "/x", "encoding": "cdr", "schemaName": "Twist"}]}]
)
def test_nothing_is_published_to_a_bag(tmp_path: Path, request_: dict[str, Any]) -> None:
    with playing(tmp_path / "bag") as client:
        client.send(**request_)
        assert "no running system here, but a bag" in client.wait_for("status")["message"]
        client.send("stop", held=True)
        assert "no running system here, but a bag" in client.wait_for("status")["message"]
        client.send("getParameters", parameterNames=[])
        assert "no running system here, but a bag" in client.wait_for("status")["message"]


def test_a_topic_whose_type_nobody_knows_is_told_and_the_others_are_shown(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        writer.write(writer.add_topic(CHATTER), START, START, 0, text("x"))
        odd = CHATTER._replace(name="/odd", type_name="odd_msgs/msg/Odd", message_definition="")
        writer.write(writer.add_topic(odd), START, START, 0, b"\0\1\0\0")
    with open_bag(tmp_path / "bag") as bag:
        source = BagSource(bag)
        assert [each.topic for each in source.channels.values()] == ["/chatter"]
        with View(source, Settings(port=0)) as view:
            address = f"ws://127.0.0.1:{view.port}/"
            with connect(address, subprotocols=["robolink.v1"], compression=None) as socket:  # type: ignore[list-item]
                assert "/odd" in Client(socket).wait_for("status")["message"]


class Watched:
    """Audience of a source without a server, which counts."""

    def __init__(self) -> None:
        self.told: list[str] = []
        self.time = self.changes = 0

    def tell(self, level: int, message: str, id_: str) -> None:
        self.told.append(message)

    def time_is(self, now: int) -> None:
        self.time = now

    def playback_changed(self, *, did_seek: bool) -> None:
        self.changes += 1


def bag_of(path: Path, *said: tuple[BagTopic, int, str]) -> Bag:
    """Write a bag of (topic, seconds, text), and open it."""
    with BagWriter(path) as writer:
        numbers = {(each.name, each.type_name): writer.add_topic(each) for each, _, _ in said}
        for topic, at, words in said:
            writer.write(numbers[topic.name, topic.type_name], START + at * SECOND, START + at * SECOND, 0, text(words))
    return open_bag(path)


def test_static_transforms_of_a_bag_without_qos_are_latched(tmp_path: Path) -> None:
    static = CHATTER._replace(name="/tf_static")
    with bag_of(tmp_path / "bag", (static, 0, "odom"), (CHATTER, 60, "late")) as bag:
        source, watched = BagSource(bag), Watched()
        source.begin(watched)  # type: ignore[arg-type]
        assert [each.topic for each in source.channels.values() if each.latched] == ["/tf_static"]
        source.control(PlaybackControl(False, 1.0, START + 59 * SECOND, "me"))
        assert [each.payload for each in source.retained(source.channels[1])] == [text("odom")]
        assert source.retained(source.channels[2]) == []
        source.control(PlaybackControl(False, 1.0, START + 60 * SECOND, "me"))
        assert [each.payload for each in source.retained(source.channels[2])] == [text("late")]


def test_a_topic_of_two_types_is_left_out_and_told(tmp_path: Path) -> None:
    other = CHATTER._replace(type_name="std_msgs/msg/Bool", message_definition="bool data\n")
    with bag_of(tmp_path / "bag", (CHATTER, 0, "a"), (other, 1, "b"), (MAP, 2, "c")) as bag:
        source, watched = BagSource(bag), Watched()
        source.begin(watched)  # type: ignore[arg-type]
        assert [each.topic for each in source.channels.values()] == ["/map"]
        assert watched.told == ["of several types, not shown: /chatter"]


def test_an_empty_bag_is_shown_and_over(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        writer.add_topic(CHATTER)
    with open_bag(tmp_path / "bag") as bag:
        source, watched = BagSource(bag), Watched()
        source.begin(watched)  # type: ignore[arg-type]
        source.listen(source.channels[1])
        source.sweep()
        assert source.playback_state(did_seek=False)[1] == ENDED
        assert watched.changes == 2


def test_a_bag_that_reads_slowly_plays_slowly_and_in_order(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0]
    monkeypatch.setattr("robolink.view.sources.bag.clocks", SimpleNamespace(steady=lambda: now[0]))
    with bag_of(tmp_path / "bag", *((CHATTER, second, str(second)) for second in range(5))) as bag:
        source, watched, heard = BagSource(bag), Watched(), list[bytes]()
        source.begin(watched)  # type: ignore[arg-type]
        source.channels[1].takers = [lambda at, payload, sender: heard.append(payload)]
        source.listen(source.channels[1])
        now[0] += 10 * SECOND  # the process was held up: it goes on by LONGEST_STEP only
        source.sweep()
        assert watched.time == START + SECOND // 4
        source.control(PlaybackControl(True, 8.0, None, "fast"))
        for _ in range(2):
            now[0] += SECOND // 4
            source.sweep()
        assert heard == [text(str(each)) for each in range(5)]
        assert source.playback_state(did_seek=False)[1] == ENDED
        assert watched.time == START + 4 * SECOND
