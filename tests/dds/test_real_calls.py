"""Services, actions and parameters between a real ROS 2 over DDS and robolink, by itself and through the bridge."""

from __future__ import annotations

import statistics
from typing import Any

import pytest

from tests.dds.conftest import Lab, Scene
from tests.dds.peers import Peer, until

pytestmark = pytest.mark.processes

SET_BOOL, FIBONACCI = "std_srvs/srv/SetBool", "test_msgs/action/Fibonacci"
BASIC_TYPES = "test_msgs/srv/BasicTypes"
SUCCEEDED, CANCELED = 4, 5


def pairs(scene: Scene) -> list[tuple[Peer, Peer]]:
    """Return server and client, each way."""
    return [(scene.real, scene.ours), (scene.ours, scene.real)]


def ready(client: Peer, name: str) -> None:
    until(lambda: client.ask("is_ready", name=name), f"{client.name} sees a server of {name}")


def test_services_answer_both_ways(scene: Scene) -> None:
    for server, client in pairs(scene):
        name = f"switch_of_{server.name}"
        server.ask("service", name=name, type_name=SET_BOOL)
        client.ask("client", name=name, type_name=SET_BOOL)
        ready(client, name)
        for value in (True, False):
            answer = client.ask("call", name=name, type_name=SET_BOOL, values={"data": value})
            assert answer == {"success": value, "message": f"{server.name} heard {value}"}


def test_calls_of_a_type_that_the_bridge_does_not_know_get_each_its_own_answer(scene: Scene) -> None:
    asked = {}
    values = list(range(10))  # as many as the queues of services hold
    for server, client in pairs(scene):
        name = f"basics_of_{server.name}"
        server.ask("service", name=name, type_name=BASIC_TYPES)
        client.ask("client", name=name, type_name=BASIC_TYPES)
        ready(client, name)
    for server, client in pairs(scene):
        name = f"basics_of_{server.name}"
        asked[client] = client.start("calls", name=name, type_name=BASIC_TYPES, field="int32_value", values=values)
    assert [client.answer(number) for client, number in asked.items()] == [values, values]


def test_a_megabyte_is_requested_and_answered(scene: Scene) -> None:
    text = "0123456789" * 100_000
    for server, client in pairs(scene):
        name = f"large_of_{server.name}"
        server.ask("service", name=name, type_name=BASIC_TYPES)
        client.ask("client", name=name, type_name=BASIC_TYPES)
        ready(client, name)
        answer = client.ask("call", name=name, type_name=BASIC_TYPES, values={"string_value": text})
        assert answer["string_value"] == text


def test_a_call_takes_milliseconds(scene: Scene) -> None:
    """Whoever waits for an answer is woken up by it, not by a timeout: that would be 50 ms here."""
    for server, client in pairs(scene):
        name = f"fast_of_{server.name}"
        server.ask("service", name=name, type_name=SET_BOOL)
        client.ask("client", name=name, type_name=SET_BOOL)
        ready(client, name)
        assert statistics.median(client.ask("rounds", name=name, type_name=SET_BOOL, count=40)) < 0.02


def test_two_of_robolink_s_own_call_each_other_over_dds(lab: Lab) -> None:
    with lab.direct("one") as one, lab.direct("two") as two:
        for server, client in ((one.ready(), two.ready()), (two, one)):
            name = f"fast_of_{server.name}"
            server.ask("service", name=name, type_name=SET_BOOL)
            client.ask("client", name=name, type_name=SET_BOOL)
            ready(client, name)
            assert statistics.median(client.ask("rounds", name=name, type_name=SET_BOOL, count=40)) < 0.02
        until(lambda: one.ask("nodes") == two.ask("nodes") == ["/lab/one", "/lab/two"], "both see both")


def test_actions_of_a_type_that_the_bridge_does_not_know_run_with_feedback(scene: Scene) -> None:
    for server, client in pairs(scene):
        name = f"compute_of_{server.name}"
        server.ask("action_server", name=name, type_name=FIBONACCI)
        client.ask("action_client", name=name, type_name=FIBONACCI)
        ready(client, name)
        assert client.ask("goal", name=name, type_name=FIBONACCI, order=8)
        [result] = client.wait(f"{name} result")
        assert (result["status"], result["sequence"]) == (SUCCEEDED, [0, 1, 1, 2, 3, 5, 8, 13])
        told = [each["sequence"] for each in client.events(f"{name} feedback")]
        assert told  # the last of them may come after the result, and a client drops it then
        assert all(each == result["sequence"][: len(each)] for each in told)


def test_actions_are_canceled_both_ways(scene: Scene) -> None:
    for server, client in pairs(scene):
        name = f"endless_of_{server.name}"
        server.ask("action_server", name=name, type_name=FIBONACCI)
        client.ask("action_client", name=name, type_name=FIBONACCI)
        ready(client, name)
        assert client.ask("goal", name=name, type_name=FIBONACCI, order=2000)
        client.wait(f"{name} feedback", 3)
        assert client.ask("cancel", name=name) == 1
        [result] = client.wait(f"{name} result")
        assert result["status"] == CANCELED
        assert result["sequence"][:5] == [0, 1, 1, 2, 3]


def test_a_real_node_reads_and_sets_parameters_of_ours(scene: Scene) -> None:
    scene.ours.ask("declare", speed=1.5, label="robot")

    def asked(verb: str, **more: Any) -> Any:
        return until(
            lambda: scene.real.ask("remote_parameters", node="/lab/ours", verb=verb, **more),
            "the services of /lab/ours",
        )

    assert {"speed", "label", "use_sim_time"} <= set(asked("list")["result"]["names"])
    assert asked("set", values={"speed": 2.5})["results"] == [{"successful": True, "reason": ""}]
    assert scene.ours.ask("parameter", name="speed") == 2.5
    [value] = asked("get", names=["speed"])["values"]
    assert value["double_value"] == 2.5


def test_the_command_line_reads_and_sets_parameters_of_a_real_node(scene: Scene) -> None:
    scene.real.ask("declare", depth=3, title="real")
    with scene.lab.command(scene.way, "param", "set", "/lab/real", "depth", "7") as command:
        assert command.end() == 0, command.errors
    assert scene.real.ask("parameter", name="depth") == 7
    with scene.lab.command(scene.way, "param", "get", "/lab/real", "depth") as command:
        assert command.end() == 0, command.errors
        assert "7" in command.lines[-1].text
    with scene.lab.command(scene.way, "param", "list", "/lab/real") as command:
        assert command.end() == 0, command.errors
        assert {"depth", "title"} <= {line.text.strip() for line in command.lines}
