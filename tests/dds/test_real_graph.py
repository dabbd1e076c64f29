"""The graph of a real ROS 2 over DDS and robolink, as each of them sees the other, with hashes and QoS."""

from __future__ import annotations

import functools
from typing import Any

import pytest

from tests.dds.conftest import Scene
from tests.dds.peers import Peer, until

pytestmark = pytest.mark.processes

STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
FOREVER = 9223372036854775807
"""How an endless time is shown, in ns."""

QOS = [
    pytest.param({}, id="default"),
    pytest.param({"reliable": False, "depth": 5}, id="sensor data"),
    pytest.param({"latched": True, "depth": 1}, id="latched"),
    pytest.param({"deadline": 0.5, "lifespan": 2.0, "lease": 3.0}, id="times"),
]


def both(scene: Scene) -> list[tuple[Peer, Peer]]:
    return [(scene.real, scene.ours), (scene.ours, scene.real)]


def seen(peer: Peer, topic: str) -> tuple[list[Any], list[Any]]:
    publishers, subscriptions = peer.ask("endpoints", topic=f"/lab/{topic}")
    return publishers, subscriptions


def sees(peer: Peer, topic: str, nodes: list[str]) -> bool:
    """Whether publishers and subscriptions are those of these nodes; DDS tells which node has an endpoint later."""
    return all([end["node"] for end in ends] == nodes for ends in seen(peer, topic))


def sees_both_nodes(peer: Peer) -> bool:
    return bool(peer.ask("nodes") == ["/lab/ours", "/lab/real"])


def sees_all(peer: Peer, other: Peer) -> bool:
    """Whether another node has for a peer what it has for itself."""
    about: dict[str, Any] = {"name": other.name, "namespace": "/lab"}
    return all(peer.ask(do, **about) == other.ask(do, **about) for do in ("topics_of", "services_of", "clients_of"))


@pytest.mark.parametrize("qos", QOS)
def test_each_sees_the_other_s_endpoints_with_type_hash_and_qos(
    scene: Scene, qos: dict[str, Any], request: Any
) -> None:
    topic = "_".join(["graph", *qos])
    for peer, other in both(scene):
        own = f"{topic}_of_{peer.name}"
        peer.ask("publisher", topic=own, type_name="std_msgs/msg/String", **qos)
        peer.ask("subscription", topic=own, type_name="std_msgs/msg/String", **qos)
        until(functools.partial(sees, other, own, [f"/lab/{peer.name}"]), f"{other.name} sees both")
        expected = {
            "node": f"/lab/{peer.name}",
            "type": "std_msgs/msg/String",
            "hash": STRING_HASH,
            "reliability": "RELIABLE" if qos.get("reliable", True) else "BEST_EFFORT",
            "durability": "TRANSIENT_LOCAL" if qos.get("latched") else "VOLATILE",
            "liveliness": "AUTOMATIC",
            "deadline": int(qos["deadline"] * 1e9) if "deadline" in qos else FOREVER,
            "lease": int(qos["lease"] * 1e9) if "lease" in qos else FOREVER,
        }
        for [end] in seen(other, own):
            assert {name: end[name] for name in expected} == expected
        assert seen(other, own)[0][0]["lifespan"] == (int(qos["lifespan"] * 1e9) if "lifespan" in qos else FOREVER)
        peer.ask("forget", topic=own)
        until(functools.partial(sees, other, own, []), f"{other.name} sees that both are gone")


def test_each_sees_all_nodes_and_what_they_have(scene: Scene) -> None:
    for peer, other in both(scene):
        until(functools.partial(sees_both_nodes, other), f"{other.name} sees both nodes")
        name = peer.name
        peer.ask("publisher", topic=f"scan_of_{name}", type_name="sensor_msgs/msg/LaserScan")
        peer.ask("subscription", topic=f"twist_of_{name}", type_name="geometry_msgs/msg/Twist")
        peer.ask("service", name=f"set_of_{name}", type_name="std_srvs/srv/SetBool")
        peer.ask("client", name=f"basic_of_{name}", type_name="test_msgs/srv/BasicTypes")
        peer.ask("action_server", name=f"act_of_{name}", type_name="test_msgs/action/Fibonacci")
        until(functools.partial(sees_all, other, peer), f"{other.name} sees all of {name}")
        publishers, subscriptions = other.ask("topics_of", name=name, namespace="/lab")
        assert publishers[f"/lab/scan_of_{name}"] == ["sensor_msgs/msg/LaserScan"]
        assert subscriptions[f"/lab/twist_of_{name}"] == ["geometry_msgs/msg/Twist"]
        services = other.ask("services_of", name=name, namespace="/lab")
        assert services[f"/lab/set_of_{name}"] == ["std_srvs/srv/SetBool"]
        assert services[f"/lab/act_of_{name}/_action/send_goal"] == ["test_msgs/action/Fibonacci_SendGoal"]
        assert other.ask("clients_of", name=name, namespace="/lab")[f"/lab/basic_of_{name}"] == [
            "test_msgs/srv/BasicTypes"
        ]


def test_the_command_line_shows_a_real_node(scene: Scene) -> None:
    scene.real.ask("publisher", topic="shown", type_name="std_msgs/msg/String")
    with scene.lab.command(scene.way, "node", "info", "/lab/real") as command:
        assert command.end() == 0, command.errors
        assert any("/lab/shown" in line.text and "std_msgs/msg/String" in line.text for line in command.lines)
    with scene.lab.command(scene.way, "topic", "info", "/lab/shown", "--verbose") as command:
        assert command.end() == 0, command.errors
        text = "\n".join(line.text for line in command.lines)
        assert STRING_HASH in text
        assert "real" in text
