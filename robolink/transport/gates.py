"""Gates: sinks that can be closed atomically, without a lock, while other threads call them."""

from __future__ import annotations

import functools
from typing import Any


def make_gate(sink: Any, *arguments: object) -> functools.partial[object]:
    """Wrap `sink` in a gate: a C callable that can be closed atomically."""
    # Not partial(sink): a partial of a partial is merged, and this one must not copy what the other one holds.
    return functools.partial(sink.__call__, *arguments)


def aim_gate(gate: Any, sink: Any) -> None:
    """Lead a gate without arguments to another sink, atomically."""
    gate.__setstate__((sink.__call__, (), {}, None))


def close_gate(gate: Any) -> None:
    """Close a gate, since Zenoh does not wait for its callbacks when something is undeclared."""
    gate.__setstate__((bool, (), {}, None))  # bool takes anything or nothing, and does nothing
