"""Parser of launch files in YAML."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import yaml

from robolink.documents import yamltext
from robolink.documents.yamlfile import read_text
from robolink.exceptions import DocumentError
from robolink.launch.ros.launch.bases import Place
from robolink.launch.ros.launch.frontend.parser import Parser as BaseParser
from robolink.launch.ros.launch.frontend.parser import SomeFile
from robolink.launch.ros.launch_yaml.entity import Entity, PlacedList

__all__ = [
    "Parser",
]


class Parser(BaseParser):
    """Parser of launch files in YAML."""

    @classmethod
    def load(cls, file: SomeFile) -> tuple[Entity, Parser]:
        """Return the `launch` element of a `file`, and a parser of it. Raises DocumentError with line and column."""
        if isinstance(file, (str, bytes, os.PathLike)):
            name = os.fsdecode(file)
            return _top(read_text(Path(name)), name), cls()
        return _top(file.read(), str(getattr(file, "name", "<text>"))), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the ends of names of files in YAML."""
        return {"launch.yaml", "launch.yml", "yaml", "yml", "launch"}


def _top(text: str, file: str) -> Entity:
    root = yamltext.compose(text, file)
    keys = [key.value for key, _ in root.value] if isinstance(root, yaml.MappingNode) else []
    if {"nodes", "include", "groups"} & set(keys):
        raise DocumentError(
            "it is one of robolink's own launch files, and those of ROS 2 include none of these", file, 1
        )
    if not isinstance(root, yaml.MappingNode) or keys != ["launch"]:
        raise DocumentError("a launch file of ROS 2 has one key, `launch`, with a list of actions", file, 1)
    top = Entity(_data(root.value[0][1], file), "launch")
    top.place = Place(file, root.value[0][0].start_mark.line + 1)
    return top


def _data(node: yaml.Node, file: str) -> Any:
    """Return YAML's value of a node; a list has the lines of its items."""
    if isinstance(node, yaml.MappingNode):
        return {str(key.value): _data(value, file) for key, value in node.value}
    if isinstance(node, yaml.SequenceNode):
        lines = [each.start_mark.line + 1 for each in node.value]
        return PlacedList([_data(each, file) for each in node.value], file, lines)
    if getattr(node, "style", None) is not None:
        return str(node.value)
    try:
        return yaml.safe_load(node.value)
    except (yaml.YAMLError, ValueError):
        return str(node.value)
