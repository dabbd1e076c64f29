"""The robots of the simulated worlds among some nodes."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.sim import Robot


def robots_of(nodes: Iterable[Node]) -> Iterator[tuple[str, Robot]]:
    """Yield the robots of each node that keeps a `Simulation`, as nodes/world.py does, under whatever name.

    Each comes with its name, and the world's namespace before it where it has one, since there may be several worlds.
    """
    room = sys.modules.get("robolink.sim_node.simulation")
    if room is None:  # nobody simulates a world, and pymunk need not be imported to find that out
        return
    for node in nodes:
        found = [each for each in vars(node).values() if isinstance(each, room.Simulation)]
        for simulation in found:
            for robot in simulation.world.robots.values():
                yield f"{node.get_namespace()}/{robot.name}".lstrip("/"), robot
