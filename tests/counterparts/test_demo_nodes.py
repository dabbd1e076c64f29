"""demo_nodes_py and demo_nodes_cpp: the first programs of the tutorials, with the lines that these show."""

from __future__ import annotations

import pytest

from robolink.counterparts.demo_nodes_py import run_parameter_client
from robolink.exceptions import RobolinkError
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.std_msgs.msg import String
from robolink.parameter_client import AsyncParameterClient
from robolink.testing import System


@pytest.mark.parametrize(("package", "first", "quote"), [("demo_nodes_py", 0, '"'), ("demo_nodes_cpp", 1, "'")])
def test_talker_and_listener(system: System, package: str, first: int, quote: str) -> None:
    system.start(f"{package} talker")
    system.start(f"{package} listener")
    heard = system.messages("/chatter", String)
    system.run(3.5)
    assert [each.data for each in heard] == [f"Hello World: {first + each}" for each in range(3)]
    system.expect_log(f"Publishing: {quote}Hello World: {first}{quote}")
    system.expect_log(f"I heard: [Hello World: {first}]")


def test_the_listener_of_bytes(system: System) -> None:
    system.start("demo_nodes_py listener_serialized")
    system.start("demo_nodes_py talker")
    system.expect_log("I heard: \"b'\\x00\\x01")
    system.expect_log("I heard: [Hello World: 0]")


def test_with_other_quality_of_service_they_end_after_some_messages(system: System) -> None:
    system.start("demo_nodes_py listener_qos", args=["--reliable", "-n", "2"])
    system.start("demo_nodes_py talker_qos", args=["--reliable", "-n", "3"])
    system.expect_log("Reliable listener")
    system.expect_log("Reliable talker")
    heard = system.messages("/chatter", String)
    system.run(10.0)
    assert len(heard) == 3
    assert "talker_qos" not in system.node.get_node_names()


@pytest.mark.parametrize("package", ["demo_nodes_py", "demo_nodes_cpp"])
def test_two_numbers_are_added(system: System, package: str) -> None:
    system.start(f"{package} add_two_ints_server")
    assert system.call(AddTwoInts, "/add_two_ints", AddTwoInts.Request(a=40, b=2)).sum == 42
    system.expect_log("Incoming request\na: 40 b: 2")
    system.start(f"{package} add_two_ints_client")
    system.expect_log("Result of add_two_ints: 5")


def test_clients_wait_for_their_service(system: System, capsys: pytest.CaptureFixture[str]) -> None:
    system.start("demo_nodes_py add_two_ints_client_async")
    system.start("demo_nodes_cpp add_two_ints_client", name="other")
    system.run(2.5)
    assert capsys.readouterr().out.count("service not available, waiting again...") == 2
    system.expect_log("service not available, waiting again...", within=0.0)
    system.start("demo_nodes_py add_two_ints_server")
    system.expect_log("Result of add_two_ints: 5")
    system.expect_log("Result of add_two_ints: 5")


def test_the_other_forms_of_cpp(system: System) -> None:
    system.start("demo_nodes_cpp listener_best_effort")
    system.start("demo_nodes_cpp talker")
    system.start("demo_nodes_cpp add_two_ints_client_async")
    system.start("demo_nodes_cpp add_two_ints_server")
    system.expect_log("Result of add_two_ints: 5")
    system.expect_log("I heard: [Hello World: 1]")


def test_calls_are_observed_as_parameters_say(system: System) -> None:
    system.start("demo_nodes_py introspection")
    system.expect_log("Result of add_two_ints: 5")
    events = system.messages("/add_two_ints/_service_event", AddTwoInts.Event)
    system.run(2.0)
    assert not events
    system.set_parameter("introspection_client", "client_configure_introspection", "contents")
    system.run(2.0)
    assert next(each.response[0].sum for each in events if each.response) == 5
    with pytest.raises(RobolinkError, match="must be one of 'disabled', 'metadata', or 'contents'"):
        system.set_parameter("introspection_client", "client_configure_introspection", "all")


def test_a_parameter_sets_another(system: System) -> None:
    system.start("demo_nodes_py set_parameters_callback")
    system.set_parameter("set_parameters_callback", "param1", 1.0)
    assert system.parameter("set_parameters_callback", "param2") == 4.0


def test_parameters_of_the_blackboard(system: System) -> None:
    system.start("demo_nodes_cpp parameter_blackboard")
    system.expect_log("Parameter blackboard node named '/parameter_blackboard' ready, and serving '")
    system.start("demo_nodes_py async_param_client")
    for line in ("Setting parameters:", "    - int_parameter: 10", "Loading parameters: ", "Deleting parameters: "):
        system.expect_log(line)
    system.run(1.0)
    assert system.parameter("parameter_blackboard", "int_parameter") == 12
    assert system.parameter("parameter_blackboard", "string_parameter") is None


def test_without_the_blackboard_it_is_one_line(system: System, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://nobody")
    monkeypatch.setattr(AsyncParameterClient, "wait_for_services", lambda self, seconds: False)
    with pytest.raises(RobolinkError, match="parameter_blackboard is not there: start it by"):
        run_parameter_client(["x"])
