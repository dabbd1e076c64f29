"""Command-line arguments and environment of a node's program, as the launcher gives them."""

from __future__ import annotations

from collections.abc import Iterator

from robolink.documents.yamlfile import spell
from robolink.launch.entry import Entry, NodeToStart
from robolink.workspace import VARIABLE


def arguments(entry: Entry) -> Iterator[str]:
    """Yield the arguments of a node's program: its own, then those behind `--ros-args`, if there are any."""
    yield from entry.node.args
    for_ros = [*_for_ros(entry.node)]
    if for_ros:  # a program that counts its words gets no more than it is given
        yield from ("--ros-args", *for_ros)


def _for_ros(node: NodeToStart) -> Iterator[str]:
    if node.name:
        yield from ("-r", f"__node:={node.name}")
    if node.namespace:
        yield from ("-r", f"__ns:={node.namespace}")
    for name, value in node.parameters.items():
        yield from ("-p", f"{name}:={spell(value)}")
    for match, replacement in node.remappings.items():
        yield from ("-r", f"{match}:={replacement}")
    if node.log_level:
        yield from ("--log-level", node.log_level)
    if node.enclave:
        yield from ("--enclave", node.enclave)


def environment(entry: Entry) -> dict[str, str | None]:
    """Return the changes of a node's environment: its workspace, and the variables of the file."""
    home = {} if entry.home is None else {VARIABLE: str(entry.home)}
    return {**home, **entry.node.env}
