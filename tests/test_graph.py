"""The graph: nodes and endpoints that come and go, seen from nodes here and in other processes."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from robolink import Context, Node
from robolink.graph import Graph
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import EndpointKind
from tests.programs import Program

PATIENCE = 5.0
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


def test_topics_and_services_are_listed_with_their_types(talker: Node, listener: Node) -> None:
    topics = [each for each in listener.get_topic_names_and_types() if each[0] not in HIDDEN]
    assert topics == [
        ("/left/count", ["std_msgs/msg/Int32"]),
        ("/name", ["std_msgs/msg/Int32", "std_msgs/msg/String"]),
    ]
    assert ("/left/talker/reset", ["std_srvs/srv/Trigger"]) in listener.get_service_names_and_types()


def test_what_belongs_to_a_node(talker: Node, listener: Node) -> None:
    published = [name for name, _ in listener.get_publisher_names_and_types_by_node("talker", "/left")]
    assert published == ["/left/count", "/name", "/parameter_events", "/rosout"]
    assert listener.get_publisher_names_and_types_by_node("talker", "/") == []
    subscribed = talker.get_subscriber_names_and_types_by_node("listener", "/")
    assert subscribed == [("/left/count", ["std_msgs/msg/Int32"]), ("/name", ["std_msgs/msg/Int32"])]
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
    graph, seen = context.graph, threading.Event()
    graph.listen(seen.set)
    assert not graph.wait_for(lambda: bool(graph.nodes()), timeout=0.01)
    thread = threading.Timer(0.02, Node, ("late",), {"context": context})
    thread.start()
    assert graph.wait_for(lambda: bool(graph.nodes()), timeout=PATIENCE)
    thread.join(PATIENCE)
    assert seen.is_set()


def test_a_token_that_is_none_is_counted(bus: Bus, context: Context) -> None:
    session = MemoryTransport(bus=bus)
    handle = session.announce("@ros2_lv/0/nonsense")
    graph = Graph(context.transport, 0)
    assert graph.malformed == {"@ros2_lv/0/nonsense"}
    handle.close()
    assert graph.nodes() == []


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
            gone = context.graph.wait_for(lambda: node.get_node_names() == ["near"], timeout=PATIENCE)
            assert gone
            assert context.graph.endpoints(EndpointKind.PUBLISHER, name="/far_topic") == []
