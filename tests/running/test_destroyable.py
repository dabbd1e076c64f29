"""Handles as rclpy's entities have them: they say whether their owner is still in use."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from robolink import Context, Node
from robolink.action import ActionClient, ActionServer
from robolink.exceptions import InvalidHandle
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger


def nothing(*_: object) -> None:
    pass


MAKERS: list[Callable[[Node], Any]] = [
    lambda node: node.create_publisher(Int32, "topic", 10),
    lambda node: node.create_subscription(Int32, "topic", nothing, 10),
    lambda node: node.create_service(Trigger, "service", nothing),
    lambda node: node.create_client(Trigger, "service"),
    lambda node: node.create_timer(1.0, nothing),
    lambda node: node.create_guard_condition(nothing),
]


@pytest.mark.parametrize("make", MAKERS)
def test_a_handle_is_of_use_until_its_owner_is_destroyed(context: Context, make: Callable[[Node], Any]) -> None:
    made = make(Node("node", context=context))
    assert made.handle
    with made.handle as handle:
        assert handle is made.handle
        assert handle.pointer == id(made)
    made.destroy()
    with pytest.raises(InvalidHandle, match=f"the {type(made).__name__} of this handle has been"), made.handle:
        pass


def test_a_nodes_handle(context: Context) -> None:
    node = Node("node", context=context)
    with node.handle:
        pass
    node.destroy_node()
    with pytest.raises(InvalidHandle, match="the Node of this handle has"), node.handle:
        pass


def test_a_handle_keeps_nobody_alive(context: Context) -> None:
    guard = Node("node", context=context).create_guard_condition(nothing)
    owner = type(guard)(None, None)
    handle = owner.handle
    del owner
    with pytest.raises(InvalidHandle), handle:
        pass


@pytest.mark.parametrize(
    "make",
    [
        *MAKERS,
        lambda node: node.create_rate(1.0),
        lambda node: ActionServer(node, Fibonacci, "action", nothing),
        lambda node: ActionClient(node, Fibonacci, "action"),
    ],
)
def test_a_node_that_has_been_destroyed_makes_nothing(context: Context, make: Callable[[Node], Any]) -> None:
    watcher = Node("watcher", context=context)
    before = watcher.get_topic_names_and_types(), watcher.get_service_names_and_types()
    node = Node("node", context=context)
    node.destroy_node()
    with pytest.raises(InvalidHandle, match="destroyed"):
        make(node)
    assert (watcher.get_topic_names_and_types(), watcher.get_service_names_and_types()) == before
    assert node._entity_store_.entities() == []


@pytest.mark.parametrize(
    "ask",
    [
        lambda node: node.create_publisher(Int32, "topic", 10).get_subscription_count,
        lambda node: node.create_subscription(Int32, "topic", nothing, 10).get_publisher_count,
        lambda node: node.create_client(Trigger, "service").service_is_ready,
        lambda node: node.create_client(Trigger, "service").wait_for_service,
        lambda node: node.create_timer(1.0, nothing).is_canceled,
    ],
)
def test_who_asks_what_has_been_destroyed_is_told(context: Context, ask: Callable[[Node], Any]) -> None:
    question = ask(Node("node", context=context))
    question.__self__.destroy()
    with pytest.raises(InvalidHandle, match="has been destroyed"):
        question()


@pytest.mark.parametrize("name", ["get_topic_names_and_types", "get_node_names"])
def test_who_asks_a_destroyed_node_is_told(context: Context, name: str) -> None:
    node = Node("node", context=context)
    node.destroy_node()
    with pytest.raises(InvalidHandle, match="the node has been destroyed"):
        getattr(node, name)()
