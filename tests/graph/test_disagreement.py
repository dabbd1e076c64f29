"""Two ends of a topic or service that differ in type: both nodes say so, once."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from robolink import Context, Node, VirtualTime
from robolink.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from robolink.graph.endpoint import MOST_REPORTED
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.message import Message, type_hash
from robolink.message.annotations import float64, int32
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import EndpointKind, EndpointToken, format_token
from tests.support.transports import Network, until


class Thing(Message, type_name="lab_msgs/msg/Thing"):
    x: float64


class NewerThing(Message, type_name="lab_msgs/msg/Thing"):
    x: float64
    count: int32


def publish(node: Node, kind: type[Any], **options: Any) -> object:
    return node.create_publisher(kind, "topic", 10, **options)


def subscribe(node: Node, kind: type[Any], **options: Any) -> object:
    return node.create_subscription(kind, "topic", lambda _: None, 10, **options)


def serve(node: Node, kind: type[Any]) -> object:
    return node.create_service(kind, "topic", lambda _, response: response)


def call(node: Node, kind: type[Any]) -> object:
    return node.create_client(kind, "topic")


@pytest.fixture
def make_node(net: Network) -> Iterator[Callable[[str], Node]]:
    """Make nodes that each have a context, and a session, of their own."""
    contexts: list[Context] = []

    def make(name: str, domain: int = 0) -> Node:
        context = Context(transport=net.session())
        context.init([], domain_id=domain)
        contexts.append(context)
        return Node(name, context=context)

    yield make
    for context in contexts:
        context.try_shutdown()


def warnings(log_lines: list[Record], name: str) -> list[str]:
    return [each.message for each in log_lines if each.name == name and each.severity.name == "WARN"]


PAIRS = [(publish, Int32, subscribe, String), (serve, SetBool, call, Trigger)]
DOES = {publish: "publishes it", subscribe: "subscribes to it", serve: "serves it", call: "calls it"}


@pytest.mark.parametrize(("make_one", "one", "make_other", "other"), PAIRS + [(c, d, a, b) for a, b, c, d in PAIRS])
def test_both_nodes_are_told_once(
    make_node: Callable[..., Node],
    log_lines: list[Record],
    make_one: Callable[..., object],
    one: type[Any],
    make_other: Callable[..., object],
    other: type[Any],
) -> None:
    left, right = make_node("left"), make_node("right")
    make_one(left, one)
    make_other(right, other)
    make_other(right, other)
    until(lambda: bool(warnings(log_lines, "left") and warnings(log_lines, "right")))
    (there,) = warnings(log_lines, "left")
    assert there == (
        f"/topic: this node {DOES[make_one]} as {one.__ros_type__}, but /right {DOES[make_other]} as"
        f" {other.__ros_type__}: nothing gets from one to the other; give both the same type, or one of them another"
        " name"
    )
    (here,) = warnings(log_lines, "right")
    assert f"this node {DOES[make_other]} as {other.__ros_type__}, but /left {DOES[make_one]} as" in here


def test_two_definitions_of_one_type(make_node: Callable[..., Node], log_lines: list[Record]) -> None:
    left, right = make_node("left"), make_node("right")  # held: what nobody refers to leaves the graph
    publish(left, Thing)
    subscribe(right, NewerThing)
    until(lambda: bool(warnings(log_lines, "left") and warnings(log_lines, "right")))
    (text,) = warnings(log_lines, "left")
    assert text.startswith("/topic: this node publishes it as lab_msgs/msg/Thing, and so /right subscribes to it, but")
    assert f"({type_hash(Thing)[:15]}… here, {type_hash(NewerThing)[:15]}… there)" in text
    assert text.endswith("bring both to the same version of lab_msgs")


def test_it_is_on_rosout_of_a_node_that_never_spins(bus: Bus, context: Context) -> None:
    from robolink.executors import SingleThreadedExecutor
    from robolink.interfaces.rcl_interfaces.msg import Log
    from robolink.qos import qos_profile_rosout_default
    from tests.support.spins import spin_until

    left, right = Node("left", context=context), Node("right", context=context)
    publish(left, Int32)
    subscribe(right, String)
    got: list[tuple[str, int]] = []
    ear, executor = Node("ear", context=context), SingleThreadedExecutor(context=context)
    ear.create_subscription(
        Log, "/rosout", lambda line: got.append((line.name, line.level)), qos_profile_rosout_default
    )
    executor.add_node(ear)
    spin_until(executor, lambda: len(got) == 2)
    assert sorted(got) == [("left", 30), ("right", 30)]


def test_a_node_that_disagrees_with_itself_is_told_once(context: Context, log_lines: list[Record]) -> None:
    node = Node("both", context=context)
    publish(node, Int32)
    subscribe(node, String)
    (text,) = warnings(log_lines, "both")
    assert "but it also publishes it as std_msgs/msg/Int32" in text


def test_who_agrees_is_not_bothered(make_node: Callable[..., Node], log_lines: list[Record]) -> None:
    left, right, elsewhere = make_node("left"), make_node("right"), make_node("elsewhere", 7)
    publish(left, Int32)
    publish(right, String)  # no other end
    subscribe(elsewhere, String)  # another domain
    left.create_subscription(String, "topic/other", lambda _: None, 10)
    call(left, Trigger)  # a service may have a topic's name
    until(lambda: right.count_publishers("topic") == 2 and right.count_clients("topic") == 1)
    assert log_lines == []


def test_who_says_that_they_know_is_not_told(context: Context, log_lines: list[Record]) -> None:
    node = Node("node", context=context)
    publish(node, Int32, event_callbacks=PublisherEventCallbacks(use_default_callbacks=False))
    subscribe(node, String, event_callbacks=SubscriptionEventCallbacks(incompatible_type=print))
    assert log_lines == []


def test_a_crowd_does_not_drown_the_log(bus: Bus, context: Context, log_lines: list[Record]) -> None:
    node, crowd = Node("node", context=context), MemoryTransport(bus=bus)
    publisher = node.create_publisher(Int32, "topic", 10)
    token = publisher._endpoint.token._replace(
        kind=EndpointKind.SUBSCRIPTION, session=crowd.session_id, type_name="std_msgs/msg/String"
    )
    for number in range(3 * MOST_REPORTED):
        crowd.announce(format_token(token._replace(endpoint_id=str(number), node_name=f"n{number}")))
    told = warnings(log_lines, "node")
    assert len(told) == MOST_REPORTED
    assert told[-1].endswith("(no more of these are told)")
    assert publisher.get_subscription_count() == 0


def test_virtual_time_gives_the_same_log_every_time(log_lines: list[Record]) -> None:
    def run() -> list[Record]:
        log_lines.clear()
        bus = Bus()
        for name, make, kind in (("a", publish, Int32), ("b", subscribe, String), ("c", publish, Thing)):
            context = Context(transport=MemoryTransport(bus=bus), time=VirtualTime())
            context.init([])
            contexts.append(context)
            make(Node(name, context=context), kind)
        return [*log_lines]

    contexts: list[Context] = []
    first = run()
    assert len(first) == 4
    assert run() == first
    for context in contexts:
        context.shutdown()


def tokens_of(bus: Bus) -> Iterator[EndpointToken]:
    from robolink.wire import parse_token

    for token in map(parse_token, bus.tokens):
        if isinstance(token, EndpointToken):
            yield token


def test_tokens_are_numbered_by_one_counter_of_the_context(bus: Bus, context: Context) -> None:
    """Nodes and endpoints share it, as in rmw_zenoh."""
    for name in ("one", "two"):
        publish(Node(name, context=context), Int32)
    ids = [each.endpoint_id for each in tokens_of(bus)] + [each.node_id for each in context.graph.nodes()]
    assert sorted(map(int, ids)) == [*itertools.islice(itertools.count(), len(ids))]
