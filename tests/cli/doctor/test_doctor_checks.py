"""What the checks of robolink doctor conclude about a machine and its network."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.cli.doctor import checks, dds_checks, graph_checks
from robolink.cli.doctor.facts import ERROR, LONGEST, OK, UNKNOWN, WARNING, ClockOffset, Facts, Seen, Settings, Verdict
from robolink.cli.doctor.gathering import read_settings
from robolink.cli.doctor.ports import Holder
from robolink.networks import port_probe
from robolink.networks.port_probe import Port
from robolink.transport import shared_memory
from robolink.transport.reach import Link, Reach
from robolink.transport.shared_memory import Decision, Machine, decide, decision
from robolink.wire import NodeToken


def node(name: str) -> NodeToken:
    return NodeToken(0, "a", "0", "/", "/", name)


def only(found: tuple[str, ...]) -> str:
    (one,) = found
    return one


@pytest.mark.parametrize(
    "check", [*checks.CHECKS, *dds_checks.DDS_CHECKS, *graph_checks.GRAPH_CHECKS], ids=lambda each: each.name
)
def test_no_check_finds_fault_with_an_idle_machine(check: Any) -> None:
    assert check.decide(Facts()).level in (OK, UNKNOWN)


def test_versions_that_are_too_old_or_missing_are_errors() -> None:
    old = Facts(python=(3, 9, 1), versions={"robolink": "0.1", "eclipse-zenoh": "1.9.3", "numpy": ""})
    assert [each.split(":")[0] for each in checks.versions(old).errors] == [
        "numpy is not installed",
        "Python 3.9.1 is too old",
        "eclipse-zenoh 1.9.3 is too old",
    ]
    new = Facts(python=(3, 11, 2), versions={"robolink": "0.1.0", "eclipse-zenoh": "1.10.2"})
    assert checks.versions(new) == Verdict("robolink 0.1.0, Python 3.11.2, eclipse-zenoh 1.10.2")
    both = only(checks.versions(new._replace(namesakes=("robodk 6.0.2",))).warnings)
    assert both.startswith("robodk 6.0.2 also installs a module 'robolink'")
    assert "'pip uninstall robodk'" in both


@pytest.mark.parametrize(
    ("found", "numpy", "said"),
    [
        ({"opencv-python": "5.0.0.93"}, "2.4.6", ()),
        ({"opencv-contrib-python-headless": "4.8.1.78"}, "1.26.4", ()),
        (
            {"opencv-python": "4.12.0.88", "opencv-python-headless": "4.12.0.88"},
            "2.0.0",
            ("opencv-python and opencv-python-headless overwrite each other's files: pip uninstall opencv-python ",),
        ),
        ({"opencv-python": "4.7.0.72"}, "1.26.4", ("opencv-python 4.7.0.72 is too old for robolink's images",)),
        ({"opencv-python": "4.9.0.80"}, "2.1.0", ("opencv-python 4.9.0.80 does not load with numpy 2",)),
    ],
)
def test_opencv_is_there_once_and_fits(found: dict[str, str], numpy: str, said: tuple[str, ...]) -> None:
    verdict = checks.opencv(Facts(opencv=found, versions={"numpy": numpy}))
    assert [each.startswith(begin) for each, begin in zip(verdict.warnings, said, strict=True)] == [True] * len(said)
    assert all(f"{name} {version}" in verdict.summary for name, version in found.items())


@pytest.mark.parametrize(
    ("environ", "expected"),
    [
        ({}, Settings()),
        ({"ROS_DOMAIN_ID": "7"}, Settings(domain=7)),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "off"},
         Settings(network="off", origin="ROS_AUTOMATIC_DISCOVERY_RANGE", meets=False)),
        ({"ROBOLINK_NETWORK": "tcp/10.0.0.1:7447"},
         Settings(network="tcp/10.0.0.1:7447", origin="ROBOLINK_NETWORK", meets=False, shared_memory=False)),
        ({"ZENOH_CONFIG_OVERRIDE": "transport/shared_memory/enabled=false"}, Settings(shared_memory=False)),
        ({"ROBOLINK_SHARED_MEMORY": "off"}, Settings(shared_memory=False)),
        ({"ROBOLINK_TRANSPORT": "memory"}, Settings(transport="memory")),
    ],
)  # fmt: skip
def test_the_settings_in_force_are_read_as_nodes_read_them(
    monkeypatch: pytest.MonkeyPatch, environ: dict[str, str], expected: Settings
) -> None:
    monkeypatch.setattr(shared_memory, "this_machine", lambda: Machine(total=2**30, free=2**30))
    assert read_settings(environ)[0] == expected


@pytest.mark.parametrize(
    ("environ", "named"),
    [
        ({"ROS_DOMAIN_ID": "233"}, "ROS_DOMAIN_ID must be a number from 0 to 232"),
        ({"ROS_DOMAIN_ID": "lab"}, "ROS_DOMAIN_ID"),
        ({"ROBOLINK_SHARED_MEMORY": "yes"}, "ROBOLINK_SHARED_MEMORY must be one of auto, on, off, got 'yes'"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "WORLD"}, "ROS_AUTOMATIC_DISCOVERY_RANGE"),
        ({"ZENOH_SESSION_CONFIG_URI": "/nowhere.json5"}, "ZENOH_SESSION_CONFIG_URI"),
        ({"ZENOH_CONFIG_OVERRIDE": "no/such/path=1"}, "ZENOH_CONFIG_OVERRIDE"),
    ],
)
def test_settings_that_cannot_be_are_errors_that_name_the_variable(environ: dict[str, str], named: str) -> None:
    found = Facts(environ=environ, settings=read_settings(environ)[0])
    assert named in only(checks.settings(found).errors)


@pytest.mark.parametrize(
    ("environ", "named"),
    [
        ({"ROS_LOCALHOST_ONLY": "1"}, "ROS_LOCALHOST_ONLY=1 has no effect"),
        ({"ROS_STATIC_PEERS": "10.0.0.1"}, "ROS_STATIC_PEERS"),
        ({"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}, "RMW_IMPLEMENTATION=rmw_zenoh_cpp"),
        ({"ROBOLINK_TRANSPORT": "memory"}, "only their own process"),
    ],
)
def test_settings_that_mislead_are_warnings(environ: dict[str, str], named: str) -> None:
    found = checks.settings(Facts(environ=environ, settings=read_settings(environ)[0]))
    assert (found.errors, named in only(found.warnings)) == ((), True)


def test_settings_without_fault_say_where_each_comes_from() -> None:
    environ = {"ROS_DOMAIN_ID": "7", "ROS_LOCALHOST_ONLY": "0", "ZENOH_CONFIG_OVERRIDE": "scouting/delay=1"}
    found = checks.settings(Facts(environ=environ, settings=read_settings(environ)[0]))
    assert found == Verdict(
        "domain 7 (ROS_DOMAIN_ID), network localhost (the default), ZENOH_CONFIG_OVERRIDE=scouting/delay=1"
    )


@pytest.mark.parametrize(
    ("role", "level", "said"),
    [
        (port_probe.PEER, OK, "held by a Zenoh peer (python talker.py, pid 12)"),
        (port_probe.STRANGER, ERROR, "held by a stranger (python talker.py, pid 12) that does not speak Zenoh"),
        (port_probe.SILENT, ERROR, "says nothing"),
        (port_probe.REFUSES, ERROR, "refuses"),
        (None, OK, "port 17450 of domain 3 is free"),
    ],
)
def test_who_holds_the_rendezvous_port(role: str | None, level: str, said: str) -> None:
    ports = {17450: Port(17450, role)} if role else {}
    found = checks.rendezvous(
        Facts(settings=Settings(domain=3), ports=ports, holders={17450: Holder(12, "python talker.py")})
    )
    assert (found.level, said in " ".join([found.summary, *found.errors])) == (level, True)


@pytest.mark.parametrize(
    ("keyed", "secured", "level", "said"),
    [
        (True, True, OK, "held by a process with security"),
        (True, False, ERROR, "a process with security, which lets nobody in without keys"),
        (False, True, ERROR, "a Zenoh peer, which has no keys"),
        (False, False, OK, "held by a Zenoh peer"),
    ],
)
def test_who_holds_the_rendezvous_port_with_keys_or_without(keyed: bool, secured: bool, level: str, said: str) -> None:
    port = Port(17447, port_probe.STRANGER if keyed else port_probe.PEER)
    facts = Facts(
        ports={17447: port}, keyed_ports=frozenset({17447} if keyed else ()), reach=KEYED if secured else LOCAL
    )
    found = checks.rendezvous(facts)
    assert (found.level, said in " ".join([found.summary, *found.errors])) == (level, True)


@pytest.mark.parametrize(("secured", "level"), [(True, OK), (False, WARNING)])
def test_a_router_with_keys_is_no_stranger(secured: bool, level: str) -> None:
    ports = {7447: Port(7447, port_probe.STRANGER)}
    found = checks.router(Facts(ports=ports, keyed_ports=frozenset({7447}), reach=KEYED if secured else LOCAL))
    assert (found.level, "held by a process with security" in found.summary) == (level, True)


LOCAL = Reach(listens=("tcp/127.0.0.1:17447",), interfaces=("lo",))
KEYED = LOCAL._replace(listens=("tls/127.0.0.1:17447",))
SUBNET = Reach(listens=("tcp/0.0.0.0:17447",), multicast="224.0.0.224:17447")
AWAY = Link("peer", "tcp/10.0.0.1:40000", "tcp/10.0.0.2:17447")
ITSELF = Link("peer", "tcp/10.0.0.1:40000", "tcp/10.0.0.1:17447")


@pytest.mark.parametrize(
    ("reach", "seen", "level", "said"),
    [
        (Reach(listens=("tcp/127.0.0.1:0",)), Seen(), OK, "nodes meet those on this machine only"),
        (SUBNET, Seen(links=(ITSELF,), tokens=(node("a"),)), WARNING, "no other machine has answered"),
        (SUBNET, Seen(links=(ITSELF, AWAY), tokens=(node("a"),)), OK, "linked to 1 session there"),
        (SUBNET, Seen(links=(AWAY,)), WARNING, "linked to 1 session there, but nobody there has a node"),
        (SUBNET, Seen(links=(AWAY,), other_domains={3: 1}), OK, "linked to 1 session there"),
        (SUBNET, Seen(error="no network"), UNKNOWN, "the local network"),
        (Reach("client", ("tcp/127.0.0.1:7447",)), Seen(), WARNING, "no other machine has answered"),
    ],
)
def test_who_asks_for_others_is_told_that_nobody_is_there(reach: Reach, seen: Seen, level: str, said: str) -> None:
    found = checks.reach(Facts(reach=reach, seen=seen))
    assert (found.level, said in " ".join([found.summary, *found.warnings])) == (level, True)


def test_a_long_way_to_nobody_is_said_in_a_line() -> None:
    network = "connect/endpoints=[" + "'tcp/10.0.0.1:7447'," * 999
    (said,) = checks.reach(Facts(settings=Settings(network=network), reach=SUBNET)).findings
    assert len(said) <= LONGEST
    assert "\n" not in said


def test_the_rendezvous_is_not_judged_where_it_is_not_used() -> None:
    strange = {17447: Port(17447)}
    for settings in (Settings(meets=False, network="off"), Settings(transport="memory")):
        assert checks.rendezvous(Facts(settings=settings, ports=strange)).level == OK


@pytest.mark.parametrize(
    ("ports", "level", "said"),
    [
        ({}, OK, "no ROS 2 router"),
        ({7447: Port(7447, port_probe.ROUTER)}, OK, "a ROS 2 router answers"),
        ({7447: Port(7447, port_probe.PEER)}, ERROR, "which is not a router"),
        ({7447: Port(7447, port_probe.SILENT)}, ERROR, "held by a stranger that accepts connections and says nothing"),
    ],
)
def test_the_routers_port(ports: dict[int, Port], level: str, said: str) -> None:
    found = checks.router(Facts(ports=ports))
    assert (found.level, said in " ".join([found.summary, *found.errors])) == (level, True)


def test_a_router_that_lets_others_in_is_a_warning() -> None:
    answers = Facts(ports={7447: Port(7447, port_probe.ROUTER)})
    said = only(checks.router(answers._replace(router_open_at=("10.0.0.5",))).warnings)
    assert "also listens at 10.0.0.5: through it other machines hear and command your nodes" in said
    assert "ZENOH_CONFIG_OVERRIDE='listen/endpoints=[\"tcp/127.0.0.1:7447\"]'" in said
    assert "is another user's, mallory" in only(checks.router(answers._replace(router_owner="mallory")).warnings)
    asked_for = answers._replace(router_open_at=("10.0.0.5",), reach=SUBNET)
    assert checks.router(asked_for).level == OK


def test_a_router_that_is_asked_for_must_answer() -> None:
    asked = Settings(network="tcp/10.0.0.1:7447", meets=False)
    assert "nothing listens at tcp/10.0.0.1:7447" in only(checks.router(Facts(settings=asked)).errors)
    strange = Facts(settings=asked, far_router=Port(7447))
    assert "does not answer as Zenoh" in only(checks.router(strange).errors)
    assert checks.router(Facts(settings=asked, far_router=Port(7447, port_probe.ROUTER))).level == OK


def test_nodes_that_are_all_on_another_domain_are_a_warning() -> None:
    elsewhere = Facts(other_domains={3: 2, 5: 1, 9: None, 11: 0})
    assert only(checks.domains(elsewhere).warnings) == (
        "domain 0 has 0 nodes, but domain 3 has 2 nodes, domain 5 has 1 node and domain 9 has somebody: "
        "is ROS_DOMAIN_ID what you want?"
    )
    assert checks.domains(elsewhere._replace(seen=Seen(tokens=(node("a"),)))).level == OK
    assert checks.domains(elsewhere._replace(seen=Seen(error="no network"))).level == UNKNOWN


def test_shared_memory_that_is_off_is_explained_and_no_warning() -> None:
    small = Machine(lockable=8 * 2**20, total=2**30, free=2**30)
    verdict = checks.memory(Facts(machine=small, memory=decide(small)))
    assert verdict.level == OK
    assert "off: this process may lock 8 MB of memory, and 512 MB are needed" in verdict.summary
    assert "ulimit -l" in verdict.summary


def test_shared_memory_that_is_forced_on_where_it_is_not_safe_is_a_warning() -> None:
    full = Machine(total=64 * 2**20, free=10 * 2**20)
    forced = checks.memory(Facts(machine=full, memory=decision({"ROBOLINK_SHARED_MEMORY": "on"}, full)))
    assert "ROBOLINK_SHARED_MEMORY=on, although 10 MB of /dev/shm are free" in only(forced.warnings)
    by_zenoh = checks.memory(Facts(machine=full, memory=Decision(True, "an override decides", forced=True)))
    assert by_zenoh.level == WARNING


def test_shared_memory_that_is_on_where_there_is_room_is_fine() -> None:
    roomy = Machine(total=2**30, free=2**30)
    for environ in ({}, {"ROBOLINK_SHARED_MEMORY": "on"}):
        assert checks.memory(Facts(machine=roomy, memory=decision(environ, roomy))).level == OK


def test_a_machine_that_does_not_reach_itself_is_an_error() -> None:
    assert "ip link set lo up" in only(checks.loopback(Facts(loopback=False)).errors)
    assert "ip link" not in only(checks.loopback(Facts(loopback=False, platform="win32")).errors)


@pytest.mark.parametrize(
    ("seconds", "uncertainty", "level"),
    [(0.0004, 0.001, OK), (-0.3, 0.001, WARNING), (0.3, 0.25, OK), (5.0, 0.2, ERROR), (-5.0, 0.2, ERROR)],
)
def test_clocks_apart_count_beyond_what_the_answer_took(seconds: float, uncertainty: float, level: str) -> None:
    found = checks.clocks(Facts(seen=Seen(clocks=(ClockOffset("/robot", seconds, uncertainty),))))
    assert found.level == level
    if level != OK:
        assert f"/robot is {abs(seconds):g} s {'ahead' if seconds > 0 else 'behind'}" in found.findings[0]


def test_clocks_that_were_not_measured_are_said_to_be_so() -> None:
    assert checks.clocks(Facts()) == Verdict("not measured: no node that tells the time", unknown=True)
