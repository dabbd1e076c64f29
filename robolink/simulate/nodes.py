"""Nodes of a simulation: parameters that were set for one which never declared them, simulated worlds, robots."""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from robolink.exceptions import nearest
from robolink.text.names import meant

if TYPE_CHECKING:
    from robolink.host import Host
    from robolink.launch import Launched
    from robolink.node import Node
    from robolink.sim import Robot
    from robolink.world_node import Simulation


def is_among(name: str, declared: Iterable[str]) -> bool:
    """Return True if a parameter, or one of a group with this name, is declared.

    >>> is_among("gains", ["gains.p"]), is_among("gain", ["gains.p"])
    (True, False)
    """
    return any(f"{each}.".startswith(f"{name}.") for each in declared)


def undeclared(given: Iterable[str], launched: Sequence[Launched], host: Host) -> Iterator[str]:
    """Yield a message for each parameter given, as ``wall_follower.speed``, that its node has not declared by now.

    Left out are nodes that are not there, or that have ended in an error; those with a lifecycle, which may declare
    theirs later; and those that allow undeclared ones.
    """
    names = [entry.name for each in launched for entry in each.entries]
    for place in given:
        node, _, name = place.lstrip("/").partition(".")
        for full_name in meant(node, names):
            nodes = _nodes_of(full_name, launched, host)
            declared = {known for each in nodes for known in each._declared_so_far_}
            if nodes and not is_among(name, declared) and not any(map(_may_take_others, nodes)):
                reason = f"which has not declared it{nearest(name, sorted(declared))}"
                yield f"parameter '{name}' was given to {full_name}, {reason}"


def _nodes_of(full_name: str, launched: Sequence[Launched], host: Host) -> Collection[Node]:
    """Return the node of a launch file's entry, or all of its program where none is called so."""
    of_it = (each.name for each in launched if any(entry.name == full_name for entry in each.entries))
    program = host.programs.get(next(of_it, ""))
    nodes = [] if program is None or program.error is not None else program.nodes
    return [each for each in nodes if each.get_fully_qualified_name().strip("/") == full_name.strip("/")] or nodes


def _may_take_others(node: Node) -> bool:
    from robolink.lifecycle.managed_entity import ManagedEntity  # late: few simulations ask

    return node._allow_undeclared_parameters or isinstance(node, ManagedEntity)


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
