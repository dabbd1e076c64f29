"""The graph, the time and the figures that clients get."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.std_msgs.msg import String
from robolink.view.server.connections import NOTHING, Picture, change
from tests.support.view_clients import shown


def named(entries: list[dict[str, Any]], name: str) -> dict[str, Any]:
    return next((each for each in entries if each["name"] == name), {})


@pytest.mark.parametrize("subprotocol", ["robolink.v1", "foxglove.sdk.v1", "foxglove.websocket.v1"])
def test_the_graph_and_its_changes(subprotocol: str) -> None:
    with shown() as system, system.client(subprotocol) as client:
        publisher = system.node.create_publisher(String, "chat", 10)
        system.node.create_subscription(String, "heard", print, 10)
        client.send("subscribeConnectionGraph")
        found: dict[str, Any] = {}
        while "/chat" not in found:
            update = client.wait_for("connectionGraphUpdate")
            found |= {each["name"]: each["publisherIds"] for each in update["publishedTopics"]}
        assert found["/chat"] == ["/robot"]
        assert named(update["subscribedTopics"], "/heard")["subscriberIds"] == ["/robot"]
        assert named(update["advertisedServices"], "/robot/get_parameters")["providerIds"] == ["/robot"]
        if subprotocol == "robolink.v1":
            assert named(update["subscribedTopics"], "/heard")["type"] == "std_msgs/msg/String"
            assert named(update["subscribedTopics"], "/heard")["qos"] == ["reliable volatile depth 10"]
            assert update["nodes"] == ["/robot"]
        publisher.destroy()
        update = client.wait_for("connectionGraphUpdate")
        assert update["removedTopics"] == ["/chat"]


def test_a_topic_that_changes_hands_is_not_removed() -> None:
    before = Picture({("/a", "T"): {"/n": ""}}, {}, {}, ["/n"])
    after = Picture({("/a", "T"): {"/m": ""}}, {}, {}, ["/m"])
    update = change(before, after, all_of_it=False)
    assert update is not None
    assert update["publishedTopics"] == [{"name": "/a", "publisherIds": ["/m"]}]
    assert update["removedTopics"] == []
    assert change(after, after, all_of_it=True) is None
    assert change(NOTHING, after, all_of_it=True) is not None


def test_clients_hear_the_time_of_clock() -> None:
    with shown() as system:
        clock = system.node.create_publisher(Clock, "/clock", 10)
        with system.client() as first:
            first.channel("/clock")
        with system.client("foxglove.websocket.v1") as client:
            assert "time" in client.wait_for("serverInfo")["capabilities"]
            message = Clock()
            message.clock.sec, message.clock.nanosec = 12, 5
            clock.publish(message)
            while not any(each == b"\x02" + (12 * 10**9 + 5).to_bytes(8, "little") for each in client.binary):
                client.listen()


def test_a_clock_that_comes_and_goes_later_is_told() -> None:
    with shown() as system, system.client("foxglove.sdk.v1") as client:
        first = client.wait_for("serverInfo")
        assert "time" not in first["capabilities"]
        clock = system.node.create_publisher(Clock, "/clock", 10)
        later = client.wait_for("serverInfo")
        assert "time" in later["capabilities"]
        assert later["sessionId"] == first["sessionId"]
        clock.destroy()
        assert "time" not in client.wait_for("serverInfo")["capabilities"]


def test_a_clock_of_another_type_is_none() -> None:
    with shown() as system, system.client("foxglove.sdk.v1") as client:
        clock = system.node.create_publisher(String, "/clock", 10)
        subscription = client.subscribe("/clock")
        client.settle()
        clock.publish(String(data="a text that is no time at all"))
        client.next(subscription)
        client.settle()
        assert not [each for each in client.binary if each[0] == 2]
        assert system.source.capabilities().count("time") == 0


@pytest.mark.slow
def test_statistics_of_topics_that_nobody_has_subscribed_to() -> None:
    with shown() as system, system.client() as client:
        publisher = system.node.create_publisher(String, "chat", 10)
        number = client.channel("/chat")["id"]
        client.send("subscribeStatistics")
        client.settle()
        told = client.wait_for("statistics")
        of_chat = next(each for each in told["topics"] if each["channelId"] == number)
        assert (of_chat["count"], of_chat["age"], of_chat["publishers"]) == (0, None, 1)
        publisher.publish(String(data="x"))
        while not of_chat["count"]:
            told = client.wait_for("statistics")
            of_chat = next(each for each in told["topics"] if each["channelId"] == number)
        assert of_chat["rate"] > 0
        assert of_chat["bandwidth"] > 0
        assert 0 <= of_chat["age"] < 10
        assert (of_chat["subscriptions"], told["server"]["clients"]) == (0, 1)
        assert {"cpu", "dropped"} <= told["server"].keys()
        client.send("unsubscribeStatistics")
        client.settle()
        assert not publisher.get_subscription_count()
