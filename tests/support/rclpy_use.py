"""Table of the rclpy features that public programs use, each with the test that shows its documented behaviour."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

USE: dict[str, Any] = json.loads((Path(__file__).parents[1] / "data" / "rclpy_use.json").read_text(encoding="utf-8"))
"""Names that were found in 741 files of 69 repositories, the most used first."""

SHOWN: dict[str, str] = {}
"""By row: the test that shows it."""

OTHERS = {
    "Duration(sec=)": "of builtin_interfaces/msg/Duration",
    "Duration(nanosec=)": "of builtin_interfaces/msg/Duration",
    "Time(sec=)": "of builtin_interfaces/msg/Time",
    "Time(nanosec=)": "of builtin_interfaces/msg/Time",
    "ActionClient(wait_for_server_timeout_sec=)": "of a class of py_trees_ros",
    "ActionClient(action_goal=)": "of a class of py_trees_ros",
    "ActionClient(name=)": "of a class of py_trees_ros",
    "Node.__init__(name=)": "of a class of the program's own",
    "Node.__init__(topic_name=)": "of a class of py_trees_ros",
    "Node.__init__(qos_profile=)": "of a class of py_trees_ros",
    "Node.__init__(clearing_policy=)": "of a class of py_trees_ros",
    "Node.__init__(topic_type=)": "of a class of py_trees_ros",
    "Node.__init__(flags=)": "of a class of the program's own",
    "Node.__init__(measurement_noise=)": "of a class of the program's own",
    "Node.__init__(initial_state=)": "of a class of the program's own",
    "shutdown(wait=)": "of concurrent.futures.Executor",
    "ActionClient.execute": "of ServerGoalHandle, by the same name",
    "ActionServer.execute": "of ServerGoalHandle, by the same name",
}
"""Rows that were counted by their name, but are none of rclpy's, and whose they are."""


OUT_OF_SCOPE = {
    "launch": "ROS 2's launch, a package of its own; robolink launches YAML files",
    "launch_testing": "ROS 2's launch; a robot system is a unit test here",
    "cv2": "a library that the program's user installs",
    "matplotlib": "a library that the program's user installs",
    "controller_manager": "a part of ros2_control, in C++",
    "webots_ros2_tests": "a part of Webots' ROS packages",
    "my_robot_interfaces": "types of the program's own, which a workspace's files define",
    "turtlesim_interfaces": "types of the program's own, which a workspace's files define",
    "dynoturtle_interfaces": "types of the program's own, which a workspace's files define",
    "async_utils": "a module of the program's own",
    "utils": "a module of the program's own",
    "transform_utils": "a module of the program's own",
}
"""By package: why what is imported from it is not robolink's to give."""


def rows() -> Iterator[str]:
    """Each row of the tables of attributes and keyword arguments: ``Node.get_name``, ``spin_once(timeout_sec=)``."""
    for owner, names in USE["attributes"].items():
        yield from (f"{owner}.{name}" for name in names)
    for function, keywords in USE["keywords"].items():
        yield from (f"{function}({keyword}=)" for keyword in keywords)


def shows(*names: str) -> Callable[[Function], Function]:
    """Note that a test shows what these rows do."""

    def note(test: Function) -> Function:
        SHOWN.update(dict.fromkeys(names, test.__name__))
        return test

    return note
