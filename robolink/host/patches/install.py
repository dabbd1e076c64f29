"""Installs the monkey patches while there is a host, and restores every name after the last one."""

from __future__ import annotations

import pkgutil
import threading
import types
from collections.abc import Iterator
from typing import Any

from robolink.host.patches import clocks, entropy, event_loops, locks, processes, threads

_MISSING = object()
_before: list[tuple[Any, str, Any]] = []
"""Values before the patches, in the order of replacing: owner, name, value."""

_hosts = 0
_counting = threading.Lock()


def replacements() -> dict[str, Any]:
    """Return all replacements by the dotted path of Python's name."""
    return {
        **clocks.replacements(),
        **threads.replacements(),
        **locks.replacements(),
        **processes.replacements(),
        **entropy.replacements(),
        **event_loops.replacements(),
    }


def install() -> None:
    """Replace Python's functions by ones that look at their caller; once for each host."""
    global _hosts
    with _counting:
        _hosts += 1
        if _hosts > 1:
            return
        for path, replacement in replacements().items():
            owner, _, name = path.rpartition(".")
            _replace(pkgutil.resolve_name(owner), name, replacement)


def uninstall() -> None:
    """Restore every name, once for each host; the last one does it."""
    global _hosts
    with _counting:
        _hosts -= 1
        if _hosts:
            return
        while _before:
            owner, name, value = _before.pop()
            if value is _MISSING:  # it was inherited
                delattr(owner, name)
            else:
                setattr(owner, name, value)


def _replace(owner: Any, name: str, replacement: Any) -> None:
    _before.append((owner, name, vars(owner).get(name, _MISSING)))
    setattr(owner, name, replacement)


def _imported() -> Iterator[tuple[Any, Any]]:
    yield from (*clocks.imported(), *locks.imported(), *event_loops.imported())


def adopt(module: types.ModuleType | None) -> None:
    """Replace also the names that a module imported before there was a host: ``from time import sleep``."""
    replaced = {id(real): replacement for real, replacement in _imported()}
    for name, value in list(vars(module).items()) if module is not None else ():
        if id(value) in replaced:
            with _counting:
                _replace(module, name, replaced[id(value)])
