"""Nonsense and floods of clients: each is refused in one line, and the server and its other clients go on."""

from __future__ import annotations

import contextlib
import json
import random
import socket
import struct
import threading
import time

import pytest
from websockets.exceptions import ConnectionClosed

from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.std_msgs.msg import Int32
from robolink.serialization import serialize_message
from robolink.view.server.client import MOST_MISTAKES, MOST_UNREAD, Client
from tests.support.view_clients import shown, until


def test_each_mistake_is_told_in_one_line_up_to_a_number() -> None:
    with shown() as system, system.client() as client:
        for _ in range(MOST_MISTAKES + 50):
            client.socket.send("nonsense")
        client.settle()
        told = [each["message"] for each in client.heard if each["op"] == "status"]
        assert len(told) == MOST_MISTAKES + 1
        assert "not JSON" in told[0]
        assert "no longer told" in told[-1]


@pytest.mark.parametrize(
    ("request_", "why"),
    [
        ({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 4000}]}, "there is no channel 4000"),
        ({"op": "unsubscribe", "subscriptionIds": [5]}, "there is no subscription 5"),
        ({"op": "unadvertise", "channelIds": [5]}, "there is no channel 5"),
        ({"op": "dance"}, "no operation 'dance'"),
        ({"op": "record", "command": "rewind"}, "there are start and stop"),
        ({"op": "advertise", "channels": 7}, "advertise: Expected `array`"),
        ({"op": "getParameters", "parameterNames": ["x"]}, "names no parameter"),
    ],
)
def test_what_is_not_there_is_refused(request_: dict[str, object], why: str) -> None:
    with shown() as system, system.client() as client:
        client.socket.send(json.dumps(request_))
        assert why in client.wait_for("status")["message"]


def test_a_channel_is_subscribed_once_so_that_nobody_multiplies_what_is_latched() -> None:
    with shown() as system, system.client() as client:
        publisher = system.node.create_publisher(Int32, "count", 10)
        first = client.subscribe("/count")
        wishes = [{"id": number, "channelId": client.channel("/count")["id"]} for number in range(100, 3000)]
        client.send("subscribe", subscriptions=wishes)
        assert "/count is subscribed already" in client.wait_for("status")["message"]
        client.settle()
        publisher.publish(Int32(data=1))
        client.next(first)
        client.send("unsubscribe", subscriptionIds=[first])
        client.send("subscribe", subscriptions=wishes[:1])
        client.settle()
        publisher.publish(Int32(data=2))
        assert client.next(100) == serialize_message(Int32(data=2))
        assert not client.got


def test_playback_of_a_running_system_is_refused() -> None:
    with shown() as system, system.client() as client:
        client.socket.send(struct.pack("<BBfBQI", 3, 0, 1.0, 0, 0, 0))
        assert "no bag here" in client.wait_for("status")["message"]


def test_random_bytes_end_nobody() -> None:
    dice = random.Random(1)
    with shown() as system, system.client() as good:
        publisher = system.node.create_publisher(Int32, "count", 10)
        subscription = good.subscribe("/count")
        good.settle()
        for _ in range(20):
            with system.client("foxglove.sdk.v1", max_queue=None) as bad:
                for _ in range(20):
                    bad.socket.send(dice.randbytes(dice.randrange(40)))
        for _ in range(10):
            with socket.create_connection(("127.0.0.1", system.view.port)) as raw:
                raw.sendall(dice.randbytes(200))
        publisher.publish(Int32(data=1))
        assert good.next(subscription) == serialize_message(Int32(data=1))


@pytest.mark.slow
def test_a_flood_of_one_client_leaves_the_others_their_turn() -> None:
    with shown() as system, system.client() as good, system.client() as flooder:
        publisher = system.node.create_publisher(Int32, "count", 10)
        subscription = good.subscribe("/count")
        good.settle()
        channel = {"id": 1, "topic": "/cmd_vel", "encoding": "cdr", "schemaName": "geometry_msgs/msg/Twist"}
        flooder.send("advertise", channels=[channel])
        payload = struct.pack("<BI", 1, 1) + serialize_message(Twist())
        ended = threading.Event()

        def flood() -> None:
            while not ended.is_set():
                try:
                    flooder.socket.send(payload)
                except ConnectionClosed:
                    return

        thread = threading.Thread(target=flood)
        thread.start()
        try:
            for number in range(20):
                begin = time.monotonic()
                publisher.publish(Int32(data=number))
                assert good.next(subscription) == serialize_message(Int32(data=number))
                assert time.monotonic() - begin < 2.0
        finally:
            ended.set()
            thread.join()


def test_clients_are_served_and_robots_stopped_where_a_message_cannot_be_read(monkeypatch: pytest.MonkeyPatch) -> None:
    with shown() as system, system.client() as client:
        heard: list[float] = []
        system.node.create_subscription(Twist, "cmd_vel", lambda twist: heard.append(twist.linear.x), 10)
        wish = {"id": 1, "topic": "/cmd_vel", "encoding": "cdr", "schemaName": "geometry_msgs/msg/Twist"}
        client.send("advertise", channels=[wish | {"stopAfter": 0.01}])
        client.settle()

        def broken() -> None:
            raise ValueError("unreadable")

        monkeypatch.setattr(system.source, "sweep", broken)
        client.publish(1, serialize_message(Twist(linear=Vector3(x=1.0))))
        with system.spinning():
            until(lambda: heard == [1.0, 0.0])


def test_a_socket_that_never_says_anything_is_closed_with_the_server() -> None:
    with shown() as system, socket.create_connection(("127.0.0.1", system.view.port)) as silent:
        system.ask()  # the silent one was accepted before
        system.view.close()
        silent.settimeout(10)
        with contextlib.suppress(ConnectionResetError):
            assert silent.recv(1) == b""


class StuckWire:
    """A connection whose other end reads nothing."""

    def __init__(self) -> None:
        self.written, self.aborted = 0, False

    def write(self, data: bytes) -> None:
        self.written += len(data)

    def get_write_buffer_size(self) -> int:
        return self.written

    def is_closing(self) -> bool:
        return self.aborted

    def abort(self) -> None:
        self.aborted = True


def test_a_client_that_reads_nothing_is_cut_before_its_answers_fill_the_memory() -> None:
    with shown() as system:
        wire = StuckWire()
        client = Client(system.view.hub, wire, "robolink.v1", trusted=True, name="stuck")
        while not wire.aborted:
            client.say("x" * 100_000)
        assert wire.written <= MOST_UNREAD + 200_000
