"""Nodes in memory for tests of commands: the commands run in the same process and see them as if in another."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from robolink import Context, Node
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.qos import DurabilityPolicy, QoSProfile

LATCHED = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
NUMBERS = itertools.count()


@contextmanager
def a_context_that_commands_see(monkeypatch: pytest.MonkeyPatch) -> Iterator[Context]:
    """A context on domain 7 of a network of its own that commands use too while this lasts."""
    url = f"memory://commands{next(NUMBERS)}"
    monkeypatch.setenv("ROBOLINK_TRANSPORT", url)
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    context = Context(transport=url)
    context.init([])
    with context:
        yield context


@contextmanager
def a_node_that_commands_see(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    """The node /lab/robot in such a context."""
    with a_context_that_commands_see(monkeypatch) as context:
        yield made(context, "robot", "/lab")


def made(context: Context, name: str, namespace: str = "") -> Node:
    """A node with nothing of its own but /parameter_events and ~/get_type_description."""
    return Node(name, context=context, namespace=namespace, enable_rosout=False, start_parameter_services=False)


@contextmanager
def spinning(*nodes: Node, threads: int = 1) -> Iterator[None]:
    """Spin nodes beside the test, as in another process."""
    context = nodes[0].context
    with (
        MultiThreadedExecutor(threads, context=context) if threads > 1 else SingleThreadedExecutor(context=context)
    ) as executor:
        for node in nodes:
            executor.add_node(node)
        thread = threading.Thread(target=executor.spin)
        thread.start()
        try:
            yield
        finally:
            executor.shutdown()
            thread.join()


def when_said(monkeypatch: pytest.MonkeyPatch, module: Any, function: str, action: Callable[[str], object]) -> None:
    """Do something whenever a module of the command line has said something: by its `say` or its `tell`."""
    original = getattr(module, function)

    def speak(text: str, **options: Any) -> None:
        original(text, **options)
        action(text)

    monkeypatch.setattr(module, function, speak)


def press_ctrl_c(text: str) -> None:
    """Do what Ctrl-C does."""
    raise KeyboardInterrupt


def latch(node: Node, topic: str, *messages: Any) -> None:
    """Publish messages that whoever comes later gets too."""
    publisher = node.create_publisher(type(messages[0]), topic, LATCHED)
    for message in messages:
        publisher.publish(message)
