"""Every node says what the types that it uses are made of: ~/get_type_description."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robolink import Context, Node, Parameter
from robolink.exceptions import InvalidParameterTypeException
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor, ParameterType
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.interfaces.type_description_interfaces.srv import GetTypeDescription
from robolink.message import type_hash, type_name
from robolink.message.building import checked_class
from robolink.message.description import from_message
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import NO_HASH, EndpointKind
from tests.support.carts import Cart, Haul, Load, Wheel
from tests.support.spins import done, spin_for

NAME = "start_type_description_service"


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Iterator[Node]:
    """/lab/robot, spun with the asker's."""
    with Node("robot", context=virtual, namespace="lab") as made:
        executor.add_node(made)
        yield made


class Asker:
    """Asks /lab/robot."""

    def __init__(self, context: Context, executor: SingleThreadedExecutor) -> None:
        self.executor = executor
        self.node = Node("asker", context=context)
        executor.add_node(self.node)
        self.client = self.node.create_client(GetTypeDescription, "/lab/robot/get_type_description")

    def __call__(self, name: str = "", hash_: str = "", sources: bool = False) -> Any:
        request = GetTypeDescription.Request(type_name=name, type_hash=hash_, include_type_sources=sources)
        return done(self.executor, self.client.call_async(request))

    def about(self, cls: type[Any], sources: bool = False) -> Any:
        return self(type_name(cls), type_hash(cls), sources)


@pytest.fixture
def ask(virtual: Context, executor: SingleThreadedExecutor) -> Asker:
    return Asker(virtual, executor)


def test_every_node_serves_it_and_says_so_in_a_parameter(node: Node) -> None:
    assert ("/lab/robot/get_type_description", ["type_description_interfaces/srv/GetTypeDescription"]) in (
        node.get_service_names_and_types_by_node("robot", "/lab")
    )
    assert node.get_parameter(NAME).value is True
    described = node.describe_parameter(NAME)
    assert (described.type, described.read_only) == (ParameterType.PARAMETER_BOOL, True)
    assert not node.set_parameters([Parameter(NAME, value=False)])[0].successful


def test_a_node_that_is_told_so_does_not(virtual: Context) -> None:
    for told in (
        {"parameter_overrides": [Parameter(NAME, value=False)]},
        {"cli_args": ["--ros-args", "-p", f"{NAME}:=false"]},
    ):
        with Node("quiet", context=virtual, start_parameter_services=False, **told) as node:
            assert node.get_service_names_and_types_by_node("quiet", "/") == []
            assert node.get_parameter(NAME).value is False


def test_another_type_of_parameter_is_refused(virtual: Context, log_lines: list[Record]) -> None:
    with pytest.raises(InvalidParameterTypeException, match=NAME):
        Node("wrong", context=virtual, parameter_overrides=[Parameter(NAME, value="yes")])

    class Declares(Node):
        def _serve_(self, *args: Any) -> None:
            self.declare_parameter(NAME, "yes", ParameterDescriptor())
            super()._serve_(*args)

    with Declares("wrong", context=virtual, start_parameter_services=False) as node:
        assert node.get_service_names_and_types_by_node("wrong", "/") == []
    assert [each.message for each in log_lines] == [
        f"parameter {NAME}: expected a bool, got 'yes'; there is no ~/get_type_description"
    ]


def test_it_describes_the_types_of_publishers_and_subscriptions(node: Node, ask: Asker) -> None:
    node.create_publisher(Cart, "cart", 10)
    node.create_subscription(Twist, "cmd_vel", lambda _: None, 10)
    for cls in (Cart, Twist):
        answer = ask.about(cls)
        assert (answer.successful, answer.failure_reason, list(answer.type_sources)) == (True, "", [])
        made = checked_class(from_message(answer.type_description), type_hash(cls))
        assert made is not cls
        assert made.__ros_type__ == type_name(cls)
    assert ask(type_name(Cart)).successful  # by its name alone
    assert ask(type_name(Cart), NO_HASH).successful
    assert ask("who/cares", type_hash(Cart)).type_description.type_description.type_name == type_name(Cart)


def test_it_describes_services_actions_and_their_parts(node: Node, ask: Asker) -> None:
    node.create_service(Load, "load", lambda _, response: response)
    node.create_client(Haul.Impl.SendGoalService, "haul/_action/send_goal")
    parts = (Load, Load.Request, Load.Response, Load.Event, Haul, Haul.Goal, Haul.Impl.SendGoalService)
    for cls in parts:
        answer = ask.about(cls)
        made = checked_class(from_message(answer.type_description), type_hash(cls))
        assert (made.__ros_type__, type_hash(made)) == (type_name(cls), type_hash(cls))


def test_it_gives_the_sources(node: Node, ask: Asker) -> None:
    node.create_publisher(Cart, "cart", 10)
    node.create_service(Load, "load", lambda _, response: response)
    sources = ask.about(Cart, sources=True).type_sources
    assert [(each.type_name, each.encoding) for each in sources] == [
        (type_name(Cart), "msg"),
        (type_name(Wheel), "msg"),
    ]
    assert "Wheel[<=4] wheels" in sources[0].raw_file_contents
    assert "float64 radius 0.1" in sources[1].raw_file_contents
    found = {each.type_name.partition("/")[2]: each for each in ask.about(Load, sources=True).type_sources}
    assert next(iter(found)) == "srv/Load"
    assert (found["srv/Load"].encoding, "---" in found["srv/Load"].raw_file_contents) == ("srv", True)
    assert (found["srv/Load_Request"].encoding, found["srv/Load_Request"].raw_file_contents) == ("implicit", "")
    assert found["msg/Wheel"].encoding == found["msg/Time"].encoding == "msg"
    node.create_client(Haul.Impl.GetResultService, "haul/_action/get_result")
    kinds = {each.encoding for each in ask.about(Haul, sources=True).type_sources}
    assert kinds == {"action", "implicit", "msg"}


def test_it_does_not_describe_what_the_node_does_not_use(node: Node, ask: Asker) -> None:
    publisher = node.create_publisher(Cart, "cart", 10)
    for answer in (ask.about(Trigger), ask("sensor_msgs/msg/LaserScan"), ask("")):
        assert not answer.successful
        assert answer.failure_reason.startswith("this node does not use ")
    assert ask.about(Cart).successful
    node.destroy_publisher(publisher)
    assert not ask.about(Cart).successful


@pytest.mark.parametrize(
    "text", ["nonsense", "RIHS01_" + "g" * 64, "RIHS01_" + "0" * 63, "RIHS02_" + "0" * 64, "\u2028" * 5000]
)
def test_what_is_no_hash_is_refused(node: Node, ask: Asker, text: str) -> None:
    node.create_publisher(Cart, "cart", 10)
    answer = ask(type_name(Cart), text)
    assert not answer.successful
    assert answer.failure_reason.startswith("expected a type hash such as RIHS01_")


@pytest.mark.slow
@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary(max_size=100), st.binary(max_size=40))
def test_random_bytes_never_end_the_node(
    bus: Bus, node: Node, ask: Asker, log_lines: list[Record], payload: bytes, attachment: bytes
) -> None:
    session, answers = MemoryTransport(bus=bus), list[Any]()
    service = next(each for each in node.services if each.service_name == "/lab/robot/get_type_description")
    session.call(service._endpoint.key, payload, attachment, answers.append)
    spin_for(ask.executor, 0.01)
    assert answers[-1] is None
    assert len(log_lines) <= 1  # the rest is only counted
    assert ask.about(GetTypeDescription).successful
    session.close()


def test_a_busy_callback_does_not_keep_it_from_answering(node: Node, ask: Asker) -> None:
    answers: list[Any] = []

    def busy() -> None:
        timer.cancel()
        request = GetTypeDescription.Request(type_name=type_name(Cart))
        answers.append(ask.client.call(request, timeout_sec=30.0))

    node.create_publisher(Cart, "cart", 10)
    timer = node.create_timer(0.01, busy)
    spin_for(ask.executor, 0.1)
    assert [each.successful for each in answers] == [True]


def test_it_goes_with_the_node(virtual: Context) -> None:
    with Node("here", context=virtual) as node:
        assert len(virtual.graph.endpoints(EndpointKind.SERVICE)) == len(list(node.services)) > 0
    assert virtual.graph.endpoints(EndpointKind.SERVICE) == []
