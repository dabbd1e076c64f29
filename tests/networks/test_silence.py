"""The default network is silent: no frame leaves a machine on which robolink is used, but the kernel's own."""

from __future__ import annotations

from contextlib import ExitStack

import pytest

from tests.support import stalls
from tests.support.frames import KERNEL, kind_of
from tests.support.silence import Neighbours
from tests.support.stalls import PATIENCE
from tests.support.waits import wait_until

ETHERNET, LINK_LOCAL = bytes(12), bytes.fromhex("fe80000000000000" + "0" * 16)
OWN_GROUP, OTHER_GROUP = (bytes.fromhex(each) for each in ("ff0200000000000000000001ff001234", "ff02" + "0" * 27 + "7"))


def ipv6(payload: bytes, following: int, to: bytes) -> bytes:
    return ETHERNET + b"\x86\xdd" + bytes(6) + bytes([following, 255]) + LINK_LOCAL + to + payload


def group_report(group: bytes) -> bytes:
    """Report by which a machine joins a multicast group, behind the option that routers read it."""
    return bytes([58, 0, 5, 2, 0, 0, 1, 0]) + bytes([143, 0, 0, 0, 0, 0, 0, 1]) + bytes([4, 0, 0, 0]) + group


@pytest.mark.parametrize(
    ("frame", "kind"),
    [
        (ETHERNET + b"\x08\x06" + bytes(28), "ARP"),
        (ETHERNET + b"\x08\x00" + bytes(9) + b"\x11" + bytes(6) + bytes([224, 0, 0, 224]), "17, to 224.0.0.224"),
        (ipv6(bytes([135]), 58, OWN_GROUP), KERNEL),
        (ipv6(group_report(OWN_GROUP), 0, OTHER_GROUP), KERNEL),
        (ipv6(group_report(OTHER_GROUP), 0, OTHER_GROUP), "IPv6, protocol 58, to ff02::7"),
        (ipv6(bytes(8), 6, LINK_LOCAL), "IPv6, protocol 6, to fe80::"),
    ],
)
def test_kinds_of_frames(frame: bytes, kind: str) -> None:
    assert kind_of(frame).endswith(kind)


@pytest.mark.processes
@pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts")
def test_nothing_leaves_a_machine_by_itself() -> None:
    """Also beside a router on loopback; one that lets others in is warned of. tests.support.silence takes a minute."""
    with ExitStack() as stack:
        pair = Neighbours(stack)
        here, there = pair.hosts
        pair.start_router(here)
        pair.start_nodes(here, "talker")
        wait_until(lambda: "/talker/state" in pair.run(here, "topic", "list").split(), PATIENCE)
        assert pair.run(here, "network").startswith("network   localhost")
        assert set(pair.frames()) <= {KERNEL}
        pair.speak()
        wait_until(lambda: set(pair.frames()) - {KERNEL})  # what is sent on purpose is seen
        pair.start_router(there, "--listen", "lan")
        wait_until(
            lambda: "also listens at 10.77.0.2: through it other machines" in pair.run(there, "network"), PATIENCE
        )
