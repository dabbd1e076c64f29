"""Scouting: which sessions answer a multicast, as opposed to those that are known by gossip alone."""

from __future__ import annotations

import time
from collections.abc import Collection

import zenoh

from robolink.system import clocks

STEP = 0.005
"""Interval at which answers are looked for, in seconds."""


def answering(config: zenoh.Config, sought: Collection[str], within: float) -> frozenset[str]:
    """Return the ids of sessions that answer a multicast, once all that are sought have, or the time is over.

    Args:
        config: Zenoh's configuration of a session, which has the group and the interface.
        sought: Ids of sessions.
        within: Timeout of their answers, in seconds.
    """
    found = set[str]()
    deadline = clocks.monotonic() + within
    try:
        scout = zenoh.scout(what="peer|router", config=config)
    except zenoh.ZError:  # there is no interface for it
        return frozenset()
    try:
        while not found.issuperset(sought) and clocks.monotonic() < deadline:
            if (hello := scout.try_recv()) is None:
                time.sleep(STEP)
            else:
                found.add(str(hello.zid))
    finally:
        scout.stop()  # type: ignore[no-untyped-call]
    return frozenset(found)
