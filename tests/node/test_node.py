"""Nodes: names and remapping, what they own and destroy, parameters at the start."""

from __future__ import annotations

import gc
import pickle
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node, Parameter
from robolink.arguments.command_line import InvalidROSArgsError
from robolink.exceptions import (
    InvalidHandle,
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    MessageError,
    NotInitializedException,
)
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.text.tracebacks import formatted
from robolink.transport.memory import Bus, MemoryTransport
from tests.support.spins import spin_for


@pytest.fixture
def node(context: Context) -> Node:
    return Node("node", namespace="/left", context=context)


@pytest.mark.parametrize(
    ("namespace", "full"), [(None, "/node"), ("", "/node"), ("/", "/node"), ("arm", "/arm/node"), ("/a/b", "/a/b/node")]
)
def test_a_name_in_a_namespace(context: Context, namespace: str | None, full: str) -> None:
    node = Node("node", namespace=namespace, context=context)
    assert node.get_fully_qualified_name() == full
    assert node.get_name() == "node"
    assert node.get_namespace() == full.rpartition("/")[0] or "/"
    assert node.get_logger().name == full.strip("/").replace("/", ".")
    assert node.context is context


def test_bad_names_leave_nothing_behind(bus: Bus, context: Context) -> None:
    with pytest.raises(InvalidNodeNameException, match=r"\^"):
        Node("no spaces", context=context)
    with pytest.raises(InvalidNamespaceException):
        Node("node", namespace="no spaces", context=context)
    with pytest.raises(InvalidROSArgsError, match="'1st'"):
        Node("node", cli_args=["--ros-args", "-r", "__node:=1st"], context=context)
    assert not bus.tokens


def test_a_node_that_has_not_called_its_base_class_is_told_to(context: Context) -> None:
    class Early(Node):
        def __init__(self) -> None:
            self.create_publisher(Int32, "count", 10)
            super().__init__("early", context=context)

    class Never(Node):
        def __init__(self) -> None:
            pass

    report = r"call super\(\).__init__\('NAME'\) first"
    with pytest.raises(AttributeError, match=f"Early is not a node yet: {report}") as caught:
        Early()
    assert formatted(caught.value).endswith("first")  # and advises no name that the caller has not written
    executor = SingleThreadedExecutor(context=context)
    with pytest.raises(AttributeError, match=f"Never is not a node yet: {report}"):
        executor.add_node(Never())
    with pytest.raises(AttributeError, match="'Node' object has no attribute '_create'"):
        getattr(Node("made", context=context), "_create")  # noqa: B009 - mypy would see it


def test_a_type_where_the_name_should_be_is_told(node: Node) -> None:
    name: Any = "count"
    kind: Any = Int32
    with pytest.raises(TypeError, match=r"the name must be a str, not <class .*Int32'> \(the type comes first\)"):
        node.create_publisher(name, kind, 10)
    with pytest.raises(TypeError, match=r"the name must be a str, not 3$"):
        node.create_client(Trigger, 3)  # type: ignore[arg-type]


def test_a_forgotten_argument_is_one_of_nodes(node: Node) -> None:
    with pytest.raises(TypeError, match=r"^Node\.create_subscription\(\) missing .* 'callback' and 'qos_profile'"):
        node.create_subscription(Int32, "topic")  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"^BaseNode\.get_parameter\(\) missing .* 'name'"):
        node.get_parameter()  # type: ignore[call-arg]
    assert pickle.loads(pickle.dumps(Node.create_timer)) is Node.create_timer


def test_bad_topics_services_and_types_leave_nothing_behind(bus: Bus, node: Node) -> None:
    before = set(bus.tokens)
    with pytest.raises(InvalidTopicNameException):
        node.create_publisher(Int32, "no spaces", 10)
    with pytest.raises(InvalidTopicNameException):
        node.create_subscription(Int32, "no spaces", lambda _: None, 10)
    with pytest.raises(InvalidServiceNameException):
        node.create_service(Trigger, "no spaces", lambda _, response: response)
    with pytest.raises(MessageError):
        node.create_publisher(int, "topic", 10)  # type: ignore[type-var] # what is tested
    with pytest.raises(MessageError):
        node.create_client(Int32, "service")
    assert set(bus.tokens) == before


def test_a_constructor_that_fails_leaves_nothing_behind(bus: Bus, context: Context) -> None:
    with pytest.raises(TypeError, match="use_sim_time"):
        Node("node", context=context, parameter_overrides=[Parameter("use_sim_time", value="soon")])
    assert not bus.tokens
    assert not list(context._nodes)


def test_names_are_resolved_against_the_node(node: Node) -> None:
    assert node.resolve_topic_name("scan") == "/left/scan"
    assert node.resolve_topic_name("/scan") == "/scan"
    assert node.resolve_topic_name("~/scan") == "/left/node/scan"
    assert node.resolve_service_name("~/reset") == "/left/node/reset"


def test_remapping_reaches_names_topics_and_services(context: Context) -> None:
    arguments = "--ros-args -r __node:=other -r __ns:=/right -r scan:=laser -r reset:=again -p speed:=2.5"
    node = Node("node", namespace="/left", context=context, cli_args=arguments.split())
    assert node.get_fully_qualified_name() == "/right/other"
    assert node.create_publisher(Int32, "scan", 10).topic_name == "/right/laser"
    assert node.create_client(Trigger, "reset").service_name == "/right/again"
    assert node.resolve_topic_name("scan", only_expand=True) == "/right/scan"
    assert node.declare_parameter("speed", 1.0).value == 2.5


def test_global_arguments_count_unless_refused(bus: Bus) -> None:
    context = Context(transport=MemoryTransport(bus=bus))
    context.init(["--ros-args", "-r", "__node:=renamed"])
    with context:
        assert Node("node", context=context).get_name() == "renamed"
        assert Node("node", context=context, use_global_arguments=False).get_name() == "node"


def test_overrides_in_code_win_over_the_command_line(context: Context, tmp_path: Path) -> None:
    arguments = ["--ros-args", "-p", "a:=1", "-p", "b:=2"]
    overrides = [Parameter("b", value=3)]
    node = Node(
        "node",
        context=context,
        cli_args=arguments,
        parameter_overrides=overrides,
        automatically_declare_parameters_from_overrides=True,
    )
    assert (node.get_parameter("a").value, node.get_parameter("b").value) == (1, 3)
    plain = Node("plain", context=context, cli_args=arguments)
    assert not plain.has_parameter("a")


def test_it_knows_what_it_has(node: Node) -> None:
    publisher = node.create_publisher(Int32, "topic", 10)
    subscription = node.create_subscription(Int32, "topic", lambda _: None, 10)
    client = node.create_client(Trigger, "reset")
    service = node.create_service(Trigger, "reset", lambda _, response: response)
    timer = node.create_timer(1.0, lambda: None)
    guard = node.create_guard_condition(lambda: None)
    assert publisher in node.publishers
    assert service in node.services
    assert [*node.subscriptions, *node.clients] == [subscription, client]
    assert ([*node.timers], [*node.guards]) == ([timer], [guard])
    assert set(node._entity_store_.entities()) == {*node.services, subscription, client, service, timer, guard}
    assert node.default_callback_group.has_entity(timer)
    assert node.destroy_client(client)
    assert node.destroy_service(service)
    assert node.destroy_guard_condition(guard)
    assert node.destroy_timer(timer)
    assert node._entity_store_.entities() == [subscription, *node.services]


def test_each_public_method_is_defined_by_node_or_its_base() -> None:
    names = [name for name in dir(Node) if not name.startswith("_") and callable(getattr(Node, name))]
    assert len(names) > 60
    found = {(each.__module__, each.__qualname__) for each in (getattr(Node, name) for name in names)}
    own = {("robolink.node", f"{'Node' if name in vars(Node) else 'BaseNode'}.{name}") for name in names}
    assert found == own


def test_a_subclass_that_uses_rclpys_private_names_breaks_nothing(context: Context) -> None:
    class Own(Node):
        def __init__(self) -> None:
            self._parameters: Any = {"mine": 1}
            super().__init__("own", context=context)
            self._publishers = self._timers = self._subscriptions = {}  # type: ignore[assignment]

    with Own() as node:
        publisher, timer = node.create_publisher(Int32, "topic", 1), node.create_timer(1.0, print)
        assert node.declare_parameter("speed", 2).value == node.get_parameter("speed").value == 2
        assert (publisher in node.publishers, [*node.timers], node._parameters) == (True, [timer], {"mine": 1})
        assert node.destroy_timer(timer)
    with Node("other", context=context) as other:
        other.declare_parameter("speed", 2)
        assert other._parameters["speed"].value == 2
        assert other._descriptors["speed"].name == "speed"
        other._allow_undeclared_parameters = True
        assert other.get_parameter("more").value is None


def test_nothing_is_left_in_a_node_of_what_it_has_destroyed(node: Node) -> None:
    before = len(node.default_callback_group.entities)
    for number in range(3):
        assert node.destroy_publisher(node.create_publisher(Int32, f"topic{number}", 10))
        assert node.destroy_subscription(node.create_subscription(Int32, f"topic{number}", lambda _: None, 10))
        assert node.destroy_service(node.create_service(Trigger, "reset", lambda _, response: response))
        assert node.destroy_client(node.create_client(Trigger, "reset"))
        assert node.destroy_timer(node.create_timer(1.0, lambda: None))
    gc.collect()
    assert len(node.default_callback_group.entities) == before


def test_destroying_a_node_takes_it_from_the_network_and_the_executor(bus: Bus, node: Node) -> None:
    with SingleThreadedExecutor(context=node.context) as executor:
        executor.add_node(node)
        node.create_subscription(Int32, "topic", lambda _: None, 10)
        node.create_service(Trigger, "reset", lambda _, response: response)
        node.create_client(Trigger, "reset")
        node.create_timer(0.1, lambda: None)
        node.create_guard_condition(lambda: None)
        node.destroy_node()
        node.destroy_node()
        assert executor.get_nodes() == []
    assert not bus.tokens
    assert not bus.subscriptions
    assert not bus.servers
    assert node.executor is None


def test_a_node_is_a_context_manager(bus: Bus, context: Context) -> None:
    with Node("node", context=context) as node:
        assert node.get_name() == "node"
        assert bus.tokens
    assert not bus.tokens


def test_a_node_needs_a_context_that_is_ok(context: Context) -> None:
    context.shutdown()
    with pytest.raises(NotInitializedException, match="cannot create node"):
        Node("node", context=context)


@pytest.mark.usefixtures("known_as_robolink")
def test_what_the_end_of_the_context_destroyed_says_so(context: Context) -> None:
    node = Node("node", context=context)
    publisher, client = node.create_publisher(Int32, "topic", 10), node.create_client(Trigger, "service")
    timer, guard = node.create_timer(1.0, print), node.create_guard_condition(print)
    client.destroy()
    with pytest.raises(InvalidHandle, match=r"^the client of /service has been destroyed$"):
        client.call_async(Trigger.Request())
    context.shutdown()
    for use in (
        lambda: publisher.publish(Int32()),
        lambda: client.call_async(Trigger.Request()),
        timer.reset,
        guard.trigger,
        node.handle.__enter__,
        lambda: node.create_timer(1.0, print),
    ):
        with pytest.raises(InvalidHandle, match=r"has been destroyed: robolink\.shutdown\(\) ends all that nodes"):
            use()
    with pytest.raises(NotInitializedException, match=r"^robolink\.shutdown\(\) has ended the context$"):
        node.create_publisher(Int32, "other", 10)
    with pytest.raises(NotInitializedException, match=r"^robolink\.shutdown\(\) has ended the context: cannot create"):
        Node("late", context=context)


def test_a_node_that_comes_after_a_signal_is_told_so(context: Context) -> None:
    context.interrupt()
    with pytest.raises(NotInitializedException, match=r"^a signal \(Ctrl-C or SIGTERM\) has ended the context: cannot"):
        Node("late", context=context)


def test_entities_made_while_spinning_are_spun(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node, trace = Node("node", context=virtual), list[str]()
    executor.add_node(node)

    def grow() -> None:
        first.cancel()
        node.create_subscription(Int32, "topic", lambda _: trace.append("subscription"), 10)
        node.create_publisher(Int32, "topic", 10).publish(Int32())
        node.create_timer(0.1, lambda: trace.append("timer")).timer_period_ns = 10**9
        node.create_guard_condition(lambda: trace.append("guard")).trigger()

    first = node.create_timer(0.1, grow)
    spin_for(executor, 0.3)
    assert sorted(trace) == ["guard", "subscription", "timer"]


def test_a_guard_condition_runs_once_however_often_it_is_triggered(
    virtual: Context, executor: SingleThreadedExecutor
) -> None:
    node, runs = Node("node", context=virtual), list[int]()
    guard = node.create_guard_condition(lambda: runs.append(1))
    guard.trigger()
    executor.add_node(node)
    guard.trigger()
    guard.trigger()
    spin_for(executor, 0.1)
    assert runs == [1]
    guard.trigger()
    spin_for(executor, 0.1)
    assert runs == [1, 1]
    guard.destroy()
    with pytest.raises(RuntimeError, match="destroyed"):
        guard.trigger()


def test_nodes_of_a_user_are_subclasses(context: Context) -> None:
    class Talker(Node):
        def __init__(self) -> None:
            super().__init__("talker", context=context)
            self.publisher = self.create_publisher(Int32, "topic", 10)

    talker = Talker()
    assert talker.publisher.topic_name == "/topic"
    talker.destroy_node()
    del talker
    gc.collect()
    assert not list(context._nodes)
