"""Hashes of types whose owner does not tell them: of services, which DDS has no place for, and from Humble's nodes.

On DDS a topic's name and type decide what meets; robolink's keys have the hash of the type too. Endpoints of topics
tell it in their user data; those of services tell the hashes of the request and the response, never the service's own.
"""

from __future__ import annotations

from collections.abc import Callable

from robolink.interfaces import find_announced
from robolink.message import type_hash
from robolink.wire import NO_HASH


class Hashes:
    """Hash of each type: what this session itself uses, else that of the installed type, else NO_HASH."""

    def __init__(self, on_learned: Callable[[str], object]) -> None:
        """Make a table.

        Args:
            on_learned: Function that is called with the name of a type whose hash was not known when it was asked for.
        """
        self._on_learned = on_learned
        self._known: dict[str, str] = {}

    def note(self, type_name: str, text: str) -> None:
        """Note the hash that this session uses for a type."""
        if text == NO_HASH:
            return
        before = self._known.get(type_name)
        self._known[type_name] = text
        if before == NO_HASH:
            self._on_learned(type_name)

    def of(self, type_name: str) -> str:
        """Return the hash of a type by its name; it may import the type."""
        known = self._known.get(type_name)
        if known is None:
            known = self._known.setdefault(type_name, _installed(type_name))
        return known

    def of_part(self, type_name: str, part: str) -> str:
        """Return the hash of a service's Request or Response."""
        name = f"{type_name}.{part}"
        known = self._known.get(name)
        if known is None:
            known = self._known.setdefault(name, _installed(type_name, part))
        return known


def _installed(type_name: str, part: str = "") -> str:
    try:
        found = find_announced(type_name)
        return type_hash(getattr(found, part) if part else found)
    except Exception:  # noqa: BLE001 - not installed, or a package of somebody's that is broken
        return NO_HASH
