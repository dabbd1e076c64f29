"""End of an entity of an AsyncNode: its callbacks under way are cancelled, and its node forgets it."""

from __future__ import annotations

import contextlib
from typing import Any

from robolink.experimental.pump import Pump
from robolink.running.entity import Entity


def cancel_callbacks(entity: Entity) -> None:
    """Cancel the callbacks of `entity` that are under way."""
    if isinstance(entity.executor, Pump):
        entity.executor.cancel(entity)


def leave(entity: Any, group: str) -> None:
    """Remove a destroyed entity from its node's list of such ones, unless the node has done so already."""
    node = entity.node
    if node is not None:
        with contextlib.suppress(ValueError):
            getattr(node._entity_store_, group).remove(entity)
