"""Builders of nodes, containers and lifecycle nodes from the elements of XML and YAML launch files."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.companions.launch.bases import Action, Substitution
from robolink.companions.launch_frontend.entity import Entity
from robolink.companions.launch_frontend.parameters import parameters_in
from robolink.companions.launch_frontend.processes import PROCESS, executable
from robolink.companions.launch_ros import actions as ros
from robolink.companions.launch_ros.descriptions import ComposableNode

NODE = ("pkg", "exec", "name", "namespace", "exec_name", "args", "ros_args", *PROCESS)
"""Attributes of a node."""
INSIDE = ("param", "remap", "env")
"""Elements inside of a node."""


def _settings(entity: Entity) -> dict[str, Any]:
    """Return the arguments of Node that an element stands for, without its name and namespace."""
    shared = executable(entity, "exec_name")
    shared["exec_name"] = shared.pop("name", None)
    return {
        "package": entity.needed("pkg"),
        "executable": entity.needed("exec"),
        "parameters": parameters_in(entity),
        "remappings": _remappings(entity),
        "arguments": entity.words("args"),
        "ros_arguments": entity.words("ros_args"),
        **shared,
    }


def _remappings(entity: Entity) -> list[tuple[list[Substitution], list[Substitution]]]:
    for each in entity.inside("remap"):
        each.check(("from", "to"))
    return [(each.needed("from"), each.needed("to")) for each in entity.inside("remap")]


def _named(entity: Entity) -> dict[str, Any]:
    return {"name": entity.optional("name"), "namespace": entity.optional("namespace")}


def _node(entity: Entity) -> Action:
    entity.check(NODE, INSIDE)
    return ros.Node(**_named(entity), **_settings(entity))


def _lifecycle_node(entity: Entity) -> Action:
    entity.check((*NODE, "autostart"), INSIDE)
    named = {name: value or "" for name, value in _named(entity).items()}
    return ros.LifecycleNode(**named, autostart=entity.optional("autostart", bool) or False, **_settings(entity))


def _container(entity: Entity) -> Action:
    entity.check(NODE, (*INSIDE, "composable_node"))
    named = {**_named(entity), "name": entity.needed("name")}
    return ros.ComposableNodeContainer(**named, **_settings(entity), composable_node_descriptions=_composed(entity))


def _load(entity: Entity) -> Action:
    entity.check(("target",), ("composable_node",))
    return ros.LoadComposableNodes(
        target_container=entity.needed("target"), composable_node_descriptions=_composed(entity)
    )


def _composed(entity: Entity) -> list[ComposableNode]:
    return [_composable(each) for each in entity.inside("composable_node")]


def _composable(entity: Entity) -> ComposableNode:
    condition = entity.condition()
    entity.check(("pkg", "plugin", "name", "namespace"), ("param", "remap", "extra_arg"))
    for each in entity.inside("extra_arg"):
        each.check(("name", "value"))
    made = ComposableNode(
        package=entity.needed("pkg"),
        plugin=entity.needed("plugin"),
        parameters=parameters_in(entity),
        remappings=_remappings(entity),
        extra_arguments=[{tuple(each.needed("name")): each.needed("value")} for each in entity.inside("extra_arg")],
        condition=condition,
        **_named(entity),
    )
    made.place = entity.place
    return made


NODES: dict[str, Callable[[Entity], Action]] = {
    "lifecycle_node": _lifecycle_node,
    "load_composable_node": _load,
    "load_composable_nodes": _load,
    "node": _node,
    "node_container": _container,
}
"""Builders by tag."""
