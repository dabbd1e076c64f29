"""A project whose tests use robolink's plugin for pytest."""

from __future__ import annotations

# pytester forgets what was imported meanwhile, and numpy cannot be imported twice.
import numpy  # noqa: F401
import pytest

import robolink.testing.one_process  # noqa: F401
import robolink.testing.processes  # noqa: F401
import robolink.testing.system  # noqa: F401

NODE = """
from robolink import Node
from robolink.interfaces.std_msgs.msg import Int32


class Counter(Node):
    def __init__(self):
        super().__init__("counter")
        self.count = 0
        self.publisher = self.create_publisher(Int32, "count", 10)
        self.create_timer(0.1, self.on_timer)

    def on_timer(self):
        self.count += 1
        self.publisher.publish(Int32(data=self.count))
"""


def run(project: pytest.Pytester, text: str, *options: str) -> pytest.RunResult:
    project.makepyfile(test_it="from counter import Counter\n" + text)
    return project.runpytest_inprocess("-p", "no:cacheprovider", "-p", "no:xdist", *options)
