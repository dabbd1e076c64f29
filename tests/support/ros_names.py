"""ROS 2's module names for tests of robolink.compat: those that are imported, and what an import raises."""

from __future__ import annotations

import functools
import sys

import pytest

import robolink
from robolink.interfaces.standard import packages

MODE = "ROBOLINK_COMPAT"

COMPANIONS = [
    "rclpy",
    "tf2_ros",
    "tf2_py",
    "tf2_geometry_msgs",
    "tf2_sensor_msgs",
    "tf_transformations",
    "message_filters",
    "sensor_msgs_py",
    "rosidl_runtime_py",
    "ament_index_python",
    "cv_bridge",
    "image_geometry",
    "image_transport",
    "launch",
    "launch_ros",
    "diagnostic_updater",
    "launch_pytest",
    "launch_testing",
    "launch_testing_ros",
    "launch_xml",
    "launch_yaml",
    "nav2_common",
    "nav2_simple_commander",
    "rosbag2_py",
    "rosidl_parser",
    "turtlesim_msgs",
    "webots_ros2_driver",
]


def is_ros(name: str) -> bool:
    """Return whether a module is there through robolink.compat or these tests, or is a part of it."""
    return name.startswith("robolink.compat") or name.partition(".")[0] in _tops()


@functools.cache
def _tops() -> frozenset[str]:
    return frozenset({*packages(), *COMPANIONS})


def forget() -> None:
    for name in filter(is_ros, list(sys.modules)):
        del sys.modules[name]
    vars(robolink).pop("compat", None)
    for module in [each for name, each in sys.modules.items() if name.startswith("robolink.")]:
        asked = vars(module).get("__getattr__")
        if isinstance(asked, functools.partial):  # with robolink's own at the end, if there is one
            vars(module).update(__getattr__=asked.args[-1])
            if asked.args[-1] is None:
                del vars(module)["__getattr__"]


def raised(code: str) -> Exception:
    with pytest.raises((ImportError, AttributeError)) as caught:
        exec(code, {})
    return caught.value


VERSION = "robolink " + robolink.__version__
