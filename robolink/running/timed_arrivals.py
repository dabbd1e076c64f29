"""Arrivals with the time at which they came, for tools that listen: the callback of the network is C from end to end.

The time is taken where the network hands a message over, not where it is handled: a queue that is long because the
reader is slow changes no figure. As in `running.inbox`, a sink is a `functools.partial` of a Struct class: calling it
makes an arrival, whose default factory reads the clock and whose `__post_init__` is a queue's `put`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import msgspec

ArrivalType: TypeAlias = Callable[[Any, Any], Any]
"""Class of arrivals: `functools.partial(arrival_type, target)` is the sink of a subscription."""


def timed_arrival(put: Callable[[Any], object], clock: Callable[[], int]) -> ArrivalType:
    """Return a new class of arrivals; making one of it stamps it, and queues it.

    Args:
        put: Function of a queue, in C, that is called with each arrival: it has the fields `target`, `content` (for
            `Transport.read`) and `at`.
        clock: Function, in C, that returns the time in ns.
    """
    return msgspec.defstruct(
        "Arrival",
        ["target", "content", ("at", int, msgspec.field(default_factory=clock))],
        namespace={"__post_init__": put},
        gc=False,
    )
