"""The robots of the simulated worlds among some nodes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robolink.node import Node
from robolink.sim import Robot
from robolink.sim_node import Simulation


def robots_of(nodes: Iterable[Node]) -> Iterator[Robot]:
    """Yield the robots of each node that keeps a `Simulation`, as nodes/world.py does, under whatever name."""
    for node in nodes:
        found = [each for each in vars(node).values() if isinstance(each, Simulation)]
        for simulation in found:
            yield from simulation.world.robots.values()
