"""Settings that all processes have in XML and YAML launch files: names, folders, environment, restarts."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch.actions import Shutdown
from robolink.companions.launch_frontend.entity import Entity

PROCESS = (
    "cwd",
    "name",
    "launch-prefix",
    "output",
    "respawn",
    "respawn_delay",
    "respawn_max_retries",
    "on_exit",
    "sigterm_timeout",
    "sigkill_timeout",
    "emulate_tty",
)
"""Attributes of each process."""


def executable(entity: Entity, name: str = "name") -> dict[str, Any]:
    """Return the arguments of ExecuteProcess that the attributes of an element stand for. Raises DocumentError.

    Args:
        entity: The element.
        name: Attribute with the name for people.
    """
    prefix = entity.optional("launch-prefix")
    found: dict[str, Any] = {
        "name": entity.optional(name),
        "cwd": entity.optional("cwd"),
        "prefix": prefix,
        "additional_env": pairs(entity, "env", "name", "value") or None,
        "respawn": entity.optional("respawn", bool) or False,
        "respawn_delay": entity.optional("respawn_delay", float),
        "respawn_max_retries": _retries(entity),
        "on_exit": _on_exit(entity),
    }
    return {key: value for key, value in found.items() if value is not None}


def pairs(entity: Entity, tag: str, name: str, value: str) -> dict[Any, Any]:
    """Return what the children with a tag say, such as `<env name= value=>`, as a mapping of substitutions.

    Args:
        entity: The element.
        tag: Tag of the children.
        name: Attribute of the key.
        value: Attribute of the value.
    """
    found = {}
    for each in entity.inside(tag):
        each.check((name, value))
        found[tuple(each.needed(name))] = each.needed(value)
    return found


def _retries(entity: Entity) -> int:
    text = entity.texts("respawn_max_retries", int)
    try:
        return -1 if text is None else int(text)
    except ValueError:
        raise entity.error(f"'respawn_max_retries' is a number, got '{text:.40}'") from None


def _on_exit(entity: Entity) -> Shutdown | None:
    """Return the end of the launch, for a process whose end is that of the launch."""
    said = entity.texts("on_exit")
    if said not in (None, "shutdown"):
        raise entity.error(f"'on_exit' is shutdown, got '{said:.40}'")
    return Shutdown(reason="it was required") if said else None
