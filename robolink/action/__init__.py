"""Actions: long-running goals with feedback on the way, a result at the end, and a way to cancel them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.text.suggestions import lazily

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

# When first used: commands that only look at the graph need neither servers nor clients.
__getattr__, __dir__ = lazily(__name__, _HOMES, _ROOMS)
