"""Components of ROS packages: each leads to a class of Node that can be made without arguments."""

from __future__ import annotations

import inspect

import pytest

from robolink.node import Node
from robolink.workspace import component, components, load_node
from robolink.workspace.node_factory import check_needs_nothing


@pytest.mark.parametrize("plugin", components())
def test_every_component_is_a_class_of_node(plugin: str) -> None:
    source = component(plugin)
    assert source is not None
    found = load_node(source)
    assert inspect.isclass(found)
    assert issubclass(found, Node)
    check_needs_nothing(found)
