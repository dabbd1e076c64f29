"""The markers of a simulated world: what stands, what moves, and the robots' outlines in their own frames."""

from __future__ import annotations

from typing import Any

import pytest

from robolink import Context, Node
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.visualization_msgs.msg import Marker, MarkerArray
from robolink.sim import load_world
from robolink.world_node import Shapes, Simulation
from robolink.world_node.simulation import LATCHED
from tests.support.spins import spin_until

WORLD = """
walls: [{polyline: [[0, 0], [4, 0], [4, 3]], closed: true}]
obstacles:
  - {circle: 0.2, pose: [1, 1]}
  - {box: [0.4, 0.2], mass: 1.0, pose: [2, 2, 0.5]}
  - {polygon: [[0, 0], [0.2, 0], [0, 0.2]], path: [[3, 1], [3, 2]], speed: 1.0}
robots: [{name: bob, pose: [2, 1]}]
"""


@pytest.fixture
def heard(virtual: Context, executor: SingleThreadedExecutor, tmp_path: Any) -> dict[str, Any]:
    """A world's markers, as another node hears them."""
    file = tmp_path / "world.yaml"
    file.write_text(WORLD, encoding="utf-8")
    node, ear = Node("world", context=virtual), Node("viewer", context=virtual)
    simulation = Simulation(node, load_world(file), 0)
    steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=virtual.time)
    shapes = Shapes(node, simulation, steady)
    found: dict[str, Any] = {"simulation": simulation, "shapes": shapes, "count": 0}

    def take(name: str, message: MarkerArray) -> None:
        found[name], found["count"] = message.markers, found["count"] + 1

    for name in ("walls", "objects"):
        ear.create_subscription(MarkerArray, f"/world/{name}", lambda message, name=name: take(name, message), LATCHED)
    executor.add_node(node)
    executor.add_node(ear)
    spin_until(executor, lambda: "walls" in found and "objects" in found)
    found["executor"] = executor
    return found


def test_walls_and_what_stands_are_told_once(heard: dict[str, Any]) -> None:
    lines, stone = heard["walls"]
    assert (lines.ns, lines.type, len(lines.points)) == ("walls", Marker.LINE_LIST, 6)
    assert (stone.type, stone.scale.x, stone.pose.position.x) == (Marker.CYLINDER, 0.4, 1.0)
    assert all(each.header.frame_id == "map" for each in heard["walls"])


def test_what_moves_is_told_where_it_is(heard: dict[str, Any]) -> None:
    _, pushed, mover, _ = heard["objects"]
    assert (pushed.type, pushed.scale.x, mover.type) == (Marker.CUBE, 0.4, Marker.LINE_STRIP)
    for _ in range(50):
        heard["simulation"].step()
    before = heard["count"]
    spin_until(heard["executor"], lambda: heard["count"] > before)
    assert heard["objects"][2].pose.position.y == pytest.approx(1.5, abs=0.05)


def test_a_robot_is_drawn_in_its_own_frame(heard: dict[str, Any]) -> None:
    robot = heard["objects"][-1]
    assert (robot.ns, robot.header.frame_id, robot.frame_locked) == ("robots", "base_link", True)
    heard["simulation"].delete("bob")
    spin_until(heard["executor"], lambda: heard["objects"][-1].ns != "robots")
    assert heard["objects"][0].action == Marker.DELETEALL


def test_nothing_is_told_again_while_nothing_moves(heard: dict[str, Any]) -> None:
    before = heard["count"]
    heard["shapes"].publish()
    spin_until(heard["executor"], lambda: heard["executor"].context.time.steady() > 1_000_000_000)
    assert heard["count"] == before
