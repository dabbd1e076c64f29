"""The map of a file, and amcl, which finds the robot on it."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, OpaqueFunction
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LoadComposableNodes, Node, SetParameter
from launch_ros.descriptions import ComposableNode, ParameterFile
from nav2_common.launch import RewrittenYaml

PARAMETERS = Path(get_package_share_directory("nav2_bringup")) / "params" / "nav2_params.yaml"
ARGUMENTS = (
    ("namespace", "", "Namespace of all nodes."),
    ("map", "", "Path of the map's YAML file."),
    ("use_sim_time", "false", "Follow /clock."),
    ("params_file", str(PARAMETERS), "Path of the file of parameters."),
    ("autostart", "true", "Activate the nodes at once."),
    ("use_composition", "False", "Load them into a container."),
    ("container_name", "nav2_container", "The container."),
    ("use_respawn", "False", "Start a process again."),
    ("log_level", "info", "Level of the log."),
)
"""Names, defaults and meanings of the arguments."""
NODES = {
    "map_server": ("nav2_map_server", "nav2_map_server::MapServer"),
    "amcl": ("nav2_amcl", "nav2_amcl::AmclNode"),
}
"""Packages and classes of the nodes by their names, in the order in which they are activated."""


def in_processes(parameters, remappings, manager):
    """Return the nodes as processes; `parameters` by their names."""
    level = ["--ros-args", "--log-level", LaunchConfiguration("log_level")]
    nodes = [
        Node(
            package=package,
            executable=name,
            name=name,
            respawn=LaunchConfiguration("use_respawn"),
            respawn_delay=2.0,
            parameters=parameters[name],
            arguments=level,
            remappings=remappings,
        )
        for name, (package, _) in NODES.items()
    ]
    managing = Node(
        package="nav2_lifecycle_manager",
        executable="lifecycle_manager",
        name="lifecycle_manager_localization",
        parameters=manager,
        arguments=level,
    )
    return [*nodes, managing]


def in_a_container(parameters, remappings, manager):
    """Return the nodes as some that a container loads; `parameters` by their names."""
    nodes = [
        ComposableNode(package=package, plugin=plugin, name=name, parameters=parameters[name], remappings=remappings)
        for name, (package, plugin) in NODES.items()
    ]
    managing = ComposableNode(
        package="nav2_lifecycle_manager",
        plugin="nav2_lifecycle_manager::LifecycleManager",
        name="lifecycle_manager_localization",
        parameters=manager,
    )
    container = [LaunchConfiguration("namespace"), "/", LaunchConfiguration("container_name")]
    return [LoadComposableNodes(target_container=container, composable_node_descriptions=[*nodes, managing])]


def parts(context):
    """Return both nodes and their lifecycle manager; a map that is not given is that of the parameters."""
    source, namespace = LaunchConfiguration("params_file"), LaunchConfiguration("namespace")
    map_file = LaunchConfiguration("map").perform(context)
    file = ParameterFile(RewrittenYaml(source, {}, root_key=namespace, convert_types=True), allow_substs=True)
    parameters = {"map_server": [file, {"yaml_filename": map_file}] if map_file else [file], "amcl": [file]}
    manager = {"autostart": LaunchConfiguration("autostart"), "node_names": list(NODES)}
    given = parameters, [("/tf", "tf"), ("/tf_static", "tf_static")], [manager]
    clock = SetParameter("use_sim_time", LaunchConfiguration("use_sim_time"))
    composed = LaunchConfiguration("use_composition")
    return [
        GroupAction([clock, *in_processes(*given)], condition=UnlessCondition(composed)),
        GroupAction([clock, *in_a_container(*given)], condition=IfCondition(composed)),
    ]


def generate_launch_description():
    """Describe the arguments and the parts."""
    declared = [DeclareLaunchArgument(name, default_value=value, description=text) for name, value, text in ARGUMENTS]
    return LaunchDescription([*declared, OpaqueFunction(function=parts)])
