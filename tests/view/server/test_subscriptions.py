"""Subscriptions of clients: channels, messages, batches, what is latched, and what comes and goes."""

from __future__ import annotations

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.serialization import deserialize_message, serialize_message
from robolink.view.channels import LARGEST
from tests.support.view_clients import shown, until

ALL = ["robolink.v1", "foxglove.sdk.v1", "foxglove.websocket.v1"]
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.mark.parametrize("subprotocol", ALL)
def test_a_message_reaches_a_client_of_each_subprotocol_as_it_was_sent(subprotocol: str) -> None:
    with shown() as system, system.client(subprotocol) as client:
        publisher = system.node.create_publisher(Twist, "cmd_vel", 10)
        channel = client.channel("/cmd_vel")
        subscription = client.subscribe("/cmd_vel")
        client.settle()
        twist = Twist()
        twist.linear.x = 0.25
        publisher.publish(twist)
        assert client.next(subscription) == serialize_message(twist)
        assert (channel["encoding"], channel["schemaEncoding"]) == ("cdr", "ros2msg")
        assert channel["schemaName"] == "geometry_msgs/msg/Twist"
        assert "MSG: geometry_msgs/Vector3" in channel["schema"]


@pytest.mark.parametrize("subprotocol", ALL)
def test_all_messages_come_in_their_order(subprotocol: str) -> None:
    with shown() as system, system.client(subprotocol) as client:
        publisher = system.node.create_publisher(Int32, "count", 10)
        subscription = client.subscribe("/count")
        client.settle()
        for number in range(200):
            publisher.publish(Int32(data=number))
        heard = [deserialize_message(client.next(subscription), Int32).data for _ in range(200)]
        assert heard == list(range(200))


def test_a_topic_that_comes_later_is_advertised_and_one_that_goes_is_taken_back() -> None:
    with shown() as system, system.client("foxglove.sdk.v1") as client:
        client.channel("/rosout")
        publisher = system.node.create_publisher(String, "chat", 10)
        number = client.channel("/chat")["id"]
        publisher.destroy()
        assert client.wait_for("unadvertise")["channelIds"] == [number]


def test_late_subscribers_get_the_last_message_of_each_latched_publisher() -> None:
    with shown() as system, system.client() as early:
        first = system.node.create_publisher(String, "map", LATCHED)
        second = system.node.create_publisher(String, "map", LATCHED)
        for text in ("old", "new"):
            first.publish(String(data=text))
        second.publish(String(data="other"))
        for _ in range(2):  # of one client, and once more
            subscription = early.subscribe("/map")
            texts = {deserialize_message(early.next(subscription), String).data for _ in range(2)}
            assert texts == {"new", "other"}
            early.send("unsubscribe", subscriptionIds=[subscription])
        with system.client("foxglove.websocket.v1") as late:
            subscription = late.subscribe("/map")
            texts = {deserialize_message(late.next(subscription), String).data for _ in range(2)}
            assert texts == {"new", "other"}
            second.destroy()
            first.publish(String(data="newest"))
            assert deserialize_message(late.next(subscription), String).data == "newest"
            channel = next(each for each in system.source.channels.values() if each.topic == "/map")
            until(lambda: len(system.source.retained(channel)) == 1)  # what has gone is forgotten
        with system.client() as last:
            subscription = last.subscribe("/map")
            assert deserialize_message(last.next(subscription), String).data == "newest"


def test_several_types_on_one_topic_are_one_channel_and_a_status() -> None:
    with shown() as system, system.client() as client:
        publisher = system.node.create_publisher(String, "mixed", 10)
        assert client.channel("/mixed")["schemaName"] == "std_msgs/msg/String"
        other = system.node.create_publisher(Int32, "mixed", 10)
        told = client.wait_for("status", id="types /mixed")
        assert "std_msgs/msg/String" in told["message"]
        assert "std_msgs/msg/Int32 by /robot" in told["message"]
        subscription = client.subscribe("/mixed")
        client.settle()
        other.publish(Int32(data=1))
        publisher.publish(String(data="mine"))
        assert deserialize_message(client.next(subscription), String).data == "mine"
        publisher.destroy()
        client.wait_for("unadvertise")
        while client.channel("/mixed")["schemaName"] == "std_msgs/msg/String":  # the old one, heard before
            client.heard = [each for each in client.heard if each["op"] != "advertise"]
        assert client.channel("/mixed")["schemaName"] == "std_msgs/msg/Int32"


def test_messages_that_are_too_large_are_told_and_the_channel_goes_on() -> None:
    with shown() as system, system.client() as client:
        publisher = system.node.create_publisher(String, "map", 10)
        subscription = client.subscribe("/map")
        client.settle()
        publisher.publish(String(data="x" * (LARGEST + 1)))
        told = client.wait_for("status", id="large /map")
        assert told["message"] == "/map: messages that are larger than 32 MiB are not shown"
        publisher.publish(String(data="small"))
        assert deserialize_message(client.next(subscription), String).data == "small"
        publisher.destroy()
        assert client.wait_for("removeStatus", statusIds=["large /map"])


def test_hidden_topics_are_for_the_page_only() -> None:
    with shown() as system, system.client() as page, system.client("foxglove.sdk.v1") as other:
        system.node.create_publisher(String, "dance/_action/feedback", 10)
        assert page.channel("/dance/_action/feedback")["hidden"]
        system.node.create_publisher(String, "seen", 10)
        other.channel("/seen")
        topics = {each["topic"] for told in other.heard if told["op"] == "advertise" for each in told["channels"]}
        assert "/dance/_action/feedback" not in topics
