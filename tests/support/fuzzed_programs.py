"""Every program that robolink ships, found in its registries, with the command line that the fuzz starts it with.

A new node or counterpart is in the list by itself; one that does not start without arguments fails the test until
it has a row in ARGUMENTS.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from robolink.workspace import program_names
from robolink.workspace.source import built_in_workspace
from tests.support.urdfs import ARM

ROOT = Path(__file__).parents[2]
COMPANIONS = Path(__file__).parent / "companion_nodes"
"""Folder of small programs that use one companion each as users do: what reaches them goes through its callbacks."""


class Fuzzed(NamedTuple):
    """A program: its spec for `find_node`, and its arguments."""

    name: str
    args: tuple[str, ...] = ()

    @property
    def published(self) -> dict[str, str]:
        """Types by topic of what it listens to only once somebody publishes it."""
        return PUBLISHED if self.name.startswith("topic_tools") else {}

    @property
    def ends(self) -> bool:
        """True if it ends by itself once it is done."""
        return self.name.startswith(ENDING)


def _parameters(**values: str) -> tuple[str, ...]:
    words = [word for name, value in values.items() for word in ("-p", f"{name}:={value}")]
    return ("--ros-args", *words)


ARGUMENTS: dict[str, tuple[str, ...]] = {
    "robot_state_publisher robot_state_publisher": _parameters(robot_description=ARM),
    "joint_state_publisher joint_state_publisher": _parameters(source_list="[/more_joints]"),
    "static_transform_publisher": ("--x", "1", "--frame-id", "map", "--child-frame-id", "odom"),
    "tf2_ros static_transform_publisher": ("--x", "1", "--frame-id", "map", "--child-frame-id", "odom"),
    "tf2_ros tf2_echo": ("map", "base_link"),
    "topic_tools delay": _parameters(input_topic="/chatter", delay="0.05"),
    "topic_tools demux": _parameters(input_topic="/chatter", output_topics="[/one, /two]"),
    "topic_tools drop": ("/chatter", "2", "3"),
    "topic_tools mux": ("/out", "/chatter", "/other"),
    "topic_tools relay": ("/odom", "/out"),
    "topic_tools relay_field": ("/odom", "/out", "geometry_msgs/msg/Pose", "{position: {x: m.pose.pose.position.x}}"),
    "topic_tools throttle": ("messages", "/chatter", "5.0", "/out"),
    "topic_tools transform": ("/imu", "/out", "std_msgs/msg/Float64", "m.orientation.w * 2 / m.orientation.x"),
    "nav2_map_server map_server": _parameters(yaml_filename=str(ROOT / "tests/data/fuzz/map.yaml")),
    "nav2_map_server costmap_filter_info_server": _parameters(type="0", filter_info_topic="/info", mask_topic="/mask"),
    "nav2_lifecycle_manager lifecycle_manager": _parameters(node_names="[one, two]", autostart="true"),
}
"""Words of the command line of what needs some, or does more with them."""
NO_NODES = {
    "joy joy_enumerate_devices": "it lists gamepads and ends",
    "xacro xacro": "it reads a file and ends",
    "tf2_tools view_frames": "it listens for five seconds, writes a file and ends; tf2_monitor has the same listener",
    **{
        f"{package} {name}": "it is `robolink view`, which opens a port; tests/view feeds it"
        for package, names in program_names().items()
        for name in names
        if package.startswith(("rqt", "rviz"))
    },
}
"""Programs that are not fuzzed, each with its reason."""
PUBLISHED = {
    "/chatter": "std_msgs/msg/String",
    "/other": "std_msgs/msg/String",
    "/odom": "nav_msgs/msg/Odometry",
    "/imu": "sensor_msgs/msg/Imu",
}
ENDING = (
    "patrol",
    "square",
    "demo_nodes_cpp add_two_ints_client",
    "demo_nodes_cpp add_two_ints_client_async",
    "demo_nodes_py add_two_ints_client",
    "demo_nodes_py add_two_ints_client_async",
    "demo_nodes_py async_param_client",
    "demo_nodes_py listener_qos",
    "demo_nodes_py talker_qos",
    "examples_rclpy_minimal_client",
    "examples_rclpy_minimal_action_client",
    "lifecycle lifecycle_service_client",
    "nav2_map_server map_saver_cli",
    "tf2_ros tf2_monitor",
)
"""Programs that end by themselves once they are answered; they are started again, and must not raise."""


def programs() -> Iterator[Fuzzed]:
    """Iterate over all shipped programs that have a node."""
    found = [each.stem for each in sorted((built_in_workspace() / "nodes").glob("*.py"))]
    found += [f"{package} {name}" for package, names in program_names().items() for name in names]
    found += [str(each) for each in sorted(COMPANIONS.glob("*.py")) if each.stem != "__init__"]
    for name in found:
        if name not in NO_NODES:
            yield Fuzzed(name, ARGUMENTS.get(name, ()))
