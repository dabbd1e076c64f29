"""Messages that their sender has overwritten in shared memory are never delivered, but counted and told once."""

from __future__ import annotations

from typing import Any

import pytest

from robolink import Context, Node
from robolink.event_handler import SubscriptionEventCallbacks
from robolink.exceptions import OverwrittenError, ServiceError
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import encode
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from robolink.transport.base import Query, Sample, Transport
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import pack_attachment
from tests.support.spins import spin_for

GONE = encode(Int32(data=-1))
"""A payload that is overwritten as soon as it was sent."""

GID = b"a" * 16


@pytest.fixture(autouse=True)
def _overwriting(monkeypatch: pytest.MonkeyPatch) -> None:
    read, accept = MemoryTransport.read, MemoryTransport.accept

    def read_if_intact(session: MemoryTransport, arrived: Any) -> Sample:
        sample = read(session, arrived)
        if sample.payload == GONE:
            raise OverwrittenError(sample.attachment)
        return sample

    def accept_if_intact(session: MemoryTransport, arrived: Any) -> Query:
        if arrived.payload == GONE:
            arrived.close()
            raise OverwrittenError
        return accept(session, arrived)

    monkeypatch.setattr(MemoryTransport, "read", read_if_intact)
    monkeypatch.setattr(MemoryTransport, "opener", Transport.opener)  # by `read`
    monkeypatch.setattr(MemoryTransport, "accept", accept_if_intact)


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    executor.add_node(made)
    return made


@pytest.mark.parametrize("listens", [True, False])
@pytest.mark.parametrize(
    "qos",
    [
        QoSProfile(depth=10),
        QoSProfile(history=HistoryPolicy.KEEP_ALL),
        QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    ],
    ids=["depth", "all", "latched"],
)
def test_an_overwritten_message_is_dropped_counted_and_told_once(
    bus: Bus, node: Node, executor: SingleThreadedExecutor, log_lines: list[Record], qos: QoSProfile, listens: bool
) -> None:
    got, lost = list[int](), list[Any]()
    events = SubscriptionEventCallbacks(message_lost=lost.append) if listens else None
    subscription = node.create_subscription(
        Int32, "topic", lambda message: got.append(message.data), qos, event_callbacks=events
    )
    outlet = MemoryTransport(bus=bus).advertise(subscription._endpoint.key, qos)
    for number, payload in enumerate([encode(Int32(data=1)), GONE, encode(Int32(data=3)), GONE], 1):
        outlet.put(payload, pack_attachment(number, 0, GID))
    spin_for(executor, 0.1)
    assert got == [1, 3]
    assert (subscription.lost, subscription.malformed, subscription.dropped) == (2, 0, 0)
    assert [each.total_count for each in lost[-1:]] == ([2] if listens else [])
    (warning,) = (each.message for each in log_lines)
    assert warning.startswith("/topic: dropped a message: its sender had overwritten it in shared memory")


@pytest.mark.parametrize("history", [HistoryPolicy.KEEP_LAST, HistoryPolicy.KEEP_ALL])
def test_what_is_missing_around_it_is_counted_too_and_nothing_twice(
    bus: Bus, node: Node, executor: SingleThreadedExecutor, history: HistoryPolicy
) -> None:
    lost, qos = list[Any](), QoSProfile(depth=10, history=history)
    subscription = node.create_subscription(
        Int32, "topic", lambda _: None, qos, event_callbacks=SubscriptionEventCallbacks(message_lost=lost.append)
    )
    outlet = MemoryTransport(bus=bus).advertise(subscription._endpoint.key, qos)
    for number in (1, 3, 6):  # 3 is overwritten; 2, 4 and 5 never come
        outlet.put(GONE if number == 3 else encode(Int32()), pack_attachment(number, 0, GID))
    spin_for(executor, 0.1)
    assert lost[-1].total_count == 4


def test_an_overwritten_request_ends_without_an_answer_and_an_overwritten_answer_is_an_error(
    bus: Bus, node: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    answered = list[Any]()
    service = node.create_service(SetBool, "switch", lambda *_: pytest.fail("it was called"))
    MemoryTransport(bus=bus).call(service._endpoint.key, GONE, b"", answered.append)
    spin_for(executor, 0.1)
    assert answered == [None]
    assert service.malformed == 1
    assert "overwritten it in shared memory" in log_lines[0].message

    client = node.create_client(SetBool, "strange")

    def reply(query: Any) -> None:
        query.reply(GONE, b"")
        query.close()

    MemoryTransport(bus=bus).serve(client._endpoint.key, reply)
    with pytest.raises(ServiceError, match="overwritten it in shared memory"):
        client.call(SetBool.Request())
