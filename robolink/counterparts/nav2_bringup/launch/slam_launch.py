"""slam_toolbox, which makes a map while the robot drives, and the server that saves it."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, SetParameter
from launch_ros.descriptions import ParameterFile
from nav2_common.launch import RewrittenYaml

PARAMETERS = Path(get_package_share_directory("nav2_bringup")) / "params" / "nav2_params.yaml"
ARGUMENTS = (
    ("namespace", "", "Namespace of all nodes."),
    ("use_sim_time", "false", "Follow /clock."),
    ("params_file", str(PARAMETERS), "Path of the file of parameters."),
    ("autostart", "true", "Activate the nodes at once."),
    ("use_respawn", "False", "Start a process again."),
    ("log_level", "info", "Level of the log."),
)
"""Names, defaults and meanings of the arguments."""


def generate_launch_description():
    """Describe the arguments, and both nodes with their lifecycle manager."""
    source, namespace = LaunchConfiguration("params_file"), LaunchConfiguration("namespace")
    file = ParameterFile(RewrittenYaml(source, {}, root_key=namespace, convert_types=True), allow_substs=True)
    common = {"arguments": ["--ros-args", "--log-level", LaunchConfiguration("log_level")]}
    again = {"respawn": LaunchConfiguration("use_respawn"), "respawn_delay": 2.0, "parameters": [file], **common}
    manager = {"autostart": LaunchConfiguration("autostart"), "node_names": ["map_saver", "slam_toolbox"]}
    nodes = [
        SetParameter("use_sim_time", LaunchConfiguration("use_sim_time")),
        Node(package="nav2_map_server", executable="map_saver_server", name="map_saver", **again),
        Node(
            package="slam_toolbox",
            executable="async_slam_toolbox_node",
            name="slam_toolbox",
            remappings=[("/scan", "scan"), ("/tf", "tf"), ("/tf_static", "tf_static"), ("/map", "map")],
            **again,
        ),
        Node(
            package="nav2_lifecycle_manager",
            executable="lifecycle_manager",
            name="lifecycle_manager_slam",
            parameters=[manager],
            **common,
        ),
    ]
    declared = [DeclareLaunchArgument(name, default_value=value, description=text) for name, value, text in ARGUMENTS]
    return LaunchDescription([*declared, GroupAction(nodes)])
