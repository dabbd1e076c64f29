"""A simulated robot with all that it needs to drive to a goal, or to make a map: the world, and bringup_launch.py."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from nav2_common.launch import RewrittenYaml

SHARE = Path(get_package_share_directory("nav2_bringup"))
MAPS = Path(get_package_share_directory("robolink")) / "configs" / "worlds" / "maps"
ARGUMENTS = (
    ("slam", "False", "Make a map instead of reading one."),
    ("world", "office", "The world: its name, or the path of its file."),
    ("map", str(MAPS / "office.yaml"), "Path of the map's YAML file."),
    ("x_pose", "1.2", "Where the robot begins on the map, in metres to the right."),
    ("y_pose", "4.0", "Where the robot begins on the map, in metres upwards."),
    ("yaw", "0.0", "Direction in which it looks there, in radians."),
    ("params_file", str(SHARE / "params" / "nav2_params.yaml"), "Path of the file of parameters."),
    ("autostart", "true", "Activate the nodes at once."),
    ("use_composition", "True", "Use one process for them."),
    ("use_respawn", "False", "Start a process again."),
)
"""Names, defaults and meanings of the arguments."""
START = {"set_initial_pose": "true", "initial_pose.x": "x_pose", "initial_pose.y": "y_pose", "initial_pose.yaw": "yaw"}
"""Parameters of amcl by which it knows where the robot begins, and the argument or the value of each."""
PASSED_ON = ("slam", "map", "autostart", "use_composition", "use_respawn")


def generate_launch_description():
    """Describe the arguments and the world, and include the navigation."""
    known = {name for name, _, _ in ARGUMENTS}
    rewrites = {
        f"amcl.ros__parameters.{name}": LaunchConfiguration(value) if value in known else value
        for name, value in START.items()
    }
    file = RewrittenYaml(LaunchConfiguration("params_file"), rewrites, convert_types=True)
    world = {"world": LaunchConfiguration("world"), "publish_map": False}  # amcl or slam_toolbox says where odom is
    navigation = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(str(SHARE / "launch" / "bringup_launch.py")),
        launch_arguments={"params_file": file, **{each: LaunchConfiguration(each) for each in PASSED_ON}}.items(),
    )
    declared = [DeclareLaunchArgument(name, default_value=value, description=text) for name, value, text in ARGUMENTS]
    return LaunchDescription([*declared, Node(package="robolink", executable="world", parameters=[world]), navigation])
