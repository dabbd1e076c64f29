"""What the checks of robolink doctor conclude from the graph."""

from __future__ import annotations

import time
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from robolink.cli.doctor import graph_checks, look
from robolink.cli.doctor.facts import OK, WARNING, Facts, Seen, Verdict, listed
from robolink.qos import DurabilityPolicy, QoSProfile
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


def test_stop_that_holds_is_a_warning_with_the_way_to_release_it() -> None:
    assert graph_checks.stop(seeing()) == Verdict("STOP does not hold")
    (found,) = graph_checks.stop(seeing(stopped=True)).warnings
    assert "robolink topic pub --once /e_stop Bool 'data: false'" in found


def test_who_obeys_stop_waits_for_nobody_and_hears_volatile_publishers_too() -> None:
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    ends = [end(SUBSCRIPTION, "/e_stop", "base", qos=each) for each in (latched, PLAIN)]
    assert graph_checks.topics(seeing(*ends)).level == OK
    assert graph_checks.qos(seeing(*ends, end(PUBLISHER, "/e_stop", "button"))).level == OK


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
