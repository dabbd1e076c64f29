"""A whole navigation: a map and a position on it, or a map that grows, and the servers that drive."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node, PushROSNamespace

SHARE = Path(get_package_share_directory("nav2_bringup"))
ARGUMENTS = (
    ("namespace", "", "Namespace of all nodes."),
    ("use_namespace", "false", "Has no effect."),
    ("slam", "False", "Make a map instead of reading one."),
    ("map", "", "Path of the map's YAML file."),
    ("use_localization", "True", "Find the robot's position."),
    ("use_sim_time", "false", "Follow /clock."),
    ("params_file", str(SHARE / "params" / "nav2_params.yaml"), "Path of the file of parameters."),
    ("autostart", "true", "Activate the nodes at once."),
    ("use_composition", "True", "Use one process for them."),
    ("use_respawn", "False", "Start a process again."),
    ("log_level", "info", "Level of the log."),
)
"""Names, defaults and meanings of the arguments."""
OF_ALL = ("namespace", "use_sim_time", "params_file", "autostart", "use_respawn", "log_level")
"""Arguments of all parts."""


def part(name, condition=None, **arguments):
    """Include another launch file."""
    shared = {each: LaunchConfiguration(each) for each in OF_ALL}
    return IncludeLaunchDescription(
        PythonLaunchDescriptionSource(str(SHARE / "launch" / name)),
        condition=condition,
        launch_arguments={**shared, **arguments}.items(),
    )


def generate_launch_description():
    """Describe the arguments and the container of the nodes, and include the parts."""
    slam, localizes = LaunchConfiguration("slam"), LaunchConfiguration("use_localization")
    composed = {"use_composition": LaunchConfiguration("use_composition"), "container_name": "nav2_container"}
    container = Node(
        condition=IfCondition(LaunchConfiguration("use_composition")),
        name="nav2_container",
        package="rclcpp_components",
        executable="component_container_isolated",
        arguments=["--ros-args", "--log-level", LaunchConfiguration("log_level")],
    )
    maps = IfCondition(PythonExpression([slam, " and ", localizes]))
    finds = IfCondition(PythonExpression(["not ", slam, " and ", localizes]))
    parts = [
        PushROSNamespace(LaunchConfiguration("namespace")),
        container,
        part("slam_launch.py", maps),
        part("localization_launch.py", finds, map=LaunchConfiguration("map"), **composed),
        part("navigation_launch.py", **composed),
    ]
    declared = [DeclareLaunchArgument(name, default_value=value, description=text) for name, value, text in ARGUMENTS]
    return LaunchDescription([*declared, GroupAction(parts)])
