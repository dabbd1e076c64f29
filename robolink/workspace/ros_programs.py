"""Advice for programs of ROS 2's own packages that robolink lacks: what does the same here."""

from __future__ import annotations

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.workspace.source import canonical

_DRAW = "robolink draws with 'robolink plot' and 'robolink world draw'"
_ANYWHERE = "on a machine with ROS 2 it sees the same topics (docs/ros2.md)"
_WORLD = "a world to drive in is 'robolink run world'"

PROGRAMS = {
    ("demo_nodes_py", "talker"): "'robolink pub /chatter String \"{data: hello}\"' publishes as it does",
    ("demo_nodes_cpp", "talker"): "'robolink pub /chatter String \"{data: hello}\"' publishes as it does",
    ("demo_nodes_py", "listener"): "'robolink topic echo /chatter' hears as it does",
    ("demo_nodes_cpp", "listener"): "'robolink topic echo /chatter' hears as it does",
    ("tf2_ros", "tf2_echo"): "here it is 'robolink tf echo SOURCE_FRAME TARGET_FRAME'",
    ("tf2_ros", "tf2_monitor"): "here it is 'robolink tf monitor'",
    ("tf2_tools", "view_frames"): "here it is 'robolink tf tree'",
    ("rmw_zenoh_cpp", "rmw_zenohd"): "robolink needs no router, and meets one that runs (docs/ros2.md)",
}
"""Advice by package and program."""
PACKAGES = {
    "rviz2": f"{_DRAW}; {_ANYWHERE}",
    "rqt_graph": f"'robolink launch FILE --graph' draws nodes and topics; {_ANYWHERE}",
    "rqt_plot": f"'robolink plot topic' draws values; {_ANYWHERE}",
    "rqt": f"'robolink topic hz' and 'robolink topic echo' look, 'robolink plot' draws; {_ANYWHERE}",
    "rqt_gui": f"'robolink topic hz' and 'robolink topic echo' look, 'robolink plot' draws; {_ANYWHERE}",
    "demo_nodes_py": "first nodes are 'robolink run first_node' and 'robolink run velocity_publisher'",
    "demo_nodes_cpp": "first nodes are 'robolink run first_node' and 'robolink run velocity_publisher'",
    "tf2_ros": "here there are 'robolink tf' and 'robolink run static_transform_publisher'",
    "tf2_tools": "here there is 'robolink tf tree'",
    "turtlesim": f"{_WORLD}, and 'robolink run teleop' drives by the keyboard",
    "gazebo_ros": _WORLD,
    "ros_gz_sim": _WORLD,
    "webots_ros2_driver": f"{_WORLD}, which reads Webots' worlds (docs/webots.md)",
    "robot_state_publisher": "fixed frames are published by 'robolink run static_transform_publisher'",
    "nav2_bringup": "'robolink launch goto' drives to the goals of Nav2's action",
    "slam_toolbox": f"nothing here makes maps; {_ANYWHERE}",
}
"""Advice by package, for any program of it."""


class RosProgramError(NotFoundError):
    """A program of ROS 2 was asked for that robolink lacks; the text has what does the same."""

    def __init__(self, package: str, program: str, advice: str) -> None:
        self.kind, self.name = "package", package
        RobolinkError.__init__(self, f"{package} {program}".rstrip() + f" is ROS 2's own and not here: {advice}")


def ros_program_error(package: str, program: str = "") -> RosProgramError | None:
    """Return the error for the program `program` of ROS 2's own `package`; None for a package that is not known."""
    known = canonical(package)
    advice = PROGRAMS.get((known, canonical(program))) or PACKAGES.get(known)
    return None if advice is None else RosProgramError(package, program, advice)
