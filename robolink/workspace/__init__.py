"""The workspace: a folder of nodes, systems and types, which are found (`find`) and loaded (`load`) by name.

Everything is imported when it is first used: a program that has rclpy's names needs none of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.text.suggestions import lazily

if TYPE_CHECKING:
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
    from robolink.workspace.source import Folder, NodeSource, built_in_workspace, canonical

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

_HOMES = {
    "Folder": "source",
    "InterfaceImportError": "interfaces",
    "NodeLoadError": "load",
    "NodeSource": "source",
    "RosProgramError": "ros_programs",
    "VARIABLE": "find",
    "built_in_workspace": "source",
    "canonical": "source",
    "component": "programs",
    "components": "programs",
    "executable": "packages",
    "executable_of": "programs",
    "executables": "packages",
    "find_executable": "find",
    "find_faults": "find",
    "find_launch": "find",
    "find_node": "find",
    "find_package": "find",
    "find_world": "find",
    "instead_of": "ros_programs",
    "lacking_executable": "programs",
    "list_executables": "find",
    "list_faults": "find",
    "list_launches": "find",
    "list_nodes": "find",
    "list_packages": "find",
    "list_worlds": "find",
    "load_module": "load",
    "load_node": "load",
    "named_executables": "packages",
    "own_process_needed": "load",
    "program": "programs",
    "program_folder": "programs",
    "program_names": "programs",
    "programs_of": "programs",
    "purpose_of": "purpose",
    "reach_module": "load",
    "sources_of": "programs",
    "two_words": "find",
    "unmarked_package": "packages",
    "use_interfaces": "interfaces",
    "user_workspace": "find",
    "workspace_of": "find",
}

__getattr__, __dir__ = lazily(__name__, _HOMES, ())
