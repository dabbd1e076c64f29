"""Reader of ROS 2's YAML launch files: `launch:` with a list of actions, to elements with their lines."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from robolink.companions.launch.bases import Place
from robolink.companions.launch_frontend.entity import Entity
from robolink.documents import yamltext
from robolink.documents.yamlfile import read_text
from robolink.exceptions import DocumentError
from robolink.system.terminal import shown

LISTED = ("arg", "let", "param", "remap", "env", "choice", "composable_node", "extra_arg", "keep", "children")
"""Keys whose list holds elements, not values."""
HOLDERS = ("launch", "group", "timer", "ros_timer")
"""Elements whose list holds actions."""


def read_yaml(path: Path) -> Entity:
    """Return the `launch` element of a YAML file, `path`. Raises DocumentError with line and column."""
    file = str(path)
    root = yamltext.compose(read_text(path), file)
    keys = [key.value for key, _ in root.value] if isinstance(root, yaml.MappingNode) else []
    if {"nodes", "include", "groups"} & set(keys):
        raise DocumentError(
            "it is one of robolink's own launch files, and those of ROS 2 include none of these", file, 1
        )
    if not isinstance(root, yaml.MappingNode) or keys != ["launch"]:
        raise DocumentError("a launch file of ROS 2 has one key, `launch`, with a list of actions", file, 1)
    return _element("launch", root.value[0][1], file)


def _element(tag: str, node: yaml.Node, file: str) -> Entity:
    """Return the element that stands under a key: a mapping of attributes, or a list of actions."""
    entity = Entity(tag, Place(file, node.start_mark.line + 1), is_typed=True)
    if isinstance(node, yaml.SequenceNode) and entity.name in HOLDERS:
        entity.children = _actions(node, file)
    elif isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            _add(entity, str(key.value), value, file)
    elif isinstance(node, yaml.ScalarNode) and not node.value.strip():
        pass
    else:
        raise entity.error("a mapping of its attributes is expected")
    return entity


def _add(entity: Entity, key: str, node: yaml.Node, file: str) -> None:
    is_held = key != "children" or entity.name in HOLDERS
    if key.replace("-", "_") in LISTED and isinstance(node, yaml.SequenceNode) and is_held:
        if key == "children":
            entity.children += _actions(node, file)
        else:
            entity.children += [_element(key, each, file) for each in node.value]
        return
    entity.attributes[key] = _value(node, file)


def _actions(node: yaml.SequenceNode, file: str) -> list[Entity]:
    found = []
    for each in node.value:
        if not isinstance(each, yaml.MappingNode) or len(each.value) != 1:
            line = each.start_mark.line + 1
            raise DocumentError("each action is a mapping with one key, such as `- node: {...}`", file, line)
        (key, value) = each.value[0]
        element = _element(str(key.value), value, file)
        element.place = Place(file, key.start_mark.line + 1)
        found.append(element)
    return found


def _value(node: yaml.Node, file: str) -> Any:
    """Return YAML's value of a text: a scalar, or a list of them."""
    if isinstance(node, yaml.SequenceNode):
        return [_value(each, file) for each in node.value]
    line = node.start_mark.line + 1
    if not isinstance(node, yaml.ScalarNode):
        raise DocumentError(f"a value is a text, a number or a list, got a mapping: {shown(str(node.tag))}", file, line)
    if node.style is not None:
        return str(node.value)
    try:
        return yaml.safe_load(node.value)
    except (yaml.YAMLError, ValueError):
        return str(node.value)
