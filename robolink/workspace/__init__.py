"""The workspace: a folder of nodes, systems and types, which are found (`find`) and loaded (`load`) by name."""

from robolink.workspace.built_in import built_in_workspace
from robolink.workspace.find import (
    VARIABLE,
    find_executable,
    find_faults,
    find_launch,
    find_node,
    find_package,
    find_world,
    list_executables,
    list_faults,
    list_launches,
    list_nodes,
    list_packages,
    list_worlds,
    two_words,
    user_workspace,
    workspace_of,
)
from robolink.workspace.interfaces import InterfaceImportError, use_interfaces
from robolink.workspace.load import NodeLoadError, load_module, load_node, own_process_needed, reach_module
from robolink.workspace.packages import executable, executables, named_executables, unmarked_package
from robolink.workspace.programs import (
    component,
    components,
    executable_of,
    lacking_executable,
    program,
    program_folder,
    program_names,
    programs_of,
    sources_of,
)
from robolink.workspace.purpose import purpose_of
from robolink.workspace.ros_programs import RosProgramError, instead_of
from robolink.workspace.source import Folder, NodeSource, canonical

__all__ = [
    "Folder",
    "InterfaceImportError",
    "NodeLoadError",
    "NodeSource",
    "RosProgramError",
    "VARIABLE",
    "built_in_workspace",
    "canonical",
    "component",
    "components",
    "executable",
    "executable_of",
    "executables",
    "find_executable",
    "find_faults",
    "find_launch",
    "find_node",
    "find_package",
    "find_world",
    "instead_of",
    "lacking_executable",
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
    "program",
    "program_folder",
    "program_names",
    "programs_of",
    "purpose_of",
    "reach_module",
    "sources_of",
    "two_words",
    "unmarked_package",
    "use_interfaces",
    "user_workspace",
    "workspace_of",
]
