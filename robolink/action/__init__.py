"""Actions: goals that take a while, with feedback on the way, a result at the end, and a way to cancel them."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robolink.action.client import ActionClient
    from robolink.action.graph import (
        get_action_client_names_and_types_by_node,
        get_action_names_and_types,
        get_action_server_names_and_types_by_node,
    )
    from robolink.action.server import ActionServer, CancelResponse, GoalResponse

__all__ = [
    "ActionClient",
    "ActionServer",
    "CancelResponse",
    "GoalResponse",
    "get_action_client_names_and_types_by_node",
    "get_action_names_and_types",
    "get_action_server_names_and_types_by_node",
]

_HOMES = {
    "ActionClient": "client",
    "ActionServer": "server",
    "CancelResponse": "server",
    "GoalResponse": "server",
    "get_action_client_names_and_types_by_node": "graph",
    "get_action_names_and_types": "graph",
    "get_action_server_names_and_types_by_node": "graph",
}
_ROOMS = ("client", "graph", "server")


def __getattr__(name: str) -> Any:
    # When first used: commands that only look at the graph need neither servers nor clients.
    if name in _ROOMS:
        return importlib.import_module(f"robolink.action.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module 'robolink.action' has no attribute '{name}'")
    value = getattr(importlib.import_module(f"robolink.action.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_ROOMS})
