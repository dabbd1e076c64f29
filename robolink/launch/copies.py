"""Multiply the nodes of a launch file that have a `count`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import msgspec

from robolink.launch.description import LaunchDescription, NodeDescription
from robolink.launch.substitution import Steps, SubstitutionError, filled
from robolink.yamlfile import Document

NUMBER = "i"
_FILLED = ("name", "namespace", "parameters", "remappings", "args", "process")


class Copy(NamedTuple):
    """A node to start, what is written of it (with `{i}` where it is one of several), and which entry it is."""

    node: NodeDescription
    written: NodeDescription
    entry: int

    @property
    def place(self) -> Steps:
        """The steps that lead to it in the file."""
        return ["nodes", self.entry]


def copies(document: Document[LaunchDescription]) -> Iterator[Copy]:
    """Yield each node to start. Raises `DocumentError` for a `{name}` that stands for nothing."""
    for index, node in enumerate(document.value.nodes):
        if not node.count:
            yield Copy(node, node, index)
            continue
        for number in range(node.count):
            try:
                yield Copy(_numbered(node, number, index), node, index)
            except SubstitutionError as error:
                raise document.error(error.steps, str(error), key=error.is_key) from None


def _numbered(node: NodeDescription, number: int, index: int) -> NodeDescription:
    texts = {each: filled(getattr(node, each), {NUMBER: number}, ["nodes", index, each]) for each in _FILLED}
    for each in ("name", "namespace", "process"):
        texts[each] = str(texts[each])
    texts["remappings"] = {match: str(replacement) for match, replacement in texts["remappings"].items()}
    return msgspec.structs.replace(node, **texts)
