"""Who leaves without a goodbye is gone when its lease ends, for a real ROS 2 and for robolink."""

from __future__ import annotations

import pytest

from tests.dds.conftest import Lab, real
from tests.dds.peers import Peer, until

pytestmark = pytest.mark.processes

LEASE = 20.0
"""After which a participant that is silent is gone, in s: Fast DDS's and ours."""


def test_who_ends_is_gone_at_once_and_who_is_killed_by_the_lease(lab: Lab) -> None:
    """Seen by a real node, by one on DDS by itself and by one on Zenoh, beside a bridge."""
    real("kilted")
    with (
        lab.real("kilted", "witness") as witness,
        lab.direct("watcher") as watcher,
        lab.bridge() as bridge,
        lab.beside("zenoh") as beside,
    ):
        witness.ready(), watcher.ready(), beside.ready()
        stay = ["/lab/watcher", "/lab/witness", "/lab/zenoh"]
        all_ = ["/lab/ours", "/lab/real", *stay]

        def see(nodes: list[str], *peers: Peer) -> bool:
            return all(peer.ask("nodes") == nodes for peer in peers or (witness, watcher, beside))

        with lab.real("kilted", "real") as theirs, lab.direct("ours") as ours:
            theirs.ready(), ours.ready()
            until(lambda: see(all_), "all see all")
        until(lambda: see(stay), "the others have said goodbye", 3.0)

        with lab.real("kilted", "real") as theirs, lab.direct("ours") as ours:
            theirs.ready(), ours.ready()
            until(lambda: see(all_), "all see all")
            for each in (theirs, ours, bridge):
                each.kill()
            until(lambda: see(["/lab/zenoh"], beside), "without a bridge nobody is there for the one on Zenoh", 3.0)
            until(lambda: see(stay[:2], witness, watcher), "their leases end", LEASE + 3.0)
