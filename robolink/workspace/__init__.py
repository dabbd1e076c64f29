"""The workspace: a folder with `nodes/` and `configs/`, found (`find`) and loaded (`load`) by name."""

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
from robolink.workspace.load import NodeLoadError, load_module, load_node

__all__ = [
    "VARIABLE",
    "Folder",
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
    "user_workspace",
    "workspace_of",
]
