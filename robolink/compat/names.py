"""Table of ROS 2's module names and robolink's modules, and advice for the names that have none."""

from __future__ import annotations

import re

from robolink.extensions.optional import is_here

_LAUNCH = """
launch launch.bases action condition event event_handler launch_context launch_description_entity some_actions_type
launch launch.bases some_entities_type some_substitutions_type substitution
launch launch.sources invalid_launch_file_error launch_description launch_description_source
launch launch.sources launch_description_sources
launch launch launch_introspector
launch launch.logging logging
launch.logging launch.log_handlers handlers
launch launch.processes descriptions descriptions.executable
launch.actions launch.actions emit_event for_loop group_action
launch.actions launch.processes execute_local execute_process
launch.actions launch.actions opaque_coroutine opaque_function register_event_handler shutdown_action timer_action
launch.actions launch.actions unregister_event_handler
launch.actions launch.settings append_environment_variable declare_boolean_launch_argument
launch.actions launch.settings declare_launch_argument pop_environment
launch.actions launch.settings pop_launch_configurations push_environment push_launch_configurations
launch.actions launch.settings reset_environment reset_launch_configurations set_environment_variable
launch.actions launch.settings set_launch_configuration unset_environment_variable unset_launch_configuration
launch.actions launch.lines log log_info
launch.actions launch.sources include_launch_description
launch.conditions launch.conditions evaluate_condition_expression_impl if_condition invalid_condition_expression_error
launch.conditions launch.conditions launch_configuration_equals launch_configuration_not_equals unless_condition
launch.event_handlers launch.event_handlers event_named on_action_event_base on_execution_complete
launch.event_handlers launch.event_handlers on_include_launch_description on_process_exit on_process_io
launch.event_handlers launch.event_handlers on_process_start on_shutdown
launch.events launch.events execution_complete include_launch_description matchers shutdown timer_event
launch.events launch.process_events process
launch.events.process launch.process_events process_exited process_io process_matchers process_started process_stderr
launch.events.process launch.process_events process_stdin process_stdout process_targeted_event running_process_event
launch.events.process launch.process_events shutdown_process signal_process
launch.launch_description_sources launch.sources any_launch_description_source any_launch_file_utilities
launch.launch_description_sources launch.sources frontend_launch_description_source frontend_launch_file_utilities
launch.launch_description_sources launch.sources python_launch_description_source python_launch_file_utilities
launch.substitutions launch.substitutions anon_name boolean_substitution command environment_variable
launch.substitutions launch.substitutions equals_substitution file_content find_executable for_loop_var
launch.substitutions launch.substitutions if_else_substitution path_substitution
launch.substitutions launch.substitutions launch_configuration launch_log_dir local_substitution
launch.substitutions launch.substitutions not_equals_substitution path_join_substitution python_expression
launch.substitutions launch.substitutions string_join_substitution substitution_failure this_launch_file
launch.substitutions launch.substitutions this_launch_file_dir
launch.substitutions launch.utilities text_substitution
launch.utilities launch.signals signal_management
launch.utilities launch.utilities class_tools_impl ensure_argument_type_impl normalize_to_list_of_entities_impl
launch.utilities launch.utilities normalize_to_list_of_substitutions_impl perform_substitutions_impl
launch.utilities launch.utilities visit_all_entities_and_collect_futures_impl
launch.utilities launch.typed_values type_utils
launch_ros launch_ros.events event_handlers
launch_ros launch_ros.parameters parameters_type
launch_ros launch_ros.utilities remap_rule_type
launch_ros launch_ros.ros_adapters ros_adapters
launch_ros.actions launch_ros.components composable_node_container load_composable_nodes
launch_ros.actions launch_ros.lifecycle lifecycle_node lifecycle_transition
launch_ros.actions launch_ros.node node
launch_ros.actions launch_ros.settings push_ros_namespace set_parameter set_parameters_from_file set_remap
launch_ros.actions launch_ros.settings set_ros_log_dir set_use_sim_time
launch_ros.actions launch_ros.actions ros_timer
launch_ros.descriptions launch_ros.descriptions composable_node parameter_file
launch_ros.event_handlers launch_ros.events on_state_transition
launch_ros.events launch_ros.events lifecycle matchers
launch_ros.events.lifecycle launch_ros.events change_state lifecycle_node_matchers state_transition
launch_ros.events.matchers launch_ros.events matches_node_name
launch_ros.substitutions launch_ros.substitutions executable_in_package find_package parameter
launch_xml.launch_description_sources launch_xml.launch_description_sources xml_launch_description_source
launch_yaml.launch_description_sources launch_yaml.launch_description_sources yaml_launch_description_source
launch_ros.utilities launch_ros.parameters evaluate_parameters normalize_parameters to_parameters_list
launch_ros.utilities launch_ros.utilities namespace_utils normalize_remap_rule track_node_names
launch_testing launch_testing.arguments parse_arguments print_arguments
launch_testing launch_testing.markers decorator parametrize ready_to_test_action_timeout
launch_testing.actions launch_testing.actions gtest pytest ready test
launch_testing.asserts launch_testing.asserts assert_exit_codes assert_output assert_sequential_output
launch_testing.event_handlers launch_testing.event_handlers stdout_ready_listener
launch_testing.tools launch_testing.text text
launch_testing.util launch_testing.util proc_lookup
launch_testing_ros launch_testing_ros data_republisher message_pump test_runner tools wait_for_topics
launch_testing_ros.tools launch_testing_ros output
nav2_common nav2_common launch
"""
"""A package of ROS 2's launch, the module of robolink's, and the modules of the package that this one stands for: ROS 2
has a file for nearly each class."""
_LAUNCH_TOPS = {
    "launch": "launch",
    "launch_ros": "launch_ros",
    "launch_xml": "launch_xml",
    "launch_yaml": "launch_yaml",
    "launch_testing": "launch_testing",
    "launch_testing_ros": "launch_testing_ros",
}

LAUNCH_ROOMS = {
    **{name: f"robolink.launch.ros.{room}" for name, room in _LAUNCH_TOPS.items()},
    **{
        f"{package}.{name}": f"robolink.launch.ros.{room}"
        for package, room, *names in map(str.split, _LAUNCH.strip().splitlines())
        for name in names
    },
}
"""Modules of ROS 2's launch by name, as in `ROOMS`."""

OPTIONAL = {
    "webots_ros2_driver": "robolink.webots_controller",
    **{
        f"webots_ros2_driver.{name}": "robolink.launch.ros.webots_ros2_driver"
        for name in ("urdf_spawner", "utils", "wait_for_controller_connection", "webots_launcher")
    },
}
"""Modules that an installation may lack, by name."""

ROOMS = {
    "rclpy": "robolink",
    "tf2_ros": "robolink.tf2",
    "tf2_py": "robolink.tf2",
    "tf2_geometry_msgs": "robolink.tf2.geometry",
    "tf2_geometry_msgs.tf2_geometry_msgs": "robolink.tf2.geometry",
    "tf2_sensor_msgs": "robolink.tf2.point_cloud",
    "tf2_sensor_msgs.tf2_sensor_msgs": "robolink.tf2.point_cloud",
    "tf_transformations": "robolink.geometry.transformations",
    "message_filters": "robolink.companions.message_filters",
    "cv_bridge": "robolink.companions.cv_bridge",
    "cv_bridge.boost": "",
    "cv_bridge.boost.cv_bridge_boost": "robolink.companions.cv_bridge",
    "cv_bridge.core": "robolink.companions.cv_bridge",
    "image_geometry": "robolink.companions.image_geometry",
    "image_geometry.cameramodels": "robolink.companions.image_geometry",
    "sensor_msgs_py": "",
    "sensor_msgs_py.numpy_compat": "robolink.sensor_msgs_py.numpy_compat",
    "sensor_msgs_py.point_cloud2": "robolink.sensor_msgs_py.point_cloud2",
    "rosidl_parser": "",
    "rosidl_parser.definition": "robolink.message.slot_types",
    "rosidl_runtime_py": "robolink.companions.rosidl_runtime",
    **{
        f"rosidl_runtime_py.{name}": "robolink.companions.rosidl_runtime"
        for name in ("convert", "get_interfaces", "import_message", "set_message", "utilities")
    },
    "turtlesim_msgs": "robolink.interfaces.turtlesim",
    "ament_index_python": "robolink.companions.ament_index",
    **{
        f"ament_index_python.{name}": "robolink.companions.ament_index"
        for name in ("constants", "packages", "resources", "search_paths")
    },
    "rosbag2_py": "robolink.companions.rosbag2_py",
    **{
        f"rosbag2_py.{name}": "robolink.companions.rosbag2_py._files"
        for name in ("_info", "_reader", "_writer", "_reindexer")
    },
    "rosbag2_py._message_definitions": "robolink.companions.rosbag2_py._definitions",
    "rosbag2_py._compression_options": "robolink.companions.rosbag2_py._storage",
    "diagnostic_updater": "robolink.companions.diagnostic_updater",
    "launch_pytest": "robolink.testing.launch_pytest",
    "launch_pytest.actions": "robolink.launch.ros.launch_testing.actions",
    "launch_pytest.fixture": "robolink.testing.launch_pytest.fixtures",
    "launch_pytest.tools.process": "robolink.testing.launch_pytest.tools",
    "nav2_common": "",
    "nav2_simple_commander": "robolink.companions.nav2_simple_commander",
    "nav2_simple_commander.utils": "robolink.companions.nav2_simple_commander",
    **LAUNCH_ROOMS,
    **{name: room for name, room in OPTIONAL.items() if is_here(room)},
}
"""Modules by name; '' is a package with nothing in it. A name below another is below its module."""

INSTEAD = {
    "launch.exit_handler": "that is ROS 2 before Bouncy (2018): Node(respawn=True, on_exit=...) is what it has now",
    "launch.legacy": "that is ROS 2 before Bouncy (2018): launch.actions and launch_ros.actions are what it has now",
    "tf2_kdl": "tf2_geometry_msgs transforms the types of geometry_msgs, tf_transformations has the matrices",
    "tf2_eigen": "tf2_geometry_msgs transforms the types of geometry_msgs, tf_transformations has the matrices",
    "tf": "that is ROS 1: tf2_ros has the listener and the broadcaster, tf_transformations the angles",
    "rospy": "that is ROS 1: rclpy is what ROS 2 has",
    "roslib": "that is ROS 1, and ROS 2 needs nothing in its place",
    "rosbag": "that is ROS 1: 'robolink bag' and rosbag2_py have the bags of ROS 2",
    "actionlib": "that is ROS 1: rclpy.action has ActionServer and ActionClient",
    "move_base_msgs": "that is ROS 1: nav2_msgs.action.NavigateToPose is what ROS 2 has",
    "uuid_msgs": "that is ROS 1: unique_identifier_msgs is what ROS 2 has",
    "sensor_msgs.point_cloud2": "that is ROS 1: sensor_msgs_py.point_cloud2 is what ROS 2 has",
    "PyKDL": "tf_transformations has rotations and matrices, tf2_geometry_msgs transforms the types of geometry_msgs",
    "rosidl_adapter": "robolink.interfaces.find returns the class of a type, and no code is generated",
    "rosidl_generator_py": "robolink.interfaces.find returns the class of a type, and no code is generated",
    "py_trees_ros": "py_trees works as it is, with a timer that ticks the tree",
    "image_transport": "publish and subscribe to sensor_msgs.msg.Image or CompressedImage",
    "controller_manager": "it needs ros2_control",
    "moveit": "it needs MoveIt",
    "moveit_commander": "it needs MoveIt",
    "moveit_configs_utils": "it needs MoveIt",
    "xacro": "it is on PyPI: pip install xacro",
}
"""Advice for the names that programs for ROS 2 import and that robolink lacks; a name may be below another."""

INTERFACES = r"[a-z][a-z0-9_]*_(?:msgs|interfaces|srvs|actions)"
"""Pattern of message packages, as text."""
LINTERS = r"ament_(?:copyright|flake8|pep257|xmllint|mypy|cpplint|lint)"
"""Pattern of ament's linters, as text: a program that lacks nothing need not wait until it is compiled."""
COMMANDS = r"ros2(?:cli|action|bag|component|interface|launch|lifecycle|node|param|pkg|run|service|topic)"
"""Pattern of the packages of ROS 2's command line, as text."""


_ENDS = ("_msgs", "_interfaces", "_srvs", "_actions")
"""Ends of the names of message packages."""


def instead_of(name: str) -> str:
    """Return advice for a name that robolink lacks; '' for a name that is not ROS's."""
    if name in INSTEAD:
        return INSTEAD[name]
    if not name.startswith(("ament_", "ros2")) and not name.endswith(_ENDS):
        return ""  # most imports: nothing is compiled for them
    if re.fullmatch(COMMANDS, name):
        return "'robolink' is the command line, and a node's methods, such as get_topic_names_and_types, read the graph"
    if re.fullmatch(LINTERS, name):
        return "it only checks how a package's files are written; ruff does"
    if re.fullmatch(INTERFACES, name):
        return f"put its files into interfaces/{name}/msg (srv, action) of your workspace, or the package into src/"
    return ""


def snake_case(type_name: str) -> str:
    """Return a type's name as rosidl names the module that defines it.

    >>> snake_case("PointCloud2"), snake_case("TFMessage")
    ('point_cloud2', 'tf_message')
    """
    parted = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", type_name)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", parted).lower()
