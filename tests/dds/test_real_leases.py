"""Who leaves without a goodbye is gone when its lease ends, for a real ROS 2 and for robolink."""

from __future__ import annotations

import pytest

from tests.dds.conftest import Lab, real
from tests.dds.peers import until

pytestmark = pytest.mark.processes

LEASE = 20.0
"""After which a participant that is silent is gone, in s: Fast DDS's and ours."""


def test_who_ends_is_gone_at_once_and_who_is_killed_by_the_lease(lab: Lab) -> None:
    real("kilted")
    with lab.real("kilted", "witness") as witness, lab.direct("watcher") as watcher:
        witness.ready(), watcher.ready()
        with lab.real("kilted", "real") as theirs, lab.direct("ours") as ours:
            theirs.ready(), ours.ready()
            all_ = ["/lab/ours", "/lab/real", "/lab/watcher", "/lab/witness"]
            until(lambda: witness.ask("nodes") == watcher.ask("nodes") == all_, "all see all")
        stay = ["/lab/watcher", "/lab/witness"]
        until(lambda: witness.ask("nodes") == watcher.ask("nodes") == stay, "the others have said goodbye", 3.0)

        with lab.real("kilted", "real") as theirs, lab.direct("ours") as ours:
            theirs.ready(), ours.ready()
            until(lambda: witness.ask("nodes") == watcher.ask("nodes") == all_, "all see all")
            theirs.kill()
            ours.kill()
            until(lambda: witness.ask("nodes") == watcher.ask("nodes") == stay, "their leases end", LEASE + 3.0)
