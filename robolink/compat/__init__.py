"""ROS 2's own names: after `import robolink.compat`, `import rclpy` and its companions give robolink's modules.

    import robolink.compat  # in a conftest.py, say; or pytest -p robolink.compat
    import rclpy  # is robolink: the very same modules and classes
    from geometry_msgs.msg import Twist

`robolink run` does the same for what it runs, and prepares OpenCV for machines without a screen. There are rclpy, the
message packages, tf2_ros, tf2_py, tf2_geometry_msgs, tf2_sensor_msgs, tf_transformations, message_filters,
sensor_msgs_py, cv_bridge, image_geometry, diagnostic_updater, rosidl_runtime_py, ament_index_python, rosbag2_py,
nav2_common.launch, nav2_simple_commander (its robot_navigator and utils), launch, launch_ros, launch_testing,
launch_testing_ros and webots_ros2_driver (WebotsController, and what launch files start).

ROS_DISTRO, ROS_VERSION and ROS_PYTHON_VERSION are set as a sourced ROS 2 sets them, where they are not.

Types of a workspace's own `.msg`, `.srv` and `.action` files can be imported, too: of the workspace in which the file
lies that imports them, or of the user's.

**All or none.** These modules hand each other their classes, so they are robolink's together or not at all. Where a
real rclpy is installed, the import above leaves all of them alone. `robolink run` does not: whoever asks robolink to
run a program wants it on robolink's network, and has `ros2 run` and `python` for the other; a real rclpy is hidden
from that one process. The variable ROBOLINK_COMPAT, or `activate`, decides otherwise: `always` takes robolink's in
any case, `never` none, `auto` is the rule of the import. A file of the user's own that has one of these names
(a `tf_transformations.py` beside the script) is found before robolink's; those that cannot run from a folder, such as
rclpy, launch, tf2_py and webots_ros2_driver, are never taken from there: a checkout is none that is installed.
"""

from __future__ import annotations

import os
import sys

from robolink.compat.hooks import hand_on, prepare_opencv, workspace_types
from robolink.compat.maker import MAKER, has_rclpy, hidden
from robolink.exceptions import RobolinkError
from robolink.system.processes import set_ros_version
from robolink.workspace.modules import FINDER

VARIABLE = "ROBOLINK_COMPAT"
"""Environment variable that overrules the mode."""
AUTO, ALWAYS, NEVER = MODES = ("auto", "always", "never")

__all__ = ["ALWAYS", "AUTO", "NEVER", "VARIABLE", "CompatError", "activate", "is_active", "prepare_opencv"]


class CompatError(RobolinkError, ImportError):
    """ROS 2's names cannot be robolink's: the real rclpy is in use already, or the mode is unknown."""


def activate(mode: str = AUTO) -> bool:
    """Make ROS 2's names robolink's, by the rule above; True if they are. ROBOLINK_COMPAT overrules `mode`.

    Raises CompatError for an unknown mode, and for `always` when a real rclpy has been imported before.
    """
    mode = os.environ.get(VARIABLE) or mode
    if mode not in MODES:
        raise CompatError(f"{VARIABLE}: expected {', '.join(MODES)}, got '{mode}'")
    if is_active():
        set_ros_version()  # somebody may have changed the environment since
        return True
    loaded = sys.modules.get("rclpy")
    is_foreign = loaded is not None and loaded is not sys.modules["robolink"]
    if mode == ALWAYS and is_foreign:
        place = getattr(loaded, "__file__", None) or "elsewhere"
        raise CompatError(f"rclpy has been imported from {place} before: import robolink.compat earlier")
    if mode == NEVER or (mode == AUTO and (is_foreign or has_rclpy())):
        return False
    set_ros_version()
    FINDER.hides = hidden
    FINDER.add(workspace_types, first=True)
    FINDER.add(MAKER)
    hand_on(enter_child, mode)
    return True


def enter_child(mode: str, with_opencv: bool, files: list[str]) -> None:
    """Take the names in a new process of `multiprocessing`, and load the files that its parent has loaded.

    Args:
        mode: Mode of `activate`.
        with_opencv: True prepares OpenCV, too.
        files: Paths, which are the names of the files' modules; functions and classes of these may be pickled.
    """
    if activate(mode) and with_opencv:
        prepare_opencv()
    if files:
        from pathlib import Path

        from robolink.workspace.load import load_module

        for each in files:
            load_module(Path(each))


def is_active() -> bool:
    """True while ROS 2's names are robolink's in this process."""
    return MAKER in FINDER.makers and FINDER in sys.meta_path


activate()
