"""A map of the newest scans, made while the robot drives: the launch file of ROS's package."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import AndSubstitution, LaunchConfiguration, NotSubstitution
from launch_ros.actions import LifecycleNode

PARAMETERS = Path(get_package_share_directory("slam_toolbox")) / "config" / "mapper_params_online_async.yaml"
ARGUMENTS = (
    ("autostart", "true", "Activate the node at once."),
    ("use_lifecycle_manager", "false", "Leave that to a lifecycle manager."),
    ("use_sim_time", "true", "Follow /clock."),
    ("slam_params_file", str(PARAMETERS), "Path of the file of parameters."),
)
"""Names, defaults and meanings of the arguments."""


def generate_launch_description():
    """Describe the arguments and the node."""
    at_once = AndSubstitution(
        LaunchConfiguration("autostart"), NotSubstitution(LaunchConfiguration("use_lifecycle_manager"))
    )
    node = LifecycleNode(
        package="slam_toolbox",
        executable="async_slam_toolbox_node",
        name="slam_toolbox",
        namespace="",
        output="screen",
        autostart=at_once,
        parameters=[LaunchConfiguration("slam_params_file"), {"use_sim_time": LaunchConfiguration("use_sim_time")}],
    )
    declared = [DeclareLaunchArgument(name, default_value=value, description=text) for name, value, text in ARGUMENTS]
    return LaunchDescription([*declared, node])
