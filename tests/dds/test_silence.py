"""`--network dds` and the bridge are silent by default: nothing leaves the machine, and no stranger comes in."""

from __future__ import annotations

import pytest

from tests.support import stalls
from tests.support.frames import KERNEL
from tests.support.rtps_hosts import watch


@pytest.mark.processes
@pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts")
def test_nothing_leaves_a_machine_and_no_stranger_comes_in() -> None:
    """tests.support.rtps_hosts watches for a minute."""
    frames, known = watch(3.0, nodes=True)
    assert set(frames) <= {KERNEL}
    assert [each["peers"] for each in known] == [["/", "/", "two"], ["/", "/", "one"]]
