"""The servers that drive: controller, planner, recoveries, navigator and waypoint follower."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LoadComposableNodes, Node, SetParameter
from launch_ros.descriptions import ComposableNode, ParameterFile
from nav2_common.launch import RewrittenYaml

PARAMETERS = Path(get_package_share_directory("nav2_bringup")) / "params" / "nav2_params.yaml"
ARGUMENTS = (
    ("namespace", "", "Namespace of all nodes."),
    ("use_sim_time", "false", "Follow /clock."),
    ("params_file", str(PARAMETERS), "Path of the file of parameters."),
    ("autostart", "true", "Activate the nodes at once."),
    ("use_composition", "False", "Load them into a container."),
    ("container_name", "nav2_container", "The container."),
    ("use_respawn", "False", "Start a process again."),
    ("log_level", "info", "Level of the log."),
)
"""Names, defaults and meanings of the arguments."""
SERVERS = {
    "controller_server": ("nav2_controller", "nav2_controller::ControllerServer"),
    "smoother_server": ("nav2_smoother", "nav2_smoother::SmootherServer"),
    "planner_server": ("nav2_planner", "nav2_planner::PlannerServer"),
    "behavior_server": ("nav2_behaviors", "behavior_server::BehaviorServer"),
    "bt_navigator": ("nav2_bt_navigator", "nav2_bt_navigator::BtNavigator"),
    "waypoint_follower": ("nav2_waypoint_follower", "nav2_waypoint_follower::WaypointFollower"),
}
"""Packages and classes of the servers by the names of the nodes, in the order in which they are activated."""


def in_processes(parameters, remappings, manager):
    """Return the servers as processes."""
    level = ["--ros-args", "--log-level", LaunchConfiguration("log_level")]
    servers = [
        Node(
            package=package,
            executable=name,
            name=name,
            respawn=LaunchConfiguration("use_respawn"),
            respawn_delay=2.0,
            parameters=parameters,
            arguments=level,
            remappings=remappings,
        )
        for name, (package, _) in SERVERS.items()
    ]
    managing = Node(
        package="nav2_lifecycle_manager",
        executable="lifecycle_manager",
        name="lifecycle_manager_navigation",
        parameters=manager,
        arguments=level,
    )
    return [*servers, managing]


def in_a_container(parameters, remappings, manager):
    """Return the servers as nodes that a container loads."""
    servers = [
        ComposableNode(package=package, plugin=plugin, name=name, parameters=parameters, remappings=remappings)
        for name, (package, plugin) in SERVERS.items()
    ]
    managing = ComposableNode(
        package="nav2_lifecycle_manager",
        plugin="nav2_lifecycle_manager::LifecycleManager",
        name="lifecycle_manager_navigation",
        parameters=manager,
    )
    container = [LaunchConfiguration("namespace"), "/", LaunchConfiguration("container_name")]
    return [LoadComposableNodes(target_container=container, composable_node_descriptions=[*servers, managing])]


def generate_launch_description():
    """Describe the arguments, and the servers with their lifecycle manager."""
    source, namespace = LaunchConfiguration("params_file"), LaunchConfiguration("namespace")
    file = ParameterFile(RewrittenYaml(source, {}, root_key=namespace, convert_types=True), allow_substs=True)
    manager = {"autostart": LaunchConfiguration("autostart"), "node_names": list(SERVERS)}
    given = [file], [("/tf", "tf"), ("/tf_static", "tf_static")], [manager]
    clock, composed = (
        SetParameter("use_sim_time", LaunchConfiguration("use_sim_time")),
        LaunchConfiguration("use_composition"),
    )
    return LaunchDescription(
        [
            *(DeclareLaunchArgument(name, default_value=value, description=text) for name, value, text in ARGUMENTS),
            GroupAction([clock, *in_processes(*given)], condition=UnlessCondition(composed)),
            GroupAction([clock, *in_a_container(*given)], condition=IfCondition(composed)),
        ]
    )
