"""The graph: nodes and endpoints that come and go, seen from nodes here and in other processes."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from robolink import Context, Node
from robolink.duration import Duration
from robolink.endpoint_info import EndpointTypeEnum
from robolink.exceptions import InvalidServiceNameException, NodeNameNonExistentError
from robolink.graph.graph import EVERY, Graph
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.message import type_hash
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    resolved,
)
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import EndpointKind, EndpointToken, NodeToken, format_token
from tests.support.programs import Program
from tests.support.transports import Network

PATIENCE = 30.0
HIDDEN = ("/rosout", "/parameter_events")


@pytest.fixture
def talker(context: Context) -> Node:
    node = Node("talker", namespace="/left", context=context)
    node.create_publisher(Int32, "count", 10)
    node.create_publisher(String, "/name", 10)
    node.create_service(Trigger, "~/reset", lambda _, response: response)
    return node


@pytest.fixture
def listener(context: Context) -> Node:
    node = Node("listener", context=context)
    node.create_subscription(Int32, "left/count", lambda _: None, 10)
    node.create_subscription(Int32, "/name", lambda _: None, 10)
    node.create_client(Trigger, "/left/talker/reset")
    return node


def test_nodes_are_listed(talker: Node, listener: Node) -> None:
    assert sorted(listener.get_node_names()) == ["listener", "talker"]
    assert sorted(listener.get_fully_qualified_node_names()) == ["/left/talker", "/listener"]
    assert set(talker.get_node_names_and_namespaces()) == {("talker", "/left"), ("listener", "/")}
    assert ("talker", "/left", "/") in listener.get_node_names_and_namespaces_with_enclaves()
    assert listener.wait_for_node("left/talker", timeout=0)
    assert not listener.wait_for_node("/talker", timeout=0)


def test_in_virtual_time_waiting_for_a_node_is_over_at_once(virtual: Context) -> None:
    node = Node("node", context=virtual)
    assert node.wait_for_node("/node", timeout=3600.0)
    assert virtual.time.now() == 0
    assert not node.wait_for_node("/other", timeout=3600.0)
    assert virtual.time.now() == 3600 * 10**9


def test_topics_and_services_are_listed_with_their_types(talker: Node, listener: Node) -> None:
    topics = [each for each in listener.get_topic_names_and_types() if each[0] not in HIDDEN]
    assert topics == [
        ("/left/count", ["std_msgs/msg/Int32"]),
        ("/name", ["std_msgs/msg/Int32", "std_msgs/msg/String"]),
    ]
    listener.create_client(Trigger, "/nobody_serves")
    for name in ("/left/talker/reset", "/nobody_serves"):
        assert (name, ["std_srvs/srv/Trigger"]) in listener.get_service_names_and_types()


def test_what_belongs_to_a_node(talker: Node, listener: Node) -> None:
    published = [name for name, _ in listener.get_publisher_names_and_types_by_node("talker", "/left")]
    assert published == ["/left/count", "/name", "/parameter_events", "/rosout"]
    subscribed = talker.get_subscriber_names_and_types_by_node("listener", "/")
    assert subscribed == [("/left/count", ["std_msgs/msg/Int32"]), ("/name", ["std_msgs/msg/Int32"])]
    with pytest.raises(NodeNameNonExistentError, match=r"no node named '/talker' \(did you mean '/left/talker'\?\)"):
        listener.get_publisher_names_and_types_by_node("talker", "/")
    reset = ("/left/talker/reset", ["std_srvs/srv/Trigger"])
    assert reset in listener.get_service_names_and_types_by_node("talker", "/left")
    assert listener.get_client_names_and_types_by_node("listener", "/") == [reset]


def test_endpoints_are_counted_by_resolved_names(talker: Node, listener: Node) -> None:
    assert talker.count_publishers("count") == listener.count_publishers("/left/count") == 1
    assert listener.count_publishers("count") == 0
    assert talker.count_subscribers("count") == 1
    assert talker.count_services("~/reset") == talker.count_clients("~/reset") == 1


def test_only_ends_of_the_same_type_meet(talker: Node, listener: Node) -> None:
    count, name = (each for each in talker.publishers if each.topic_name in ("/left/count", "/name"))
    assert (count.get_subscription_count(), name.get_subscription_count()) == (1, 0)
    assert [each.get_publisher_count() for each in listener.subscriptions] == [1, 0]


def test_what_is_destroyed_is_gone(talker: Node, listener: Node) -> None:
    publisher = next(iter(talker.publishers))
    assert listener.count_publishers(publisher.topic_name) >= 1
    for each in list(talker.publishers):
        talker.destroy_publisher(each)
    left = [name for name, _ in talker.get_publisher_names_and_types_by_node("talker", "/left")]
    assert left == ["/rosout"]
    talker.destroy_node()
    assert listener.get_node_names() == ["listener"]
    assert listener.count_services("/left/talker/reset") == 0


def test_an_endpoint_is_announced_when_it_is_there(bus: Bus, context: Context) -> None:
    """Whoever sees a subscription may publish at once, whoever sees a service may call."""
    early: list[str] = []

    def check(token: str, alive: bool) -> None:
        declared = {"MS": [*bus.subscriptions], "SS": [*bus.servers], "MP": [*bus.outlets]}
        for kind, keys in declared.items():
            if f"/{kind}/" in token and "%topic" in token and not any("/topic/" in key for key in keys):
                early.append(token)

    node = Node("node", context=context)
    MemoryTransport(bus=bus).watch("@ros2_lv/**", check)
    node.create_subscription(Int32, "topic", lambda _: None, 10)
    node.create_publisher(Int32, "topic", 10)
    node.create_service(Trigger, "topic", lambda _, response: response)
    assert early == []
    assert len([token for token in bus.tokens if "%topic" in token]) == 3


def test_waiting_for_a_change(bus: Bus, context: Context) -> None:
    graph = context.graph
    assert not graph.wait_for(lambda: bool(graph.nodes()), timeout=0.01)
    thread = threading.Timer(0.02, Node, ("late",), {"context": context})
    thread.start()
    assert graph.wait_for(lambda: bool(graph.nodes()), timeout=PATIENCE)
    thread.join(PATIENCE)


@pytest.mark.parametrize("by_node", ["publisher", "subscriber", "service", "client"])
def test_an_unknown_node_is_an_error(talker: Node, listener: Node, by_node: str) -> None:
    ask = getattr(listener, f"get_{by_node}_names_and_types_by_node")
    with pytest.raises(RuntimeError, match="no node named '/left/nobody'"):
        ask("nobody", "/left")
    talker.destroy_node()
    with pytest.raises(LookupError):
        ask("talker", "/left")


def test_who_publishes_and_who_subscribes(talker: Node, listener: Node) -> None:
    (publisher,) = talker.get_publishers_info_by_topic("count")
    (subscription,) = listener.get_subscriptions_info_by_topic("/left/count")
    assert (publisher.node_name, publisher.node_namespace) == ("talker", "/left")
    assert (subscription.node_name, subscription.node_namespace) == ("listener", "/")
    assert {publisher.topic_type, subscription.topic_type} == {"std_msgs/msg/Int32"}
    assert str(publisher.topic_type_hash) == str(subscription.topic_type_hash) == type_hash(Int32)
    assert publisher.endpoint_type is EndpointTypeEnum.PUBLISHER
    assert subscription.endpoint_type is EndpointTypeEnum.SUBSCRIPTION
    sender = talker.context.graph.endpoint_of(bytes(publisher.endpoint_gid))
    assert sender is not None
    assert sender.full_node_name == "/left/talker"
    assert publisher.qos_profile == resolved(QoSProfile(depth=10))
    publisher.qos_profile.depth = 3  # the caller's own
    assert talker.get_publishers_info_by_topic("count")[0].qos_profile.depth == 10
    assert talker.get_publishers_info_by_topic("/left/count", no_mangle=True) == [
        *talker.get_publishers_info_by_topic("count")
    ]
    assert talker.get_publishers_info_by_topic("count", no_mangle=True) == []
    assert listener.get_publishers_info_by_topic("count") == []


def test_who_serves_and_who_calls(talker: Node, listener: Node) -> None:
    talker.create_service(Trigger, "reset", lambda request, response: response)
    listener.create_client(Trigger, "/left/reset", qos_profile=QoSProfile(depth=3))
    (server,) = talker.get_servers_info_by_service("reset")
    (client,) = listener.get_clients_info_by_service("/left/reset")
    assert (server.node_name, server.node_namespace) == ("talker", "/left")
    assert (client.node_name, client.node_namespace) == ("listener", "/")
    assert {server.service_type, client.service_type} == {"std_srvs/srv/Trigger"}
    assert str(server.service_type_hash) == str(client.service_type_hash) == type_hash(Trigger)
    assert server.endpoint_type is EndpointTypeEnum.SERVER
    assert client.endpoint_type is EndpointTypeEnum.CLIENT
    assert (server.endpoint_count, client.endpoint_count) == (1, 1)
    served = talker.context.graph.endpoint_of(bytes(server.endpoint_gids[0]))
    assert served is not None
    assert served.full_node_name == "/left/talker"
    assert [each.depth for each in client.qos_profiles] == [3]
    assert talker.get_clients_info_by_service("/left/reset", no_mangle=True) == [client]
    assert talker.get_clients_info_by_service("reset", no_mangle=True) == []
    assert listener.get_servers_info_by_service("reset") == []
    with pytest.raises(InvalidServiceNameException):
        talker.get_servers_info_by_service("13")


def test_a_full_profile_is_told(talker: Node) -> None:
    qos = QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        depth=10,
        deadline=Duration(seconds=1, nanoseconds=12345),
        lifespan=Duration(seconds=20, nanoseconds=9887665),
        reliability=ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=5, nanoseconds=23456),
    )
    talker.create_publisher(Int32, "full", qos)
    assert talker.get_publishers_info_by_topic("full")[0].qos_profile == qos


@pytest.mark.parametrize("ask", ["get_publishers_info_by_topic", "get_subscriptions_info_by_topic"])
def test_a_bad_topic_name_is_refused(talker: Node, ask: str) -> None:
    with pytest.raises(TypeError):
        getattr(talker, ask)(1)
    with pytest.raises(ValueError, match="nvalid"):
        getattr(talker, ask)("13")


def test_a_followed_topic_tells_of_its_ends_of_that_kind_only(context: Context, talker: Node) -> None:
    told: list[tuple[str, bool]] = []

    def follow(gid: bytes, token: EndpointToken, alive: bool) -> None:
        told.append((f"{token.node_name} {token.kind.value}", alive))
        assert (context.graph.endpoint_of(gid) is not None) is alive

    handle = context.graph.follow("/name", EndpointKind.PUBLISHER, follow)
    assert told == [("talker MP", True)]
    late = Node("late", context=context)
    late.create_publisher(String, "/name", 10)
    late.create_publisher(Int32, "/other", 10)
    late.create_subscription(String, "/name", lambda _: None, 10)
    late.create_service(Trigger, "/name", lambda _, response: response)
    late.destroy_node()
    assert told[1:] == [("late MP", True), ("late MP", False)]
    handle.close()
    handle.close()
    talker.destroy_node()
    assert len(told) == 3


def test_every_topic_is_followed_at_once_those_there_first(context: Context, talker: Node) -> None:
    told: list[tuple[str, bool]] = []
    handle = context.graph.follow(
        EVERY, EndpointKind.PUBLISHER, lambda gid, token, alive: told.append((token.name, alive))
    )
    late = talker.create_publisher(Int32, "/late", 1)
    talker.destroy_publisher(late)
    handle.close()
    talker.create_publisher(Int32, "/later", 1)
    shown = [each for each in told if each[0] not in HIDDEN]
    assert shown == [("/left/count", True), ("/name", True), ("/late", True), ("/late", False)]


def test_a_follower_may_change_the_graph(context: Context, talker: Node) -> None:
    """What it does is told in its turn, not in between."""
    told: list[str] = []

    def answer(gid: bytes, token: EndpointToken, alive: bool) -> None:
        told.append(token.kind.value)
        if len(told) == 1:
            talker.create_publisher(String, "/name", 10)
            assert len(told) == 1

    context.graph.follow("/name", EndpointKind.PUBLISHER, answer)
    assert told == ["MP", "MP"]


def test_a_follower_that_fails_is_logged_and_the_others_are_told(
    context: Context, talker: Node, log_lines: list[Record]
) -> None:
    told: list[bool] = []

    def fail(gid: bytes, token: EndpointToken, alive: bool) -> None:
        raise KeyError("broken follower")

    context.graph.follow("/name", EndpointKind.PUBLISHER, fail)
    context.graph.follow("/name", EndpointKind.PUBLISHER, lambda gid, token, alive: told.append(alive))
    talker.destroy_node()
    assert told == [True, False]
    came, went = (each.message for each in log_lines)
    assert came == "whoever was told of /left/talker, which has /name and came, failed: KeyError: 'broken follower'"
    assert "and went, failed" in went


def test_what_is_closed_leaves_nothing_behind(bus: Bus, context: Context) -> None:
    graph = context.graph
    for number in range(20):
        with Node(f"node{number}", context=context) as node:
            node.create_publisher(String, f"topic{number}", 10)
            node.create_subscription(String, f"topic{number}", lambda _: None, 10)
            node.create_service(Trigger, f"service{number}", lambda _, response: response)
            node.create_client(Trigger, f"service{number}")
    index = graph._index
    assert [*index.tokens, *index.nodes, *index.endpoints, *index.by_place, *index.by_node] == []
    assert not graph._followers
    assert not graph._news
    assert not bus.tokens


def steps(ask: Callable[[], object]) -> int:
    """How many lines of Python this runs."""
    count = 0

    def trace(frame: FrameType, event: str, argument: object) -> Any:
        nonlocal count
        count += 1
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        ask()
    finally:
        sys.settrace(before)
    return count


def test_questions_are_cheap_in_a_big_system(bus: Bus, context: Context) -> None:
    """30 nodes, 200 topics, 2000 endpoints: a question about one topic does not look at the others."""
    crowd, node = MemoryTransport(bus=bus), Node("node", context=context)
    publisher = node.create_publisher(Int32, "/topic7", 10)
    token = publisher._endpoint.token._replace(kind=EndpointKind.SUBSCRIPTION, session=crowd.session_id)
    for number in range(2000):
        name, topic = f"node{number % 30}", f"/topic{number % 200}"
        crowd.announce(format_token(token._replace(endpoint_id=str(number), node_name=name, name=topic)))
    assert publisher.get_subscription_count() == 10
    assert steps(lambda: context.graph.count(EndpointKind.SUBSCRIPTION, "/topic7")) < 100
    assert steps(lambda: context.graph.nodes()) > 30, "the measure sees no loop"


def test_a_token_that_is_none_is_counted_and_told_once(bus: Bus, context: Context, log_lines: list[Record]) -> None:
    session = MemoryTransport(bus=bus)
    handle = session.announce("@ros2_lv/0/nonsense")
    graph = Graph(context.transport, 0)
    session.announce("@ros2_lv/0/" + "x" * 1_000_000)
    assert graph.malformed == 2
    handle.close()
    assert graph.malformed == 2
    assert graph.nodes() == []
    (line,) = log_lines
    assert line.name == "robolink.graph.graph"
    assert "somebody on domain 0 announces what cannot be read: a token has at least 9 fields, or 13" in line.message
    assert len(line.message) < 500


def test_nonsense_is_not_remembered(zenoh_net: Network) -> None:
    """A peer that announces it without end costs no memory."""
    graph, session = Graph(zenoh_net.session(), 0), zenoh_net.session()
    for number in range(50):
        session.announce(f"@ros2_lv/0/nonsense/{number}").close()
    session.announce("@ros2_lv/0/nonsense/last")
    node = NodeToken(0, session.session_id, "1", "/", "/", "real")
    session.announce(format_token(node))
    assert graph.wait_for(lambda: graph.nodes() == [node], timeout=PATIENCE)
    assert graph.malformed > 0
    assert graph._watch._changes.alive == {format_token(node)}  # type: ignore[attr-defined]


def test_own_announcements_are_known_at_once(zenoh_net: Network) -> None:
    """Also where the network takes a moment; and they come and go once."""
    context = Context(transport=zenoh_net.session())
    context.init([], domain_id=0)
    with context:
        told: list[bool] = []
        handle = context.graph.follow("/quick", EndpointKind.PUBLISHER, lambda gid, token, alive: told.append(alive))
        node = Node("node", context=context)
        for _ in range(5):
            publisher = node.create_publisher(Int32, "/quick", 10)
            assert node.count_publishers("/quick") == 1
            node.destroy_publisher(publisher)
            assert node.count_publishers("/quick") == 0
        other = zenoh_net.session()
        other.announce(format_token(NodeToken(0, other.session_id, "1", "/", "/", "real")))
        assert node.wait_for_node("/real", PATIENCE)  # by now the network has told of all that was before
        assert told == [True, False] * 5
        handle.close()


TALKER = """
    import sys
    import robolink as rclpy
    from robolink.interfaces.std_msgs.msg import Int32

    rclpy.init()
    node = rclpy.create_node("far")
    publisher = node.create_publisher(Int32, "far_topic", 10)
    print("ready")
    rclpy.spin(node)
"""


@pytest.mark.processes
def test_the_first_question_is_answered_in_full(tmp_path: Path, domain: int) -> None:
    """Also by a process that has only just come; and a node that was killed is seen to be gone."""
    with Program(tmp_path, TALKER, domain) as program:
        assert program.line() == "ready"
        context = Context()
        context.init([], domain_id=domain)
        with context:
            node = Node("near", context=context)
            assert set(node.get_node_names()) == {"far", "near"}
            assert node.count_publishers("/far_topic") == 1
            program.kill()
            graph = context.graph
            assert graph.wait_for(lambda: node.get_node_names() == ["near"], timeout=PATIENCE)
            assert graph.wait_for(lambda: not graph.endpoints(*EndpointKind, name="/far_topic"), timeout=PATIENCE)
