"""Table of ROS 2's module names and robolink's modules, and advice for the names that have none."""

from __future__ import annotations

import re

from robolink.compat.launch_names import LAUNCH_ROOMS
from robolink.extensions.optional import is_here

OPTIONAL = {
    "webots_ros2_driver": "robolink.webots_controller",
    **{
        f"webots_ros2_driver.{name}": f"robolink.companions.webots_ros2_driver.{name}"
        for name in ("urdf_spawner", "utils", "wait_for_controller_connection", "webots_launcher")
    },
}
"""Modules that an installation may lack, by name."""

ROOMS = {
    "rclpy": "robolink",
    "tf2_ros": "robolink.tf2",
    "tf2_py": "robolink.tf2",
    "tf2_geometry_msgs": "robolink.tf2.geometry",
    "tf2_geometry_msgs.tf2_geometry_msgs": "robolink.tf2.geometry",
    "tf2_sensor_msgs": "robolink.tf2.point_cloud",
    "tf2_sensor_msgs.tf2_sensor_msgs": "robolink.tf2.point_cloud",
    "tf_transformations": "robolink.geometry.transformations",
    "message_filters": "robolink.companions.message_filters",
    "cv_bridge": "robolink.companions.cv_bridge",
    "cv_bridge.boost": "",
    "cv_bridge.boost.cv_bridge_boost": "robolink.companions.cv_bridge.functions",
    "image_geometry": "robolink.companions.image_geometry",
    "image_geometry.cameramodels": "robolink.companions.image_geometry",
    "sensor_msgs_py": "",
    "sensor_msgs_py.numpy_compat": "robolink.sensor_msgs_py.numpy_compat",
    "sensor_msgs_py.point_cloud2": "robolink.sensor_msgs_py.point_cloud2",
    "rosidl_parser": "",
    "rosidl_parser.definition": "robolink.message.slot_types",
    "rosidl_runtime_py": "robolink.companions.rosidl_runtime",
    "turtlesim_msgs": "robolink.interfaces.turtlesim",
    "ament_index_python": "robolink.companions.ament_index",
    "rosbag2_py": "robolink.companions.rosbag2_py",
    "diagnostic_updater": "robolink.companions.diagnostic_updater",
    "launch_testing": "robolink.companions.launch_testing",
    "launch_testing_ros": "robolink.companions.launch_testing_ros",
    "nav2_common": "robolink.companions.nav2_common",
    "nav2_simple_commander": "robolink.companions.nav2_simple_commander",
    **LAUNCH_ROOMS,
    **{name: room for name, room in OPTIONAL.items() if is_here(room)},
}
"""Modules by name; '' is a package with nothing in it. A name below another is below its module."""

INSTEAD = {
    "launch_pytest": "pytest runs its tests, robolink.testing has system.launch() (docs/reference/testing.md)",
    "launch.exit_handler": "that is ROS 2 before Bouncy (2018): Node(respawn=True, on_exit=...) is what it has now",
    "launch.legacy": "that is ROS 2 before Bouncy (2018): launch.actions and launch_ros.actions are what it has now",
    "tf2_kdl": "tf2_geometry_msgs transforms the types of geometry_msgs, tf_transformations has the matrices",
    "tf2_eigen": "tf2_geometry_msgs transforms the types of geometry_msgs, tf_transformations has the matrices",
    "tf": "that is ROS 1: tf2_ros has the listener and the broadcaster, tf_transformations the angles",
    "rospy": "that is ROS 1: rclpy is what ROS 2 has",
    "roslib": "that is ROS 1, and ROS 2 needs nothing in its place",
    "rosbag": "that is ROS 1: 'robolink bag' and rosbag2_py have the bags of ROS 2",
    "actionlib": "that is ROS 1: rclpy.action has ActionServer and ActionClient",
    "move_base_msgs": "that is ROS 1: nav2_msgs.action.NavigateToPose is what ROS 2 has",
    "uuid_msgs": "that is ROS 1: unique_identifier_msgs is what ROS 2 has",
    "sensor_msgs.point_cloud2": "that is ROS 1: sensor_msgs_py.point_cloud2 is what ROS 2 has",
    "PyKDL": "tf_transformations has rotations and matrices, tf2_geometry_msgs transforms the types of geometry_msgs",
    "rosidl_adapter": "robolink.interfaces.find returns the class of a type, and no code is generated",
    "rosidl_generator_py": "robolink.interfaces.find returns the class of a type, and no code is generated",
    "py_trees_ros": "py_trees works as it is, with a timer that ticks the tree",
    "image_transport": "publish and subscribe to sensor_msgs.msg.Image or CompressedImage",
    "controller_manager": "it needs ros2_control",
    "moveit": "it needs MoveIt",
    "moveit_commander": "it needs MoveIt",
    "moveit_configs_utils": "it needs MoveIt",
    "xacro": "it is on PyPI: pip install xacro",
}
"""Advice for the names that programs for ROS 2 import and that robolink lacks; a name may be below another."""

INTERFACES = r"[a-z][a-z0-9_]*_(?:msgs|interfaces|srvs|actions)"
"""Pattern of message packages, as text."""
LINTERS = r"ament_(?:copyright|flake8|pep257|xmllint|mypy|cpplint|lint)"
"""Pattern of ament's linters, as text: a program that lacks nothing need not wait until it is compiled."""
COMMANDS = r"ros2(?:cli|action|bag|component|interface|launch|lifecycle|node|param|pkg|run|service|topic)"
"""Pattern of the packages of ROS 2's command line, as text."""


def instead_of(name: str) -> str:
    """Return advice for a name that robolink lacks; '' for a name that is not ROS's."""
    if name in INSTEAD:
        return INSTEAD[name]
    if re.fullmatch(COMMANDS, name):
        return "'robolink' is the command line, and a node's methods, such as get_topic_names_and_types, read the graph"
    if re.fullmatch(LINTERS, name):
        return "it only checks how a package's files are written; ruff does"
    if re.fullmatch(INTERFACES, name):
        return f"put its files into interfaces/{name}/msg (srv, action) of your workspace, or the package into src/"
    return ""


def snake_case(type_name: str) -> str:
    """Return a type's name as rosidl names the module that defines it.

    >>> snake_case("PointCloud2"), snake_case("TFMessage")
    ('point_cloud2', 'tf_message')
    """
    parted = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", type_name)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", parted).lower()
