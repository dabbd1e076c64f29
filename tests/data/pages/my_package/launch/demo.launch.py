"""Launch file as MoveIt's tutorials have it, whose module is not here."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch_ros.actions import Node
from moveit_configs_utils import MoveItConfigsBuilder


def generate_launch_description():
    moveit_config = (
        MoveItConfigsBuilder("arm")
        .robot_description(file_path="config/arm.urdf.xacro")
        .trajectory_execution(file_path="config/moveit_controllers.yaml")
        .to_moveit_configs()
    )

    world = Node(
        package="tf2_ros",
        executable="static_transform_publisher",
        name="static_transform_publisher",
        output="log",
        arguments=[
            "--frame-id",
            "world",
            "--child-frame-id",
            "arm_base",
        ],
    )

    talker = Node(
        package="demo_nodes_py",
        executable="talker",
        name="talker",
        output="screen",
    )

    chatter = DeclareLaunchArgument(
        "chatter",
        default_value="chatter",
        description="Where it talks.",
    )

    # the values of the arm's description are known to moveit_configs_utils alone;
    # what reads them is left out where that is not installed, and the rest of
    # the system runs: a place in the world, and a node that talks
    # (docs/reference/ros_launch.md shows what is told)
    return LaunchDescription(
        [
            chatter,
            world,
            talker,
            Node(
                package="demo_nodes_py",
                executable="listener",
                parameters=[moveit_config.to_dict()],
            ),
        ]
    )
