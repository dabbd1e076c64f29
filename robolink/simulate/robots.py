"""Search for the simulated worlds among some nodes, and for their robots."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.sim import Robot
    from robolink.world_node import Simulation


def worlds_of(nodes: Iterable[Node]) -> Iterator[tuple[Node, Simulation]]:
    """Yield each node that keeps a `Simulation`, as nodes/world.py does, under whatever name; and the simulation."""
    room = sys.modules.get("robolink.world_node.simulation")
    if room is None:  # nobody simulates a world, and pymunk need not be imported to find that out
        return
    for node in nodes:
        for each in list(vars(node).values()):
            if isinstance(each, room.Simulation):
                yield node, each


def robots_of(nodes: Iterable[Node]) -> Iterator[tuple[str, Robot]]:
    """Yield the robots of simulated worlds.

    Each comes with its name, and the world's namespace before it where it has one, since there may be several worlds.
    """
    for node, simulation in worlds_of(nodes):
        for robot in simulation.world.robots.values():
            yield f"{node.get_namespace()}/{robot.name}".lstrip("/"), robot
