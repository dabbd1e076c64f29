"""AsyncParameterClient and ParameterEventHandler: another node's parameters, asked for, set and heard of."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node, Parameter
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor, ParameterEvent
from robolink.parameter import parameter_value_to_python
from robolink.parameter_client import AsyncParameterClient
from robolink.parameter_event_handler import ParameterEventHandler
from tests.support.spins import done, spin_for

FILE = """
/**: {ros__parameters: {speed: 2.5}}
/lab/robot: {ros__parameters: {arm: {length: 3}}}
"""


@pytest.fixture
def robot(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    node = Node("robot", namespace="/lab", context=virtual)
    node.declare_parameter("speed", 0.5)
    node.declare_parameter("arm.length", 1)
    node.declare_parameter("free", 1, ParameterDescriptor(dynamic_typing=True))
    executor.add_node(node)
    return node


@pytest.fixture
def asker(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    node = Node("asker", namespace="/lab", context=virtual)
    executor.add_node(node)
    return node


@pytest.fixture
def client(robot: Node, asker: Node) -> AsyncParameterClient:
    return AsyncParameterClient(asker, "robot")


def test_it_knows_whether_the_services_are_there(asker: Node, client: AsyncParameterClient) -> None:
    assert client.services_are_ready()
    assert client.wait_for_services(1.0)
    nobody = AsyncParameterClient(asker, "/nobody")
    assert not nobody.services_are_ready()
    assert not nobody.wait_for_services(0.01)


def test_it_reads(client: AsyncParameterClient, executor: SingleThreadedExecutor) -> None:
    values = done(executor, client.get_parameters(["speed", "arm.length"])).values
    assert [parameter_value_to_python(each) for each in values] == [0.5, 1]
    assert list(done(executor, client.get_parameter_types(["speed"])).types) == [Parameter.Type.DOUBLE]
    assert done(executor, client.describe_parameters(["free"])).descriptors[0].dynamic_typing
    assert done(executor, client.list_parameters(["arm"], 1)).result.names == ["arm.length"]
    assert {"speed", "free"} < set(done(executor, client.list_parameters()).result.names)


def test_it_sets_deletes_and_calls_back(robot: Node, client: AsyncParameterClient, executor: Any) -> None:
    heard: list[Any] = []
    given: list[Any] = [Parameter("speed", value=1.5), Parameter("arm.length", value=4).to_parameter_msg()]
    future = client.set_parameters(given, heard.append)
    assert [each.successful for each in done(executor, future).results] == [True, True]
    spin_for(executor, 0.01)
    assert heard == [future]
    assert done(executor, client.set_parameters_atomically([Parameter("speed", value=2.0)])).result.successful
    results = done(executor, client.delete_parameters(["free", "speed"])).results
    assert [each.successful for each in results] == [True, False]
    assert (robot.get_parameter("speed").value, robot.has_parameter("free")) == (2.0, False)


@pytest.mark.parametrize("atomically", [True, False])
def test_it_loads_files(
    robot: Node, client: AsyncParameterClient, executor: Any, tmp_path: Path, atomically: bool
) -> None:
    file = tmp_path / "params.yaml"
    file.write_text(FILE)
    load: Any = client.load_parameter_file_atomically if atomically else client.load_parameter_file
    done(executor, load(file))
    assert [each.value for each in robot.get_parameters(["speed", "arm.length"])] == [0.5, 3]
    done(executor, load(str(file), use_wildcard=True))
    assert robot.get_parameter("speed").value == 2.5


def test_it_hears_of_changes(robot: Node, client: AsyncParameterClient, executor: SingleThreadedExecutor) -> None:
    events: list[ParameterEvent] = []
    subscription = client.on_parameter_event(events.append)
    done(executor, client.set_parameters([Parameter("free", value="now a text")]))
    done(executor, client.delete_parameters(["free"]))
    spin_for(executor, 0.01)
    assert [each.node for each in events] == ["/lab/robot"] * 2
    assert [[p.name for p in (*e.changed_parameters, *e.deleted_parameters)] for e in events] == [["free"], ["free"]]
    assert [len(events[0].deleted_parameters), len(events[1].deleted_parameters)] == [0, 1]
    subscription.destroy()


# --- ParameterEventHandler ----------------------------------------------------------------------------------------


def test_a_handler_calls_for_one_parameter_and_for_all(robot: Node, asker: Node, executor: Any) -> None:
    handler = ParameterEventHandler(asker)
    heard: list[Any] = []

    def on_speed(parameter: ParameterMsg) -> None:
        heard.append(parameter.value.double_value)

    own = handler.add_parameter_callback("speed", "robot", on_speed)
    handler.add_parameter_callback("speed", "/elsewhere/robot", on_speed)
    for_all = handler.add_parameter_event_callback(lambda event: heard.append(event.node))
    robot.set_parameters([Parameter("speed", value=0.7), Parameter("free", value=2)])
    spin_for(executor, 0.01)
    assert heard == [0.7, "/lab/robot", "/lab/robot"]
    handler.remove_parameter_callback(own)
    handler.remove_parameter_event_callback(for_all)
    robot.set_parameters([Parameter("speed", value=0.8)])
    spin_for(executor, 0.01)
    assert len(heard) == 3
    handler.destroy()
    assert handler.parameter_event_subscription not in asker.subscriptions


def test_a_callback_may_remove_itself_and_is_then_unknown(robot: Node, asker: Node, executor: Any) -> None:
    handler = ParameterEventHandler(asker)
    heard: list[str] = []

    def once(parameter: ParameterMsg) -> None:
        heard.append("once")
        handler.remove_parameter_callback(handle)

    handler.add_parameter_callback("speed", "robot", lambda _: heard.append("first added"))
    handle = handler.add_parameter_callback("speed", "robot", once)
    for speed in (1.0, 2.0):
        robot.set_parameters([Parameter("speed", value=speed)])
    spin_for(executor, 0.01)
    assert heard == ["once", "first added", "first added"]
    with pytest.raises(RuntimeError, match="not there"):
        handler.remove_parameter_callback(handle)
    with pytest.raises(RuntimeError, match="not there"):
        handler.remove_parameter_event_callback(handler.add_parameter_callback("x", "", once))  # type: ignore[arg-type]


def test_a_handler_reads_events() -> None:
    new, changed, gone = (Parameter(name, value=1).to_parameter_msg() for name in "abc")
    event = ParameterEvent(node="/n", new_parameters=[new], changed_parameters=[changed], deleted_parameters=[gone])
    assert list(ParameterEventHandler.get_parameters_from_event(event)) == [new, changed]
    found = [ParameterEventHandler.get_parameter_from_event(event, name, "/n") for name in "abc"]
    assert found == [new, changed, None]
    assert ParameterEventHandler.get_parameter_from_event(event, "a", "/other") is None
