"""Hashes of types whose owner does not tell them: of services, which DDS has no place for, and from Humble's nodes.

On DDS a topic's name and type decide what meets; robolink's keys have the hash of the type too. Endpoints of topics
tell it in their user data; those of services tell the hashes of the request and the response, never the service's own.
"""

from __future__ import annotations

from collections.abc import Callable

from robolink.interfaces import find_announced
from robolink.message import type_hash
from robolink.wire import NO_HASH

MOST_UNKNOWN = 1000
"""Most types that are looked for in vain: each costs a millisecond, and strangers may name as many as they like."""


class Hashes:
    """Hash of each type: what this session itself uses, else that of the installed type, else NO_HASH."""

    def __init__(self, on_learned: Callable[[str], object]) -> None:
        """Make a table.

        Args:
            on_learned: Function that is called with the name of a type whose hash was not known when it was asked for.
        """
        self._on_learned = on_learned
        self._known: dict[str, str] = {}
        self._unknown: set[str] = set()

    def note(self, type_name: str, text: str) -> None:
        """Note the hash that this session uses for a type."""
        if text == NO_HASH:
            return
        is_news = self._known.get(type_name) is None and (
            type_name in self._unknown or len(self._unknown) >= MOST_UNKNOWN
        )
        self._known[type_name] = text
        if is_news:
            self._on_learned(type_name)

    def of(self, type_name: str) -> str:
        """Return the hash of a type by its name; it may import the type."""
        return self._of(type_name, "")

    def of_part(self, type_name: str, part: str) -> str:
        """Return the hash of a service's Request or Response."""
        return self._of(type_name, part)

    def _of(self, type_name: str, part: str) -> str:
        name = f"{type_name}.{part}" if part else type_name
        known = self._known.get(name)
        if known is not None or name in self._unknown or len(self._unknown) >= MOST_UNKNOWN:
            return known or NO_HASH
        found = _installed(type_name, part)
        if found == NO_HASH:
            self._unknown.add(name)
            return NO_HASH
        return self._known.setdefault(name, found)


def _installed(type_name: str, part: str = "") -> str:
    try:
        found = find_announced(type_name)
        return type_hash(getattr(found, part) if part else found)
    except Exception:  # noqa: BLE001 - not installed, or a package of somebody's that is broken
        return NO_HASH
