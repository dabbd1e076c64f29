"""Participants on two machines: who meets whom, and that nothing leaves by an interface that was not requested."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from tests.support import stalls
from tests.support.frames import KERNEL
from tests.support.obedient import line
from tests.support.rtps_hosts import GROUP_REPORTS, Hosts, knows, report, watch
from tests.support.waits import wait_until

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts"),
]
PATIENCE = 10.0


@pytest.fixture
def hosts() -> Iterator[Hosts]:
    with ExitStack() as stack:
        yield Hosts(stack)


def test_nothing_leaves_loopback_and_no_stranger_comes_in() -> None:
    """Though his announcements reach this machine and a group that somebody joined. rtps_hosts watches for a minute."""
    frames, known = watch(3.0)
    assert set(frames) <= {KERNEL}
    assert [each["peers"] for each in known] == [["two"], ["one"]]
    assert all(sum(each["heard"].values()) > 50 for each in known)


def test_an_interface_meets_the_other_machine_and_this_one(hosts: Hosts) -> None:
    far = hosts.end(hosts.there, "far", "--interface", "cable")
    near = hosts.end(hosts.here, "near", "--interface", "10.77.0.1")
    local = hosts.end(hosts.here, "local")
    wait_until(lambda: knows(far, "near") and knows(near, "far", "local") and knows(local, "near"), PATIENCE)
    for each in (far, near, local):
        report(each, "burst")
    wait_until(
        lambda: report(far)["heard"].get("near", 0) >= 5 and report(local)["heard"].get("near", 0) >= 5, PATIENCE
    )
    wait_until(lambda: {"far", "local"} <= set(report(near)["heard"]), PATIENCE)
    assert set(report(far)["heard"]) == {"near"}


def test_nothing_leaves_by_a_third_interface(hosts: Hosts) -> None:
    joined = hosts.member(*hosts.second_cable())
    capture = hosts.capture(hosts.here, "other")
    far = hosts.end(hosts.there, "far", "--interface", "cable")
    near = hosts.end(hosts.here, "near", "--interface", "cable")
    wait_until(lambda: knows(far, "near") and knows(near, "far"), PATIENCE)
    hosts.end(hosts.there, "stranger", "--interface", "other")
    assert [line(joined) for _ in range(3)] == ["heard"] * 3
    wait_until(lambda: report(near)["heard"].get("far", 0) > 20, PATIENCE)
    assert report(near)["peers"] == ["far"]
    assert {kind for kind in report(capture) if not kind.startswith(GROUP_REPORTS)} <= {KERNEL}


@pytest.mark.skipif(shutil.which("tc") is None, reason="there is no `tc` (iproute2)")
def test_large_best_effort_samples_pass_a_link_of_20_megabits(hosts: Hosts) -> None:
    shaped = "tc qdisc add dev cable root tbf rate 20mbit burst 10kb limit 150kb"
    subprocess.run(["ip", "netns", "exec", hosts.here, *shaped.split()], check=True)
    rough = ("--interface", "cable", "--rough", "--hertz", "0.001")
    far, near = hosts.end(hosts.there, "far", *rough), hosts.end(hosts.here, "near", *rough)
    wait_until(lambda: report(near)["endpoints"] == report(far)["endpoints"] == 2, PATIENCE)
    heard = report(far)["heard"].get("near", 0)
    report(near, "burst")
    wait_until(lambda: report(far)["heard"].get("near", 0) == heard + 5, PATIENCE)


def test_static_peers_meet_where_no_multicast_passes() -> None:
    with ExitStack() as stack:
        hosts = Hosts(stack, stack.enter_context(stalls.two_routed_hosts()))
        far = hosts.end(hosts.there, "far", "--interface", "cable")
        alone = hosts.end(hosts.there, "alone", "--interface", "cable", "--range", "LOCALHOST")
        near = hosts.end(hosts.here, "near", "--interface", "cable", "--peer", "10.78.0.1")
        wait_until(lambda: knows(far, "alone", "near") and knows(alone, "far"), PATIENCE)
        wait_until(
            lambda: report(near)["heard"].get("far", 0) > 5 and report(far)["heard"].get("near", 0) > 5, PATIENCE
        )
        assert not report(near)["heard"].get("alone")
