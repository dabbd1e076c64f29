"""zenoh-ros2-sdk, a ROS 2 peer over Zenoh without ROS; as it is by default, RELIABLE, but without a router between."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.messages.games import Beat, Count, Ping, Task, pour, say_ready
from benchmarks.messages.samples import SIDES, SPIN, counting, pixels, ranges

NAMES = {"twist": "geometry_msgs/msg/Twist", "stamped": "geometry_msgs/msg/TwistStamped"}
NAMES |= {"scan": "sensor_msgs/msg/LaserScan", "1mb": "sensor_msgs/msg/Image", "6mb": "sensor_msgs/msg/Image"}

SCAN_FLOATS = ("angle_min", "angle_max", "angle_increment", "time_increment", "scan_time", "range_min", "range_max")
DEFINITIONS = {
    "builtin_interfaces/msg/Time": "int32 sec\nuint32 nanosec\n",
    "std_msgs/msg/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
    "geometry_msgs/msg/Vector3": "float64 x\nfloat64 y\nfloat64 z\n",
    "geometry_msgs/msg/Twist": "Vector3 linear\nVector3 angular\n",
    "geometry_msgs/msg/TwistStamped": "std_msgs/Header header\nTwist twist\n",
    "sensor_msgs/msg/LaserScan": "std_msgs/Header header\n"
    + "".join(f"float32 {name}\n" for name in SCAN_FLOATS)
    + "float32[] ranges\nfloat32[] intensities\n",
    "sensor_msgs/msg/Image": "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
    "uint8 is_bigendian\nuint32 step\nuint8[] data\n",
}
"""Files that it would fetch from the net."""


class Peer:
    """A process with the SDK."""

    def __init__(self, task: Task, first: bool) -> None:
        self._port, self._name = 20_000 + int(os.environ["ROS_DOMAIN_ID"]), NAMES[task.kind]
        if first:
            own = f'listen/endpoints=["tcp/127.0.0.1:{self._port}"];connect/endpoints=[]'
            os.environ["ZENOH_CONFIG_OVERRIDE"] = own
        folder = tempfile.mkdtemp()
        os.environ["ZENOH_ROS2_SDK_CACHE"] = folder
        os.environ["GIT_PYTHON_REFRESH"] = "quiet"
        for name, text in DEFINITIONS.items():
            path = Path(folder, *name.split("/")).with_suffix(".msg")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        import zenoh_ros2_sdk

        self._sdk = zenoh_ros2_sdk
        zenoh_ros2_sdk.get_registry(folder)
        session = zenoh_ros2_sdk.ZenohSession.get_instance(router_port=self._port)
        for name, text in DEFINITIONS.items():
            session.register_message_type(text, name)
        self.session, self._types = session.session, session.store.types

    def publisher(self, topic: str) -> Any:
        return self._sdk.ROS2Publisher(topic, self._name, DEFINITIONS[self._name], router_port=self._port)

    def subscribe(self, topic: str, callback: Callable[[Any], object]) -> Any:
        return self._sdk.ROS2Subscriber(topic, self._name, callback, DEFINITIONS[self._name], router_port=self._port)

    def fields(self, kind: str) -> dict[str, Any]:
        """Return the arguments of `publish` for a message of this kind."""
        types = self._types
        header = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](0, 0), "frame")
        vector = types["geometry_msgs/msg/Vector3"]
        twist = {"linear": vector(0.3, 0.0, 0.0), "angular": vector(0.0, 0.0, SPIN)}
        if kind == "twist":
            return twist
        if kind == "stamped":
            return {"header": header, "twist": types["geometry_msgs/msg/Twist"](**twist)}
        if kind == "scan":
            arrays = {"ranges": np.array(ranges(), np.float32), "intensities": np.empty(0, np.float32)}
            return {"header": header, **dict.fromkeys(SCAN_FLOATS, 0.0), **arrays}
        width, height, channels, encoding = SIDES[kind]
        shape = {"height": height, "width": width, "encoding": encoding, "is_bigendian": 0, "step": width * channels}
        return {"header": header, **shape, "data": np.frombuffer(pixels(kind), np.uint8)}


def again(message: Any) -> dict[str, Any]:
    """The fields of a message that has come."""
    return {name: value for name, value in vars(message).items() if name != "__msgtype__"}


def pong(task: Task) -> None:
    peer = Peer(task, first=True)
    back = peer.publisher("pong")
    _keep = peer.subscribe("ping", lambda message: back.publish(**again(message)))
    say_ready()
    time.sleep(task.seconds + 60)


def ping(task: Task) -> None:
    peer, game = Peer(task, first=False), Ping(task.seconds, retry=3.0)
    out, fields = peer.publisher("ping"), peer.fields(task.kind)

    def on_pong(message: Any) -> None:
        if game.answered():
            out.publish(**fields)
        else:
            game.checked = all(np.all(getattr(message, name) == value) for name, value in fields.items())

    _keep = peer.subscribe("pong", on_pong)
    wait_for_match(out)
    game.play(lambda: out.publish(**fields), time.sleep)
    time.sleep(task.seconds + 60)


def sink(task: Task) -> None:
    peer, count = Peer(task, first=True), Count()
    _keep = peer.subscribe("flood", counting(task.kind, count.add))
    count.answer()
    say_ready()
    time.sleep(task.seconds + 60)


def source(task: Task) -> None:
    peer = Peer(task, first=False)
    out, fields = peer.publisher("flood"), peer.fields(task.kind)
    of, name = (fields["linear"], "x") if task.kind == "twist" else (fields["header"].stamp, "nanosec")

    def send(number: int) -> None:
        setattr(of, name, number)
        out.publish(**fields)

    wait_for_match(out)
    time.sleep(0.2)
    pour(task, send)


def beat(task: Task) -> None:
    peer = Peer(task, first=False)
    out, fields = peer.publisher("flood"), peer.fields(task.kind)
    wait_for_match(out)
    Beat(task, lambda: out.publish(**fields)).keep()


def wait_for_match(out: Any) -> None:
    """Wait until a subscription is known, and a little longer: the other way it is not known here."""
    while not out.pub.matching_status.matching:
        time.sleep(0.005)
    time.sleep(0.3)
