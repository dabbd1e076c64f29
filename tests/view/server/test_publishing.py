"""Publishing by clients: who may, what is refused, and the zeros that stop what a client drove."""

from __future__ import annotations

import json
from typing import Any

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped
from robolink.serialization import deserialize_message, serialize_message
from robolink.view.server import publishing
from robolink.view.server.publishing import moves, stop_of
from tests.support.view_clients import Client, Shown, shown, until

STOPS_WITHIN = 0.3


class Listener:
    """Commands to the robot on a topic."""

    def __init__(self, system: Shown, cls: type[Any] = Twist, topic: str = "/cmd_vel") -> None:
        self.heard: list[Any] = []
        system.node.create_subscription(cls, topic, self.heard.append, 10)


def forward(cls: type[Any] = Twist, speed: float = 0.5) -> bytes:
    message = cls()
    (message.twist if cls is TwistStamped else message).linear.x = speed
    return serialize_message(message)


def advertise(client: Client, cls: type[Any] = Twist, **more: Any) -> None:
    channel = {"id": 1, "topic": "/cmd_vel", "encoding": "cdr", "schemaName": cls.__ros_type__, **more}
    client.send("advertise", channels=[channel])


@pytest.mark.parametrize("subprotocol", ["robolink.v1", "foxglove.sdk.v1", "foxglove.websocket.v1"])
@pytest.mark.parametrize("cls", [Twist, TwistStamped])
@pytest.mark.parametrize("leave", ["close", "cut"])
def test_a_closed_socket_stops_the_robot(subprotocol: str, cls: type[Any], leave: str) -> None:
    with shown() as system, system.spinning():
        robot = Listener(system, cls)
        with system.client(subprotocol) as client:
            advertise(client, cls)
            client.publish(1, forward(cls))
            until(lambda: len(robot.heard) == 1)
            assert moves(robot.heard[0])
            if leave == "cut":
                client.socket.socket.close()
        assert until(lambda: len(robot.heard) == 2) < STOPS_WITHIN
        assert not moves(robot.heard[1])


def test_a_stalled_page_stops_the_robot_and_only_once() -> None:
    with shown() as system, system.spinning(), system.client() as client:
        robot = Listener(system)
        advertise(client, stopAfter=0.1)
        client.publish(1, forward())
        until(lambda: len(robot.heard) >= 1)
        assert until(lambda: len(robot.heard) >= 2) < STOPS_WITHIN
        client.send("unadvertise", channelIds=[1])
        advertise(client, stopAfter=3600)  # so that only what follows stops it
        client.publish(1, forward(speed=0.1))
        client.publish(1, serialize_message(Twist()))
        client.send("unadvertise", channelIds=[1])
        client.settle()
        until(lambda: len(robot.heard) >= 4)
        assert [moves(each) for each in robot.heard] == [True, False, True, False]


def test_a_client_that_says_no_time_and_stalls_stops_the_robot_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(publishing, "STOP_AFTER", 0.1)
    with shown() as system, system.spinning(), system.client() as client:
        robot = Listener(system)
        advertise(client)
        client.publish(1, forward())
        until(lambda: len(robot.heard) >= 2)
        assert [moves(each) for each in robot.heard] == [True, False]


def test_a_server_that_ends_stops_the_robots() -> None:
    with shown() as system, system.spinning(), system.client("foxglove.sdk.v1") as client:
        robot = Listener(system)
        advertise(client)
        client.publish(1, forward())
        until(lambda: len(robot.heard) == 1)
        system.view.close()
        until(lambda: len(robot.heard) == 2, STOPS_WITHIN)
        assert not moves(robot.heard[1])


def test_zeros_keep_the_frame_and_have_the_time() -> None:
    last = TwistStamped()
    last.header.frame_id = "base"
    last.twist.angular.z = 1.0
    stopped = stop_of(last, 5_000_000_007)
    assert (stopped.header.frame_id, stopped.header.stamp.sec, stopped.header.stamp.nanosec) == ("base", 5, 7)
    assert not moves(stopped)


def test_messages_in_json() -> None:
    with shown() as system, system.spinning(), system.client("foxglove.websocket.v1") as client:
        robot = Listener(system)
        advertise(client, encoding="json", schemaName="geometry_msgs/Twist")
        client.publish(1, json.dumps({"linear": {"x": 0.5}}).encode())
        until(lambda: len(robot.heard) == 1)
        assert robot.heard[0].linear.x == 0.5


@pytest.mark.parametrize("settings", [{"read_only": True}, {}])
def test_nothing_is_published_without_the_token_or_where_it_is_read_only(settings: dict[str, Any]) -> None:
    with shown(**settings) as system, system.spinning(), system.client(token=bool(settings)) as client:
        robot = Listener(system)
        advertise(client)
        assert "read-only" in client.wait_for("status")["message"]
        client.publish(1, forward())
        assert "read-only" in client.wait_for("status")["message"]
        client.send("setParameters", parameters=[{"name": "/robot.x", "value": 1}])
        assert "read-only" in client.wait_for("status")["message"]
        with pytest.raises(RuntimeError, match="read-only"):
            client.call("/robot/list_parameters", b"")
        assert robot.heard == []
        assert system.node.count_publishers("/cmd_vel") == 0


@pytest.mark.parametrize(
    ("channel", "why"),
    [
        ({"schemaName": "no_msgs/msg/Thing"}, "no_msgs"),
        ({"schemaName": ""}, "type name"),
        ({"topic": "/not a name"}, "not a name"),
        ({"encoding": "protobuf"}, "expected cdr or json"),
        ({"stopAfter": 0}, "advertise: Expected `float` > 0"),
    ],
)
def test_a_channel_that_cannot_be_is_refused_and_the_others_are_not(channel: dict[str, Any], why: str) -> None:
    with shown() as system, system.client() as client:
        advertise(client, **channel)
        assert why in client.wait_for("status", level=2)["message"]
        client.publish(1, forward())
        assert "channel 1, which was not advertised" in client.wait_for("status")["message"]


@pytest.mark.parametrize("payload", [b"", b"\x00\x01\x00\x00", b"\x07\x07\x07\x07" + bytes(48), b"\x07" * 1000])
def test_nonsense_never_reaches_a_robot(payload: bytes) -> None:
    with shown() as system, system.spinning(), system.client() as client:
        robot = Listener(system)
        advertise(client)
        client.publish(1, payload)
        client.publish(1, forward())
        until(lambda: bool(robot.heard))
        assert robot.heard == [deserialize_message(forward(), Twist)]
