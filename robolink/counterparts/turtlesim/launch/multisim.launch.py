"""Two turtlesims, in the namespaces turtlesim1 and turtlesim2: the launch file of ROS's package."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    """Describe the two nodes."""
    return LaunchDescription(
        [
            Node(package="turtlesim", executable="turtlesim_node", namespace=f"turtlesim{number}", output="screen")
            for number in (1, 2)
        ]
    )
