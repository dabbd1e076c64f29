"""A process with one node that has a publisher and a subscription; how long it took to make it, and then it idles.

    python benchmarks/messages/alone.py nodes|bare|ros2_sdk

It writes JSON: when it began (time.monotonic()), and the processor time until its node was made, in seconds. What it
imports before is part of neither, so that is next to nothing.
"""

from __future__ import annotations

import importlib
import os
import sys
import time

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Any

begun, used = time.monotonic(), time.process_time()
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))  # noqa: PTH100, PTH120 - imports


def nodes() -> Iterator[None]:
    """Make a node by rclpy's API: robolink's, or that of a real one, which has no robolink beside it."""
    try:  # noqa: SIM105 - contextlib is not imported before
        import robolink.compat  # noqa: F401
    except ImportError:
        pass
    rclpy: Any = importlib.import_module("rclpy")
    twist: Any = importlib.import_module("geometry_msgs.msg").Twist
    rclpy.init()
    node = rclpy.create_node("alone")
    yield
    node.create_publisher(twist, "out", 10)
    node.create_subscription(twist, "in", print, 10)
    yield
    rclpy.spin(node)


def bare() -> Iterator[None]:
    """Open a session, and announce itself as a node does."""
    import zenoh

    session = zenoh.open(zenoh.Config.from_json5(os.environ["ROBOLINK_BENCH_CONFIG"]))
    domain = os.environ["ROS_DOMAIN_ID"]
    _token = session.liveliness().declare_token(f"@ros2_lv/{domain}/alone/NN/alone")
    yield
    _out = session.declare_publisher("bench/out")
    _in = session.declare_subscriber("bench/in", print)
    yield
    time.sleep(600.0)


def ros2_sdk() -> Iterator[None]:
    """A publisher and a subscription of zenoh-ros2-sdk, of which each is a node."""
    sys.path.insert(0, ROOT)
    from benchmarks.messages.games import Task
    from benchmarks.messages.ros2_sdk import Peer

    peer = Peer(Task("twist", 0.0, "", 0), first=False)
    _out = peer.publisher("out")
    yield
    _in = peer.subscribe("in", print)
    yield
    time.sleep(600.0)


del sys.path[0]  # this folder, whose modules are nobody's business
steps = globals()[sys.argv[1]]()
next(steps)
took = time.process_time() - used
next(steps)
print(f"[{begun}, {took}]", flush=True)
next(steps, None)
