"""What the checks of robolink doctor conclude from facts."""

from __future__ import annotations

import time
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.cli.doctor import checks, graph_checks, look, probes
from robolink.cli.doctor.facts import ClockOffset, Facts, Seen, Settings, Space, read_settings
from robolink.cli.doctor.probes import Holder, Port
from robolink.cli.doctor.verdict import ERROR, LONGEST, OK, UNKNOWN, WARNING, Verdict, listed
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.transport.reach import Link, Reach
from robolink.wire import (
    NO_HASH,
    EndpointKind,
    EndpointToken,
    NodeToken,
)

PUBLISHER, SUBSCRIPTION = EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION
SERVICE, CLIENT = EndpointKind.SERVICE, EndpointKind.CLIENT
HASH, OTHER_HASH = "RIHS01_" + "a" * 64, "RIHS01_" + "b" * 64
PLAIN = QoSProfile(depth=10)
PATIENCE = 30.0
PARAMETERS = "rcl_interfaces/srv/GetParameters"
STRING, INT32 = "std_msgs/msg/String", "std_msgs/msg/Int32"


def end(
    kind: EndpointKind,
    name: str,
    node: str = "talker",
    type_name: str = STRING,
    type_hash: str = HASH,
    qos: QoSProfile = PLAIN,
    session: str = "a",
    node_id: str = "0",
) -> EndpointToken:
    return EndpointToken(0, session, node_id, "1", kind, "/", "/", node, name, type_name, type_hash, qos)


def node(name: str, session: str = "a", node_id: str = "0", namespace: str = "/") -> NodeToken:
    return NodeToken(0, session, node_id, "/", namespace, name)


def seeing(*tokens: NodeToken | EndpointToken, **more: Any) -> Facts:
    return Facts(seen=Seen(session="e", tokens=tokens, **more))


def only(found: tuple[str, ...]) -> str:
    (one,) = found
    return one


# --- Checks of the machine and its network ----------------------------------------------------------------------


@pytest.mark.parametrize("check", [*checks.CHECKS, *graph_checks.GRAPH_CHECKS], ids=lambda each: each.name)
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
    ("environ", "expected"),
    [
        ({}, Settings()),
        ({"ROS_DOMAIN_ID": "7"}, Settings(domain=7)),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "off"},
         Settings(network="off", asked_by="ROS_AUTOMATIC_DISCOVERY_RANGE", meets=False)),
        ({"ROBOLINK_NETWORK": "tcp/10.0.0.1:7447"},
         Settings(network="tcp/10.0.0.1:7447", asked_by="ROBOLINK_NETWORK", meets=False)),
        ({"ZENOH_CONFIG_OVERRIDE": "transport/shared_memory/enabled=false"}, Settings(shared_memory=False)),
        ({"ROBOLINK_TRANSPORT": "memory"}, Settings(transport="memory")),
    ],
)  # fmt: skip
def test_the_settings_in_force_are_read_as_nodes_read_them(environ: dict[str, str], expected: Settings) -> None:
    assert read_settings(environ) == expected


@pytest.mark.parametrize(
    ("environ", "named"),
    [
        ({"ROS_DOMAIN_ID": "233"}, "ROS_DOMAIN_ID must be a number from 0 to 232"),
        ({"ROS_DOMAIN_ID": "lab"}, "ROS_DOMAIN_ID"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "WORLD"}, "ROS_AUTOMATIC_DISCOVERY_RANGE"),
        ({"ZENOH_SESSION_CONFIG_URI": "/nowhere.json5"}, "ZENOH_SESSION_CONFIG_URI"),
        ({"ZENOH_CONFIG_OVERRIDE": "no/such/path=1"}, "ZENOH_CONFIG_OVERRIDE"),
    ],
)
def test_settings_that_cannot_be_are_errors_that_name_the_variable(environ: dict[str, str], named: str) -> None:
    found = Facts(environ=environ, settings=read_settings(environ))
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
    found = checks.settings(Facts(environ=environ, settings=read_settings(environ)))
    assert (found.errors, named in only(found.warnings)) == ((), True)


def test_settings_without_fault_say_where_each_comes_from() -> None:
    environ = {"ROS_DOMAIN_ID": "7", "ROS_LOCALHOST_ONLY": "0", "ZENOH_CONFIG_OVERRIDE": "scouting/delay=1"}
    found = checks.settings(Facts(environ=environ, settings=read_settings(environ)))
    assert found == Verdict(
        "domain 7 (ROS_DOMAIN_ID), network localhost (the default), ZENOH_CONFIG_OVERRIDE=scouting/delay=1"
    )


@pytest.mark.parametrize(
    ("role", "level", "said"),
    [
        (probes.PEER, OK, "held by a Zenoh peer (python talker.py, pid 12)"),
        (probes.STRANGER, ERROR, "held by a stranger (python talker.py, pid 12) that does not speak Zenoh"),
        (probes.SILENT, ERROR, "says nothing"),
        (probes.REFUSES, ERROR, "refuses"),
        (None, OK, "port 17450 of domain 3 is free"),
    ],
)
def test_who_holds_the_rendezvous_port(role: str | None, level: str, said: str) -> None:
    ports = {17450: Port(17450, role)} if role else {}
    found = checks.rendezvous(
        Facts(settings=Settings(domain=3), ports=ports, holders={17450: Holder(12, "python talker.py")})
    )
    assert (found.level, said in " ".join([found.summary, *found.errors])) == (level, True)


SUBNET = Reach(listens=("tcp/0.0.0.0:17447",), multicast="224.0.0.224:17447")
AWAY = Link("peer", "tcp/10.0.0.1:40000", "tcp/10.0.0.2:17447")
ITSELF = Link("peer", "tcp/10.0.0.1:40000", "tcp/10.0.0.1:17447")


@pytest.mark.parametrize(
    ("reach", "seen", "level", "said"),
    [
        (Reach(listens=("tcp/127.0.0.1:0",)), Seen(), OK, "nodes meet this machine only"),
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
        ({7447: Port(7447, probes.ROUTER)}, OK, "a ROS 2 router answers"),
        ({7447: Port(7447, probes.PEER)}, ERROR, "which is no router"),
        ({7447: Port(7447, probes.SILENT)}, ERROR, "held by a stranger that accepts connections and says nothing"),
    ],
)
def test_the_routers_port(ports: dict[int, Port], level: str, said: str) -> None:
    found = checks.router(Facts(ports=ports))
    assert (found.level, said in " ".join([found.summary, *found.errors])) == (level, True)


def test_a_router_that_lets_others_in_is_a_warning() -> None:
    answers = Facts(ports={7447: Port(7447, probes.ROUTER)})
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
    assert checks.router(Facts(settings=asked, far_router=Port(7447, probes.ROUTER))).level == OK


def test_nodes_that_are_all_on_another_domain_are_a_warning() -> None:
    elsewhere = Facts(other_domains={3: 2, 5: 1, 9: None, 11: 0})
    assert only(checks.domains(elsewhere).warnings) == (
        "domain 0 has 0 nodes, but domain 3 has 2 nodes, domain 5 has 1 node and domain 9 has somebody: "
        "is ROS_DOMAIN_ID what you want?"
    )
    assert checks.domains(elsewhere._replace(seen=Seen(tokens=(node("a"),)))).level == OK
    assert checks.domains(elsewhere._replace(seen=Seen(error="no network"))).level == UNKNOWN


def test_little_space_in_shared_memory_is_a_warning() -> None:
    assert checks.memory(Facts(shared_memory=Space(64 * 2**20, 10 * 2**20))).level == WARNING
    assert checks.memory(Facts(shared_memory=Space(256 * 2**20, 200 * 2**20))).level == OK
    assert checks.memory(Facts(settings=Settings(shared_memory=False), shared_memory=Space(0, 0))).level == OK


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


# --- Checks of the graph ------------------------------------------------------------------------------------------


def test_types_that_differ_are_an_error_that_names_both_ends() -> None:
    found = seeing(
        end(PUBLISHER, "/a", "talker"),
        end(SUBSCRIPTION, "/a", "listener", INT32),
        end(SUBSCRIPTION, "/a", "monitor", INT32),
        end(PUBLISHER, "/b", "talker"),
        end(SUBSCRIPTION, "/b", "listener"),
    )
    assert only(graph_checks.topic_types(found).errors) == (
        f"/a: /talker publishes {STRING}, /listener and /monitor subscribes to {INT32}: they never meet"
    )


def test_types_of_one_name_and_two_hashes_never_meet() -> None:
    found = seeing(end(PUBLISHER, "/a"), end(SUBSCRIPTION, "/a", "listener", type_hash=OTHER_HASH))
    said = only(graph_checks.topic_types(found).errors)
    assert "of hash RIHS01_aaaaaaaa..." in said
    assert "of hash RIHS01_bbbbbbbb..." in said


def test_two_publishers_of_different_types_meet_nobody_they_should() -> None:
    assert graph_checks.topic_types(seeing(end(PUBLISHER, "/a"), end(PUBLISHER, "/a", "b", INT32))).level == OK


def test_service_types_that_differ_are_an_error() -> None:
    found = seeing(
        end(SERVICE, "/reset", "robot", "std_srvs/srv/Empty"), end(CLIENT, "/reset", "boss", "std_srvs/srv/Trigger")
    )
    assert only(graph_checks.service_types(found).errors) == (
        "/reset: /robot serves std_srvs/srv/Empty, /boss calls std_srvs/srv/Trigger: they never meet"
    )


def test_humble_and_newer_nodes_are_a_warning_of_their_own() -> None:
    found = seeing(end(PUBLISHER, "/a", type_hash=NO_HASH), end(SUBSCRIPTION, "/a", "listener"))
    assert graph_checks.topic_types(found).level == OK
    said = only(graph_checks.distributions(found).warnings)
    assert said.startswith("/talker of ROS 2 Humble (no type hashes) and /listener of a newer ROS 2")
    assert graph_checks.distributions(seeing(end(PUBLISHER, "/a", type_hash=NO_HASH))).level == OK


def test_a_subscription_without_publisher_is_a_warning_with_the_nearest_topic() -> None:
    found = seeing(
        end(SUBSCRIPTION, "/scna", "listener"),
        end(PUBLISHER, "/scan"),
        *(end(SUBSCRIPTION, each, "listener") for each in graph_checks.SILENT_TOPICS),
        end(SUBSCRIPTION, "/move/_action/feedback", "listener"),
        end(SUBSCRIPTION, "/odom", "_robolink_cli_77"),
        end(SUBSCRIPTION, "/odom", "_ros2cli_daemon_0"),
    )
    assert only(graph_checks.topics(found).warnings) == (
        "/scna has no publisher; /listener subscribed to it (did you mean '/scan'?)"
    )


def test_a_topic_or_service_of_another_type_is_none_that_could_have_been_meant() -> None:
    found = seeing(
        end(SUBSCRIPTION, "/ada/cmd_vel", "world", "geometry_msgs/msg/Twist"),
        end(PUBLISHER, "/ada/bumper", "world", "std_msgs/msg/Bool"),
        end(CLIENT, "/ada/start", "boss", "std_srvs/srv/Trigger"),
        end(SERVICE, "/ada/start_at", "world", "std_srvs/srv/SetBool"),
    )
    assert only(graph_checks.topics(found).warnings) == "/ada/cmd_vel has no publisher; /world subscribed to it"
    assert only(graph_checks.services(found).warnings) == "service /ada/start has no server; /boss waits for it"


def test_a_client_without_server_and_a_service_with_two_are_warnings() -> None:
    found = seeing(
        end(CLIENT, "/reset", "boss"),
        end(CLIENT, "/move/_action/send_goal", "boss"),
        end(CLIENT, "/move/_action/get_result", "boss"),
        end(SERVICE, "/add", "one"),
        end(SERVICE, "/add", "two"),
        end(CLIENT, "/other", "_robolink_cli_1"),
    )
    assert graph_checks.services(found).warnings == (
        "service /add has 2 servers, and each does every call: /one and /two",
        "action /move has no server; /boss waits for it",
        "service /reset has no server; /boss waits for it",
    )


def test_two_nodes_of_one_name_are_a_warning() -> None:
    apart = seeing(node("robot", "a"), node("robot", "b"), node("robot", "b", "9", "/lab"))
    assert only(graph_checks.nodes(apart).warnings).startswith("2 nodes are named /robot: rename one")
    ends = [end(PUBLISHER, f"/{each}", "robot", node_id=str(each % 2)) for each in range(4)]
    assert graph_checks.nodes(seeing(node("robot", "a", "0"), node("robot", "a", "1"), *ends)).level == WARNING


def test_a_peer_that_announces_a_node_for_each_of_its_endpoints_has_one() -> None:
    ends = [end(PUBLISHER, f"/{each}", "robot", node_id=str(each)) for each in range(3)]
    assert graph_checks.nodes(seeing(*(node("robot", "a", str(each)) for each in range(3)), *ends)).level == OK


def test_simulated_time_needs_one_source() -> None:
    one, two, user = end(PUBLISHER, "/clock"), end(PUBLISHER, "/clock", "bag"), end(SUBSCRIPTION, "/clock", "robot")
    assert only(graph_checks.clock(seeing(one, two)).errors).startswith("2 publishers on /clock (/bag and /talker)")
    assert only(graph_checks.clock(seeing(user)).warnings) == "nobody publishes /clock: the time of /robot stands still"
    assert graph_checks.clock(seeing(one, user)) == Verdict("/clock is published by /talker")


def test_a_latched_subscription_of_a_volatile_publisher_is_a_warning() -> None:
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    asking = end(SUBSCRIPTION, "/map", "planner", qos=latched)
    assert only(graph_checks.qos(seeing(end(PUBLISHER, "/map"), asking)).warnings).startswith("/map: /planner asks")
    assert graph_checks.qos(seeing(end(PUBLISHER, "/map", qos=latched), asking)).level == OK
    assert graph_checks.qos(seeing(end(PUBLISHER, "/map", qos=latched), end(SUBSCRIPTION, "/map"))).level == OK


def test_malformed_announcements_are_shown_in_part_and_counted() -> None:
    found = graph_checks.announcements(
        seeing(malformed=tuple(f"@ros2_lv/\x1b[2J{each}" + "x" * 9000 for each in range(50)))
    )
    assert found.level == WARNING
    assert found.findings[-1] == "and 42 more"
    assert all(each.isprintable() and len(each) < 500 for each in found.findings)


def test_a_system_that_cannot_be_looked_at_is_an_error() -> None:
    assert "no network" in only(graph_checks.announcements(Facts(seen=Seen(error="no network"))).errors)


def test_a_big_system_is_judged_in_no_time() -> None:
    ends = [end(kind, f"/t{each % 50}", f"n{each}") for kind in EndpointKind for each in range(1000)]
    begin = time.perf_counter()
    for check in graph_checks.GRAPH_CHECKS:
        check.decide(seeing(*ends))
    assert time.perf_counter() - begin < 10.0  # 0.1 s; each end with each other takes a minute


@given(st.lists(st.text(max_size=3)))
def test_names_are_listed_in_words(names: list[str]) -> None:
    said = listed(names, most=2)
    assert ("more" in said) == (len(set(names)) > 2) or any("more" in each for each in names)


def test_one_node_of_each_process_is_asked() -> None:
    ends = [
        end(SERVICE, "/a/get_type_description", "a", "type_description_interfaces/srv/GetTypeDescription", session="a"),
        end(SERVICE, "/a/get_parameters", "a", "rcl_interfaces/srv/GetParameters", session="a"),
        end(SERVICE, "/b/get_type_description", "b", "type_description_interfaces/srv/GetTypeDescription", session="b"),
        end(SERVICE, "/c/reset", "c", "std_srvs/srv/Empty", session="c"),
        end(CLIENT, "/d/get_parameters", "d", "rcl_interfaces/srv/GetParameters", session="d"),
    ]
    assert sorted(each.name for each in look.one_server_of_each(ends)) == [
        "/a/get_parameters",
        "/b/get_type_description",
    ]
