"""Table of the module names of `launch`, `launch_ros`, `launch_xml` and `launch_yaml`, and robolink's modules.

ROS 2 has a module for nearly every class of theirs, and programs import from these.
"""

from __future__ import annotations

_ALIASES = {
    "launch.actions.configurations": "set_launch_configuration unset_launch_configuration push_launch_configurations "
    "pop_launch_configurations reset_launch_configurations",
    "launch.actions.declare": "declare_launch_argument",
    "launch.actions.environment": "append_environment_variable set_environment_variable unset_environment_variable "
    "push_environment pop_environment reset_environment",
    "launch.actions.functions": "log_info opaque_function opaque_coroutine",
    "launch.actions.group": "group_action",
    "launch.actions.include": "include_launch_description",
    "launch.actions.loops": "for_loop",
    "launch.actions.processes": "execute_local execute_process",
    "launch.actions.reactions": "emit_event register_event_handler unregister_event_handler shutdown_action "
    "timer_action",
    "launch.substitutions.commands": "command file_content find_executable python_expression",
    "launch.substitutions.failure": "substitution_failure",
    "launch.substitutions.logic": "boolean_substitution equals_substitution if_else_substitution "
    "not_equals_substitution",
    "launch.substitutions.values": "anon_name environment_variable launch_configuration launch_log_dir "
    "local_substitution path_join_substitution string_join_substitution this_launch_file this_launch_file_dir",
    "launch_ros.actions.containers": "composable_node_container load_composable_nodes",
    "launch_ros.actions.lifecycle": "lifecycle_node lifecycle_transition",
    "launch_ros.actions.scope": "push_ros_namespace ros_timer set_parameter set_parameters_from_file set_remap "
    "set_ros_log_dir set_use_sim_time",
}
"""Modules of ROS 2 beside robolink's, which holds the classes of several, by that."""
_INSIDE = {
    "launch.conditions": "if_condition unless_condition launch_configuration_equals launch_configuration_not_equals "
    "evaluate_condition_expression_impl invalid_condition_expression_error",
    "launch.event_handlers": "event_named on_action_event_base on_execution_complete on_include_launch_description "
    "on_process_exit on_process_io on_process_start on_shutdown",
    "launch.events": "execution_complete include_launch_description matchers shutdown timer_event",
    "launch.events.process": "process_exited process_io process_started process_stderr process_stdin process_stdout "
    "process_targeted_event running_process_event shutdown_process signal_process process_matchers",
    "launch.launch_description_sources": "any_launch_description_source frontend_launch_description_source "
    "python_launch_description_source python_launch_file_utilities",
    "launch_ros.descriptions": "composable_node parameter_file",
    "launch_ros.event_handlers": "on_state_transition",
    "launch_ros.events.lifecycle": "change_state lifecycle_node_matchers state_transition",
    "launch_ros.events.matchers": "matches_node_name",
    "launch_ros.substitutions": "executable_in_package find_package parameter",
}
"""Modules of ROS 2 inside one of robolink's, which holds them all, by that."""
_BASES = (
    "action condition event event_handler launch_context launch_description_entity some_actions_type "
    "some_entities_type some_substitutions_type substitution"
)

LAUNCH_ROOMS = {
    "launch": "robolink.companions.launch",
    "launch_ros": "robolink.companions.launch_ros",
    "launch_xml": "robolink.companions.launch_frontend",
    "launch_xml.launch_description_sources": "robolink.companions.launch_frontend.sources",
    "launch_yaml": "robolink.companions.launch_frontend",
    "launch_yaml.launch_description_sources": "robolink.companions.launch_frontend.sources",
    "launch.descriptions": "robolink.companions.launch.actions.processes",
    "launch.descriptions.executable": "robolink.companions.launch.actions.processes",
    "launch.launch_description_source": "robolink.companions.launch.launch_description_sources",
    "launch.invalid_launch_file_error": "robolink.companions.launch.launch_description_sources",
    "launch.launch_introspector": "robolink.companions.launch",
    "launch.launch_service": "robolink.companions.launch",
    "launch.substitutions.text_substitution": "robolink.companions.launch.utilities",
    **{f"launch.{name}": "robolink.companions.launch.bases" for name in _BASES.split()},
    **{
        f"{home.rpartition('.')[0]}.{name}": f"robolink.companions.{home}"
        for home, names in _ALIASES.items()
        for name in names.split()
    },
    **{f"{home}.{name}": f"robolink.companions.{home}" for home, names in _INSIDE.items() for name in names.split()},
}
"""Modules by name, as in `robolink.compat.names.ROOMS`."""
