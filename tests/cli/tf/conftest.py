"""Fixtures for tests of `robolink tf`: a node that the commands see, and transforms that are broadcast repeatedly."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from robolink import Node
from robolink.cli.tf import watch
from robolink.tf2 import TransformBroadcaster
from robolink.time import Time
from tests.support.seen_by_commands import a_node_that_commands_see


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    monkeypatch.setattr(watch, "PATIENCE", 0.05)
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


@pytest.fixture
def again(node: Node) -> Iterator[Callable[..., None]]:
    """Broadcast transforms again and again, stamped with the time, until the end: `again(transforms, node)`."""
    end, threads = threading.Event(), []

    def start(*transforms: Any, by: Node = node, age: float = 0.0) -> None:
        broadcaster = TransformBroadcaster(by)

        def broadcast() -> None:
            while not end.wait(0.005):
                for each in transforms:
                    each.header.stamp = Time(nanoseconds=time.time_ns() - int(age * 1e9)).to_msg()
                broadcaster.sendTransform(list(transforms))

        threads.append(threading.Thread(target=broadcast))
        threads[-1].start()

    yield start
    end.set()
    for thread in threads:
        thread.join()
