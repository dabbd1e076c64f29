"""The workspace: a folder of nodes, systems and types, which are found (`find`) and loaded (`load`) by name."""

from robolink.workspace.find import (
    VARIABLE,
    built_in_workspace,
    find_faults,
    find_launch,
    find_node,
    find_package,
    find_ros_node,
    find_world,
    list_executables,
    list_faults,
    list_launches,
    list_nodes,
    list_packages,
    list_worlds,
    user_workspace,
    workspace_of,
)
from robolink.workspace.interfaces import InterfaceImportError, use_interfaces
from robolink.workspace.load import NodeLoadError, load_module, load_node, own_process_needed
from robolink.workspace.packages import executable, executables, named_executables, unmarked_package
from robolink.workspace.purpose import purpose_of
from robolink.workspace.ros_programs import ros_program_error
from robolink.workspace.source import Folder, NodeSource, canonical

__all__ = [
    "VARIABLE",
    "Folder",
    "InterfaceImportError",
    "NodeLoadError",
    "NodeSource",
    "built_in_workspace",
    "canonical",
    "executable",
    "executables",
    "find_faults",
    "find_launch",
    "find_node",
    "find_package",
    "find_ros_node",
    "find_world",
    "list_executables",
    "list_faults",
    "list_launches",
    "list_nodes",
    "list_packages",
    "list_worlds",
    "load_module",
    "load_node",
    "named_executables",
    "own_process_needed",
    "purpose_of",
    "ros_program_error",
    "unmarked_package",
    "use_interfaces",
    "user_workspace",
    "workspace_of",
]
