"""Components of a container: Python classes become nodes that share a process, the others are left out."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from robolink.companions.launch.actions import ExecuteLocal
from robolink.companions.launch.bases import LaunchContext
from robolink.companions.launch.utilities import performed
from robolink.companions.launch_ros.actions import ComposableNodeContainer, LoadComposableNodes
from robolink.companions.launch_ros.descriptions import ComposableNode
from robolink.launch.entry import Entry
from robolink.launch.ros.entries import EntryMaker, Naming, Wanted, namespace_of, placed
from robolink.launch.ros.programs import component_of
from robolink.system.terminal import shown


def container_of(action: ComposableNodeContainer, context: LaunchContext) -> str:
    """Return the name of the process of a container: its full name without the first slash."""
    namespace = namespace_of(action.requested_namespace, context)
    name = performed(context, action.requested_name or "container")
    action.expanded_name = f"{namespace}/{name}"
    return action.expanded_name.strip("/")


def target_of(action: LoadComposableNodes, context: LaunchContext) -> str:
    """Return the name of the process of the container into which components are loaded."""
    target = action.target_container
    if isinstance(target, ComposableNodeContainer):
        return container_of(target, context)
    name = performed(context, target)
    return (name if name.startswith("/") else f"{namespace_of(None, context)}/{name}").strip("/")


def components(
    maker: EntryMaker, described: Iterable[ComposableNode], action: ExecuteLocal, process: str, context: LaunchContext
) -> Iterator[Entry]:
    """Yield the entries of the components that are Python classes; tell of the others in one line for each package.

    Args:
        maker: Maker of the entries.
        described: The components.
        action: Action of their container, whose settings they share.
        process: Name of the process that they share.
        context: The context with whose values they are performed.
    """
    absent: dict[str, list[str]] = {}
    for each in described:
        if each.condition is not None and not each.condition.evaluate(context):
            continue
        package, plugin = performed(context, each.package), performed(context, each.node_plugin)
        program = component_of(package, plugin, maker.home)
        if program.absent:
            absent.setdefault(program.absent, []).append(plugin)
            continue
        naming = Naming(_text(each.node_name, context), namespace_of(each.node_namespace, context))
        wanted = Wanted(program, plugin, naming, each.parameters or (), each.remappings or (), each.place)
        yield maker.shared(wanted, action, process, context)
    for reason, plugins in absent.items():
        maker.say(f"{placed(action.place)}left out: {_listed(plugins)} of container /{process}: {reason}")


def _text(value: Any, context: LaunchContext) -> str:
    return "" if value is None else performed(context, value)


def _listed(plugins: Sequence[str]) -> str:
    return ", ".join(shown(re.sub(r"\s", "", each)) for each in plugins)
