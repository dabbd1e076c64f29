"""The workspace: a folder of nodes, systems and types, found (`find`) and loaded (`load`) by name."""

from robolink.workspace.find import (
    VARIABLE,
    Folder,
    NodeSource,
    built_in_workspace,
    canonical,
    find_launch,
    find_node,
    find_world,
    list_launches,
    list_nodes,
    list_worlds,
    user_workspace,
    workspace_of,
)
from robolink.workspace.interfaces import InterfaceImportError, use_interfaces
from robolink.workspace.load import NodeLoadError, load_module, load_node

__all__ = [
    "VARIABLE",
    "Folder",
    "InterfaceImportError",
    "NodeLoadError",
    "NodeSource",
    "built_in_workspace",
    "canonical",
    "find_launch",
    "find_node",
    "find_world",
    "list_launches",
    "list_nodes",
    "list_worlds",
    "load_module",
    "load_node",
    "use_interfaces",
    "user_workspace",
    "workspace_of",
]
