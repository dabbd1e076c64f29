"""The running system as a source: types that are not installed, many topics at once, and slow clients of it."""

from __future__ import annotations

import struct

import pytest

from robolink.interfaces.std_msgs.msg import Int32, UInt8MultiArray
from robolink.message import Message, encode, int32
from robolink.serialization import serialize_message
from robolink.view.sources import live
from tests.support.view_clients import shown, until


class Secret(Message):
    """A type that only the robot knows."""

    number: int32


def test_a_type_that_is_not_installed_is_asked_for_at_its_node() -> None:
    with shown() as system, system.spinning() as node, system.client("foxglove.sdk.v1") as client:
        publisher = node.create_publisher(Secret, "secret", 10)
        channel = client.channel("/secret")
        assert channel["schemaName"] == "test_live/msg/Secret"
        assert "int32 number" in channel["schema"]
        subscription = client.subscribe("/secret")
        client.settle()
        publisher.publish(Secret(number=7))
        assert client.next(subscription) == encode(Secret(number=7))


@pytest.mark.slow
def test_a_type_that_nobody_describes_is_told() -> None:
    with shown() as system, system.client() as client:  # nobody spins the node, so it does not answer
        system.node.create_publisher(Secret, "secret", 10)
        told = client.wait_for("status", id="type /secret")
        assert "test_live/msg/Secret, which is not installed" in told["message"]


def test_many_subscriptions_at_once_are_made_by_and_by(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live, "AT_ONCE", 1e-9)
    with shown() as system, system.client() as client:
        publishers = [system.node.create_publisher(Int32, f"t{number}", 10) for number in range(30)]
        numbers = [client.channel(f"/t{number}")["id"] for number in range(30)]
        client.send("subscribe", subscriptions=[{"id": each, "channelId": each} for each in numbers])
        client.send("unsubscribe", subscriptionIds=numbers[:10])
        client.settle()
        until(lambda: all(each.get_subscription_count() for each in publishers[10:]))
        for each in publishers:
            each.publish(Int32(data=3))
        assert {client.next(number) for number in numbers[10:]} == {serialize_message(Int32(data=3))}
        assert not any(each.get_subscription_count() for each in publishers[:10])


@pytest.mark.slow
@pytest.mark.parametrize("subprotocol", ["robolink.v1", "foxglove.websocket.v1"])
def test_a_client_that_stands_still_gets_the_newest_when_it_reads_again(subprotocol: str) -> None:
    most = 100
    with shown() as system, system.client(subprotocol, max_queue=1) as client:
        publisher = system.node.create_publisher(UInt8MultiArray, "image", 10)
        subscription = client.subscribe("/image")
        client.settle()
        channel = next(each for each in system.source.channels.values() if each.topic == "/image")
        for number in range(most):
            publisher.publish(UInt8MultiArray(data=struct.pack("<I", number) + bytes(1_000_000)))
            until(lambda number=number: channel.count > number)  # type: ignore[misc]
        numbers: list[int] = []
        while not numbers or numbers[-1] < most - 1:
            payload = client.next(subscription)
            numbers.append(struct.unpack_from("<I", payload, len(payload) - 1_000_004)[0])
        assert numbers == sorted(numbers)
        assert len(numbers) < most / 2
