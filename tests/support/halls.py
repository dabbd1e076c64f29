"""A simulated hall for tests of the world's services, and how they are called."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.std_srvs.srv import Trigger
from robolink.testing import System
from robolink.world_node.services import own_type
from tests.support.nodefiles import load_node_file
from tests.support.systems import ask

simulation = load_node_file("world")

Step, Teleport, Spawn, Delete, SetRate = map(own_type, ("Step", "Teleport", "Spawn", "Delete", "SetRate"))

HALL = """
world: {name: hall, size: [10, 10], seed: 3}
walls:
  - {polyline: [[0, 0], [10, 0], [10, 10], [0, 10]], closed: true}
obstacles:
  - {circle: 0.5, pose: [7, 7], mass: 1.0}
robots:
  - name: ada
    pose: [2, 2, 0]
    odom: {noise: {v: 0.1, w: 0.1}}
    sensors: [{lidar: scan, beams: 8, noise: 0.05}]
  - {name: bob, pose: [2, 8, 0], sensors: [{bumper: bump}]}
"""


def asked(system: System, name: str, /, **fields: Any) -> tuple[bool, str]:
    kinds = {"step": Step, "teleport": Teleport, "spawn": Spawn, "delete": Delete, "set_rate": SetRate}
    return ask(system, kinds.get(name, Trigger), f"/world/{name}", **fields)


def refused(answer: tuple[bool, str]) -> str:
    success, message = answer
    assert not success
    assert message
    return message


def robots(world: Any) -> Any:
    return world.simulation.world.robots
