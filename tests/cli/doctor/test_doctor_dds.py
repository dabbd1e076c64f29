"""What robolink doctor says about ROS 2 over DDS, and where it reads that."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from robolink.cli.doctor.dds import Dds, Ways, live_ports, look, receive_buffer, udp_ports, unmet_ways
from robolink.cli.doctor.dds_checks import dds
from robolink.cli.doctor.facts import OK, WARNING, Facts, Seen, Settings
from robolink.extensions.optional import PARTICIPANT, part
from robolink.wire import BridgeToken, Mark, mark_data, mark_in
from tests.support.domains import free_dds_domain

DOMAIN = 50
FIRST = 7400 + 250 * DOMAIN


def only(facts: Facts) -> str:
    verdict = dds(facts)
    (one,) = verdict.warnings
    assert verdict.level == WARNING
    return one


def test_nodes_without_a_bridge_are_joined_by_one() -> None:
    facts = Facts(dds=Dds(nodes=2), settings=Settings(domain=7))
    assert only(facts) == (
        "2 processes of ROS 2 speak DDS on domain 7 and this network is Zenoh: join them with 'robolink bridge dds',"
        " or start nodes with --network dds"
    )
    assert only(Facts(dds=Dds(nodes=1))).startswith("1 process of ROS 2 speaks DDS on domain 0 and")


@pytest.mark.parametrize(
    ("facts", "summary"),
    [
        (Facts(), "nobody speaks DDS on this machine and domain"),
        (Facts(dds=Dds(nodes=2, bridges=1)), "2 processes of ROS 2 with DDS: a bridge joins them to this network"),
        (
            Facts(dds=Dds(nodes=1), seen=Seen(bridges=(BridgeToken(0, "ab", "dds", "here"),))),
            "1 process of ROS 2 with DDS: a bridge joins them to this network",
        ),
        (Facts(dds=Dds(bridges=1)), "a bridge runs, and nobody else speaks DDS"),
        (
            Facts(dds=Dds(nodes=1), settings=Settings(network="dds")),
            "1 process of ROS 2 with DDS: this network is theirs",
        ),
    ],
)
def test_nodes_that_are_met_are_no_fault(facts: Facts, summary: str) -> None:
    verdict = dds(facts)
    assert (verdict.level, verdict.summary) == (OK, summary)


@pytest.mark.parametrize(
    ("ways", "begin", "value"),
    [
        (Ways(shared_memory=("talker, pid 7",)), "talker, pid 7 is on shared memory only", "SHM"),
        (Ways(tcp=("a", "b")), "a and b are on TCP, not UDP", "LARGE_DATA"),
    ],
)
def test_processes_on_other_transports_are_named_with_the_remedy(ways: Ways, begin: str, value: str) -> None:
    variable = "FASTDDS_BUILTIN_TRANSPORTS"
    assert only(Facts(dds=Dds(ways=ways))) == (
        f"{begin} ({variable}={value}) and cannot be met: start without that variable, or with {variable}=DEFAULT"
    )


def test_a_discovery_server_is_named_with_the_remedy() -> None:
    assert only(Facts(dds=Dds(ways=Ways(server=("talker, pid 7",))))) == (
        "talker, pid 7 has a discovery server (ROS_DISCOVERY_SERVER) and cannot be met: start without that variable"
    )


@pytest.mark.parametrize("value", ["SHM", "shm", "LARGE_DATA", "LARGE_DATA?max_msg_size=1MB"])
def test_a_setting_with_which_nobody_is_met(value: str) -> None:
    assert "unset it" in only(Facts(environ={"FASTDDS_BUILTIN_TRANSPORTS": value}))


@pytest.mark.parametrize("value", ["", "DEFAULT", "UDPv4"])
def test_a_setting_with_which_all_are_met(value: str) -> None:
    assert dds(Facts(environ={"FASTDDS_BUILTIN_TRANSPORTS": value})).level == OK
    confined = {"FASTDDS_BUILTIN_TRANSPORTS": "SHM", "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    assert dds(Facts(environ=confined)).level == OK


def test_a_small_receive_buffer_matters_where_there_is_dds() -> None:
    small = Dds(bridges=1, receive_buffer=212_992)
    assert only(Facts(dds=small)).startswith("net.core.rmem_max is 212,992 bytes: images over DDS are late")
    assert "sudo sysctl -w net.core.rmem_max=8388608" in only(Facts(dds=small))
    assert dds(Facts(dds=small._replace(bridges=0))).level == OK
    assert dds(Facts(dds=small._replace(receive_buffer=4 << 20))).level == OK
    assert "rmem_max" in only(Facts(dds=Dds(receive_buffer=1), settings=Settings(network="dds")))


# --- Where it is read -----------------------------------------------------------------------------------------------

# As real nodes of Kilted and Jazzy had them, in a network namespace.
UDP = {
    "DEFAULT": {7000, 19900, 19910, 19911},
    "SHM": set(),
    "LARGE_DATA": {19900, 55649},
    "UDPv4": {19900, 19910, 19911},
}
SHARED = {"DEFAULT": {7000, 19911}, "SHM": {7000, 19900, 19910, 19911}, "LARGE_DATA": {7000, 19911}, "UDPv4": set()}


@pytest.mark.parametrize(
    ("mode", "expected"),
    [
        ("DEFAULT", Ways()),
        ("SHM", Ways(shared_memory=("pid 7",))),
        ("LARGE_DATA", Ways(tcp=("pid 7",))),
        ("UDPv4", Ways()),
    ],
)
def test_ways_are_told_by_the_ports(mode: str, expected: Ways) -> None:
    shared = dict.fromkeys(SHARED[mode], 7)
    assert unmet_ways(DOMAIN, shared, UDP[mode], {}) == expected
    assert unmet_ways(DOMAIN + 1, shared, UDP[mode], {}) == Ways()


def test_a_discovery_server_is_in_the_environment_of_the_process() -> None:
    shared = dict.fromkeys(SHARED["DEFAULT"], 7)
    environs = {7: {"ROS_DISCOVERY_SERVER": "127.0.0.1:11811"}}
    assert unmet_ways(DOMAIN, shared, UDP["DEFAULT"], environs) == Ways(server=("pid 7",))


def test_ports_of_whoever_was_killed_are_nobodys(tmp_path: Path) -> None:
    for name in ("fastdds_port19911_el", "fastrtps_port19913_el", "fastdds_port19915_el", "fastdds_port19915", "other"):
        (tmp_path / name).touch()
    alive, older, waited = (
        (tmp_path / name).stat().st_ino
        for name in ("fastdds_port19911_el", "fastrtps_port19913_el", "fastdds_port19915_el")
    )
    locks = tmp_path / "locks"
    locks.write_text(
        f"1: FLOCK  ADVISORY  WRITE 19289 00:1b:{alive} 0 EOF\n1: -> FLOCK  ADVISORY  WRITE 5 00:1b:{waited} 0 EOF\n"
        f"2: POSIX  ADVISORY  READ 31 08:02:{older} 128 128\n"
    )
    assert live_ports(tmp_path, locks) == {19911: 19289, 19913: 31}
    assert live_ports(tmp_path / "none", locks) == {}


def test_bound_ports_and_the_buffer_are_read(tmp_path: Path) -> None:
    line = "  12: 0100007F:{} 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 1 2 0 0\n"
    (tmp_path / "udp").write_text("  sl  local_address rem_address\n" + line.format("4DC6") + line.format("1CE8"))
    assert udp_ports(tmp_path) == {19910, 7400}
    (tmp_path / "rmem_max").write_text("212992\n")
    assert receive_buffer(tmp_path / "rmem_max") == 212_992
    assert receive_buffer(tmp_path / "none") is None


def test_a_bridge_is_marked_in_its_participants_user_data() -> None:
    assert mark_in(b"enclave=/;" + mark_data(Mark("12ab", "my host")) + b"\0") == Mark("12ab", "my-host")
    assert mark_in(b"enclave=/;") == mark_in(b"robolink_bridge=;") is None


@pytest.mark.annex("dds")
@pytest.mark.processes
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="what is bound is read from /proc")
def test_a_participant_meets_those_of_ros_2_and_bridges() -> None:
    with free_dds_domain() as domain:
        _meet_on(domain)


def _meet_on(domain: int) -> None:
    participant = part(PARTICIPANT, "DDS")
    ros = b"enclave=/;"
    others = [participant(domain, user_data=data) for data in (ros, ros + mark_data(Mark("ab", "here")), b"")]
    try:
        found = look(domain)
    finally:
        for each in others:
            each.close()
    assert (found.nodes, found.bridges) == (1, 1)
    assert look(domain)._replace(receive_buffer=None) == Dds()
