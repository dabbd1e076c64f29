"""Launch file as pages of the manual speak of: a robot, and two programs that are not here."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "speed",
                default_value="0.2",
                description="In m/s.",
            ),
            Node(
                package="my_package",
                executable="driver",
                # a launch argument is a text; ROS 2 reads it as a number
                parameters=[
                    {"speed": LaunchConfiguration("speed")},
                ],
                output="screen",
            ),
            Node(
                package="controller_manager",
                executable="spawner",
                arguments=["arm_controller"],
            ),
            Node(
                package="my_package",
                executable="fast",
            ),
        ]
    )
