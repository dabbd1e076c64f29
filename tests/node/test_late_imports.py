"""Late imports: a node with a publisher and a subscription is announced without modules that only few nodes use."""

from __future__ import annotations

import subprocess
import sys

import pytest

NODE = """
import sys

sys.modules["typing_extensions"] = None  # where it is installed, msgspec imports it, and with it inspect
import robolink.compat
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

rclpy.init()
node = Node("node")
node.create_publisher(Twist, "sent", 10)
node.create_subscription(Twist, "received", lambda message: None, 10)
node.get_logger().debug("ready")
print(*sorted(sys.modules))
rclpy.try_shutdown()
"""

LATE = {
    *("argparse", "ast", "asyncio", "concurrent.futures", "dataclasses", "dis", "fnmatch", "hashlib", "_hashlib"),
    *("importlib.metadata", "inspect", "ipaddress", "json", "linecache", "logging", "multiprocessing", "numpy"),
    *("pathlib", "random", "socket", "ssl", "subprocess", "tempfile", "tokenize", "traceback", "typer"),
    *("urllib.parse", "yaml"),
    *("robolink.workspace.find", "robolink.transport.certificates", "robolink.transport.addresses"),
    *("robolink.networks.refusals", "robolink.running.ports", "robolink.interfaces.service_msgs.msg"),
}
"""What must not be imported: together these took a third of a node's start, and a sixth of its memory."""


@pytest.mark.processes
def test_an_announced_node_has_imported_none_of_what_few_nodes_use() -> None:
    done = subprocess.run([sys.executable, "-c", NODE], capture_output=True, text=True, check=True)
    imported = set(done.stdout.split())
    assert {"robolink.node", "robolink.transport.zenoh", "geometry_msgs.msg"} <= imported
    assert imported & LATE == set()


DEFERRED = """
from robolink import Context, Node
from robolink.interfaces.rcl_interfaces.srv import GetParameters
from robolink.message.class_factory import is_deferred
from robolink.running.timebase import VirtualTime
from robolink.transport.memory import Bus, MemoryTransport

context = Context(transport=MemoryTransport(bus=Bus()), time=VirtualTime())
context.init([])
node = Node("node", context=context)
print([each.srv_type.__name__ for each in node.services if not is_deferred(each.srv_type)])
GetParameters.Request()
print([each.srv_type.__name__ for each in node.services if not is_deferred(each.srv_type)])
"""


@pytest.mark.processes
def test_the_messages_of_a_nodes_own_services_are_made_when_one_is_asked_for() -> None:
    done = subprocess.run([sys.executable, "-c", DEFERRED], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n['GetParameters']\n"
