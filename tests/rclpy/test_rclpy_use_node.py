"""What public programs use of nodes, publishers, subscriptions, services, timers and executors does as in rclpy."""

from __future__ import annotations

from typing import Any

import pytest

from robolink import Context, Node
from robolink.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import encode
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from robolink.qos_overriding_options import QoSOverridingOptions
from robolink.service_introspection import ServiceIntrospectionState
from robolink.transport.memory import Bus, MemoryTransport
from tests.support.rclpy_use import shows
from tests.support.spins import done, numbers, spin_for

Group = MutuallyExclusiveCallbackGroup | ReentrantCallbackGroup


@pytest.fixture
def node(executor: SingleThreadedExecutor) -> Node:
    made = Node("robot", namespace="/lab", context=executor.context)
    executor.add_node(made)
    return made


@pytest.fixture(params=[MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup])
def group(request: pytest.FixtureRequest) -> Group:
    made: Group = request.param()
    return made


def adder(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
    response.sum = request.a + request.b
    return response


# --- nodes ------------------------------------------------------------------------------------------------------------


@shows("Node.get_name", "Node.get_namespace", "Node.context", "Node.executor", "Node.get_logger", "Node.get_clock")
@shows("Node.__init__(namespace=)", "Node.__init__(node_name=)")
def test_a_node_knows_who_it_is_and_what_runs_it(executor: SingleThreadedExecutor) -> None:
    node = Node(node_name="robot", namespace="lab", context=executor.context)
    assert (node.get_name(), node.get_namespace(), node.executor) == ("robot", "/lab", None)
    executor.add_node(node)
    assert (node.executor, node.context) == (executor, executor.context)
    assert node.get_logger().name == "lab.robot"
    assert node.get_clock().now().nanoseconds == executor.context.time.now()


@shows("Node.get_node_names", "Node.get_node_names_and_namespaces", "Node.get_topic_names_and_types")
@shows("Node.get_service_names_and_types", "Node.count_publishers", "Node.count_subscribers")
@shows("Node.get_publishers_info_by_topic", "Node.publishers")
def test_a_node_sees_what_is_there(node: Node) -> None:
    quiet = Node("quiet", context=node.context, enable_rosout=False)
    publisher = quiet.create_publisher(String, "words", 10)
    node.create_subscription(String, "/words", print, 10)
    node.create_service(SetBool, "switch", lambda request, response: response)
    assert sorted(node.get_node_names()) == ["quiet", "robot"]
    assert ("robot", "/lab") in node.get_node_names_and_namespaces()
    assert ("/words", ["std_msgs/msg/String"]) in node.get_topic_names_and_types()
    assert ("/lab/switch", ["std_srvs/srv/SetBool"]) in node.get_service_names_and_types()
    assert (node.count_publishers("/words"), node.count_subscribers("/words")) == (1, 1)
    (info,) = node.get_publishers_info_by_topic("/words")
    assert (info.node_name, info.topic_type) == ("quiet", "std_msgs/msg/String")
    assert publisher in list(quiet.publishers)


@shows("Node.destroy_node", "Node.destroy_publisher", "Node.destroy_subscription", "Node.destroy_timer")
@shows("Node.destroy_service", "Node.destroy_client")
def test_what_is_destroyed_is_gone(node: Node) -> None:
    made = {
        node.destroy_publisher: node.create_publisher(Int32, "number", 10),
        node.destroy_subscription: node.create_subscription(Int32, "number", print, 10),
        node.destroy_timer: node.create_timer(1.0, print),
        node.destroy_service: node.create_service(AddTwoInts, "add", adder),
        node.destroy_client: node.create_client(AddTwoInts, "add"),
    }
    for destroy, entity in made.items():
        assert destroy(entity)  # type: ignore[operator]
        assert not destroy(entity)  # type: ignore[operator]
    assert node.count_publishers("/lab/number") == node.count_subscribers("/lab/number") == 0
    node.destroy_node()
    assert "robot" not in Node("other", context=node.context).get_node_names()


# --- publishers and subscriptions -------------------------------------------------------------------------------------


@shows("Node.create_publisher", "Node.create_subscription", "Publisher.publish", "Publisher.topic_name")
@shows("Publisher.get_subscription_count", "Subscription.topic_name", "Subscription.callback")
@shows("create_publisher(msg_type=)", "create_publisher(topic=)", "create_publisher(qos_profile=)")
@shows("create_subscription(msg_type=)", "create_subscription(topic=)", "create_subscription(qos_profile=)")
@shows("create_subscription(callback=)", "Publisher.assert_liveliness")
def test_a_message_goes_to_who_subscribes(executor: SingleThreadedExecutor, node: Node) -> None:
    got: list[Int32] = []
    publisher = node.create_publisher(msg_type=Int32, topic="number", qos_profile=QoSProfile(depth=3))
    subscription = node.create_subscription(
        msg_type=Int32, topic="number", callback=got.append, qos_profile=qos_profile_sensor_data
    )
    assert (publisher.topic_name, subscription.topic_name) == ("/lab/number", "/lab/number")
    assert publisher.get_subscription_count() == 1
    assert subscription.callback == got.append
    publisher.publish(Int32(data=7))
    publisher.assert_liveliness()
    assert got == []
    spin_for(executor, 0.1)
    assert got == [Int32(data=7)]


@shows("Publisher.destroy", "Subscription.destroy")
def test_publishers_and_subscriptions_end_themselves(node: Node) -> None:
    publisher, subscription = node.create_publisher(Int32, "a", 1), node.create_subscription(Int32, "a", print, 1)
    subscription.destroy()
    assert publisher.get_subscription_count() == 0
    publisher.destroy()
    assert node.count_publishers("/lab/a") == 0
    with pytest.raises(RuntimeError):
        publisher.publish(Int32())


@shows("create_subscription(raw=)")
def test_a_raw_subscription_gets_the_bytes(executor: SingleThreadedExecutor, node: Node) -> None:
    got: list[bytes] = []
    node.create_subscription(String, "words", got.append, 10, raw=True)
    node.create_publisher(String, "words", 10).publish(String(data="as they came"))
    spin_for(executor, 0.1)
    assert [bytes(each) for each in got] == [encode(String(data="as they came"))]


@shows("create_publisher(event_callbacks=)", "create_subscription(event_callbacks=)")
def test_both_ends_are_told_that_they_met(executor: SingleThreadedExecutor, node: Node) -> None:
    told: list[tuple[str, int]] = []
    node.create_publisher(
        Int32,
        "a",
        1,
        event_callbacks=PublisherEventCallbacks(matched=lambda each: told.append(("p", each.total_count))),
    )
    node.create_subscription(
        Int32,
        "a",
        print,
        1,
        event_callbacks=SubscriptionEventCallbacks(matched=lambda each: told.append(("s", each.total_count))),
    )
    spin_for(executor, 0.1)
    assert sorted(told) == [("p", 1), ("s", 1)]


@shows("create_publisher(qos_overriding_options=)", "create_subscription(qos_overriding_options=)")
def test_parameters_override_qos(bus: Bus) -> None:
    context = Context(transport=MemoryTransport(bus=bus))
    where = "qos_overrides./a"
    given = [f"{where}.publisher.depth:=7", f"{where}.subscription.reliability:=best_effort"]
    context.init(args=["--ros-args", *(word for each in given for word in ("-p", each))])
    with context:
        node, options = Node("node", context=context), QoSOverridingOptions.with_default_policies()
        publisher = node.create_publisher(Int32, "/a", 1, qos_overriding_options=options)
        subscription = node.create_subscription(Int32, "/a", print, 1, qos_overriding_options=options)
        assert node.get_parameter(f"{where}.publisher.depth").value == 7
        assert publisher.qos_profile.depth == 7
        assert subscription.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT


@shows("create_publisher(callback_group=)", "create_subscription(callback_group=)", "create_timer(callback_group=)")
@shows("create_service(callback_group=)", "create_client(callback_group=)")
def test_everything_can_be_put_into_a_group(node: Node, group: Group) -> None:
    node.create_publisher(Int32, "a", 1, callback_group=group)
    members: list[Any] = [
        node.create_subscription(Int32, "a", print, 1, callback_group=group),
        node.create_timer(1.0, print, callback_group=group),
        node.create_service(AddTwoInts, "add", adder, callback_group=group),
        node.create_client(AddTwoInts, "add", callback_group=group),
    ]
    assert all(group.has_entity(each) for each in members)
    assert all(each.callback_group is group for each in members[:3])  # an answer may come while the group is busy
    assert not group.has_entity(node.create_timer(1.0, print))


@shows("QoSProfile(depth=)", "QoSProfile(reliability=)", "QoSProfile(durability=)")
def test_who_comes_late_gets_what_a_latched_topic_kept(executor: SingleThreadedExecutor, node: Node) -> None:
    latched = QoSProfile(depth=2, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = node.create_publisher(Int32, "number", latched)
    for number in range(5):
        publisher.publish(Int32(data=number))
    got: list[int] = []
    node.create_subscription(Int32, "number", lambda each: got.append(each.data), latched)
    plain = numbers(node, "number")
    spin_for(executor, 0.1)
    assert (got, plain) == ([3, 4], [])


# --- services ---------------------------------------------------------------------------------------------------------


@shows("Node.create_service", "Node.create_client", "Client.call_async", "message.call_async", "Client.call")
@shows("Client.service_is_ready", "Client.wait_for_service", "wait_for_service(timeout_sec=)")
@shows("create_service(srv_type=)", "create_service(srv_name=)", "create_service(callback=)")
@shows("create_service(qos_profile=)", "create_client(srv_type=)", "create_client(srv_name=)")
@shows("message.Request", "message.Response")
def test_a_service_answers(executor: SingleThreadedExecutor, node: Node) -> None:
    client = node.create_client(srv_type=AddTwoInts, srv_name="add")
    assert not client.service_is_ready()
    assert not client.wait_for_service(timeout_sec=0.1)
    node.create_service(
        srv_type=AddTwoInts,
        srv_name="add",
        callback=adder,
        qos_profile=QoSProfile(depth=5),
        callback_group=ReentrantCallbackGroup(),
    )
    assert client.service_is_ready()
    assert client.wait_for_service(timeout_sec=1.0)
    assert done(executor, client.call_async(AddTwoInts.Request(a=1, b=2))) == AddTwoInts.Response(sum=3)
    answers: list[Any] = []
    node.create_timer(0.1, lambda: answers.append(client.call(AddTwoInts.Request(a=2, b=2))))
    spin_for(executor, 0.15)
    assert answers == [AddTwoInts.Response(sum=4)]


@shows("Client.destroy", "Service.destroy")
def test_services_and_clients_end_themselves(node: Node) -> None:
    service, client = node.create_service(AddTwoInts, "add", adder), node.create_client(AddTwoInts, "add")
    service.destroy()
    assert not client.service_is_ready()
    client.destroy()
    assert node.count_clients("/lab/add") == 0


@shows("Client.configure_introspection", "Service.configure_introspection")
def test_calls_can_be_watched(executor: SingleThreadedExecutor, node: Node) -> None:
    service, client = node.create_service(AddTwoInts, "add", adder), node.create_client(AddTwoInts, "add")
    events: list[Any] = []
    node.create_subscription(AddTwoInts.Event, "add/_service_event", events.append, 10)
    for each in (service, client):
        each.configure_introspection(node.get_clock(), QoSProfile(depth=10), ServiceIntrospectionState.CONTENTS)
    assert done(executor, client.call_async(AddTwoInts.Request(a=1, b=2))).sum == 3
    spin_for(executor, 0.1)
    kinds = {each.info.event_type: (list(each.request), list(each.response)) for each in events}
    assert sorted(kinds) == [0, 1, 2, 3]
    assert kinds[0] == kinds[1] == ([AddTwoInts.Request(a=1, b=2)], [])
    assert kinds[2] == kinds[3] == ([], [AddTwoInts.Response(sum=3)])
