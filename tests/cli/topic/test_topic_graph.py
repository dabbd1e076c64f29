"""topic list -v, info, type and find: what is announced, in ros2's words and as JSON."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Iterator
from typing import Any

import pytest

from robolink import Node
from robolink.cli.main import _parsed, main
from robolink.cli.shared import complete
from robolink.cli.topic import options as topic_options
from robolink.control.stop_lock import QOS as STOP
from robolink.control.stop_lock import StopLock
from robolink.duration import Duration
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_msgs.msg import Bool, Int32, String
from robolink.message import type_hash
from robolink.qos import HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy
from robolink.wire import BridgeToken, EndpointKind, format_bridge, format_token, gid_of
from tests.support.seen_by_commands import LATCHED, a_node_that_commands_see, made, spinning
from tests.support.waits import wait_until

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        robot.create_publisher(Twist, "/cmd_vel", LATCHED)
        robot.create_subscription(Twist, "/cmd_vel", print, 10)
        robot.create_publisher(String, "/both", 10)
        robot.create_publisher(Int32, "/both", 10)
        robot.create_subscription(Int32, "/_quiet", print, 10)
        yield robot


def test_a_plain_list_is_what_the_parser_makes_of_it(node: Node, capsys: Captured) -> None:
    assert main(["topic", "list"]) == 0
    short = capsys.readouterr().out
    assert short.splitlines() == ["/both", "/cmd_vel", "/parameter_events"]
    assert _parsed(["topic", "list"]) == 0
    assert capsys.readouterr().out == short


def test_a_list_in_full_has_two_sections(node: Node, capsys: Captured) -> None:
    assert main(["topic", "list", "-v"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "Published topics:",
        " * /both [std_msgs/msg/Int32, std_msgs/msg/String] 2 publishers",
        " * /cmd_vel [geometry_msgs/msg/Twist] 1 publisher",
        " * /parameter_events [rcl_interfaces/msg/ParameterEvent] 1 publisher",
        "",
        "Subscribed topics:",
        " * /cmd_vel [geometry_msgs/msg/Twist] 1 subscriber",
        "",
    ]


def test_a_list_in_full_says_that_stop_holds_and_how_to_release_it(node: Node, capsys: Captured) -> None:
    holder = node.create_publisher(Bool, "/e_stop", STOP)
    for held in (True, False, True):
        holder.publish(Bool(data=held))
        main(["topic", "list", "-v"])
        told = capsys.readouterr().err
        assert ("STOP holds (/e_stop)" in told) is held
    (release,) = re.findall(r"robolink (topic pub .*) releases it", told)
    lock = StopLock(node, lambda _: None)
    with spinning(node):
        wait_until(lambda: lock.held)
        assert main(shlex.split(release)) == 0
        wait_until(lambda: not lock.held)
    holder.destroy()
    main(["topic", "list", "-v", "--json"])
    assert not capsys.readouterr().err


def test_of_several_who_keep_stop_the_last_counts_and_nonsense_does_not(node: Node, capsys: Captured) -> None:
    one, other, third = (node.create_publisher(Bool, "/e_stop", STOP) for _ in range(3))
    other.publish(Bool(data=False))
    third.publish(b"nonsense")
    one.publish(Bool(data=True))
    main(["topic", "list", "-v"])
    assert "STOP holds" in capsys.readouterr().err
    other.publish(Bool(data=False))
    main(["topic", "list", "-v"])
    assert "STOP holds" not in capsys.readouterr().err


def test_programs_get_numbers_too(node: Node, capsys: Captured) -> None:
    assert main(["topic", "list", "-v", "--json", "--include-hidden-topics"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert listed["/both"] == {
        "types": ["std_msgs/msg/Int32", "std_msgs/msg/String"],
        "publishers": 2,
        "subscriptions": 0,
    }
    assert listed["/_quiet"] == {"types": ["std_msgs/msg/Int32"], "publishers": 0, "subscriptions": 1}
    assert main(["topic", "list", "--json", "-c"]) == 0
    assert json.loads(capsys.readouterr().out) == 3


@pytest.mark.parametrize("name", ["/cmd_vel", "cmd_vel"])
def test_info_says_the_type_and_two_numbers(node: Node, name: str, capsys: Captured) -> None:
    assert main(["topic", "info", name]) == 0
    assert capsys.readouterr() == ("Type: geometry_msgs/msg/Twist\nPublisher count: 1\nSubscription count: 1\n", "")


def test_info_lists_several_types_as_ros2_does(node: Node, capsys: Captured) -> None:
    assert main(["topic", "info", "/both"]) == 0
    assert capsys.readouterr().out.splitlines()[0] == "Type: ['std_msgs/msg/Int32', 'std_msgs/msg/String']"


def test_info_in_full_shows_each_end_as_ros2_does(node: Node, capsys: Captured) -> None:
    assert main(["topic", "info", "/cmd_vel", "--verbose"]) == 0
    own = node.context.graph.endpoints(EndpointKind.PUBLISHER, name="/cmd_vel")[0]
    gid = gid_of(format_token(own)).hex(".")
    shown = capsys.readouterr().out
    assert shown.startswith(
        "Type: geometry_msgs/msg/Twist\n\nPublisher count: 1\n\n"
        "Node name: robot\nNode namespace: /lab\nTopic type: geometry_msgs/msg/Twist\n"
        f"Topic type hash: {type_hash(Twist)}\nEndpoint type: PUBLISHER\nGID: {gid}\nQoS profile:\n"
        "  Reliability: RELIABLE\n  History (Depth): KEEP_LAST (5)\n  Durability: TRANSIENT_LOCAL\n"
        "  Lifespan: Infinite\n  Deadline: Infinite\n  Liveliness: AUTOMATIC\n"
        "  Liveliness lease duration: Infinite\n\nSubscription count: 1\n\nNode name: robot\n"
    )
    assert shown.endswith("  Liveliness lease duration: Infinite\n\n")
    assert len(gid.split(".")) == 16


def test_info_shows_every_policy(node: Node, capsys: Captured) -> None:
    special = QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        deadline=Duration(seconds=1.5),
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
    )
    node.create_publisher(Int32, "/special", special)
    assert main(["topic", "info", "/special", "-v"]) == 0
    shown = capsys.readouterr().out
    assert "  Reliability: BEST_EFFORT\n  History (Depth): KEEP_ALL\n" in shown
    assert "  Deadline: 1500000000 nanoseconds\n  Liveliness: MANUAL_BY_TOPIC\n" in shown
    assert main(["topic", "info", "/special", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["publisher_count"], found["subscription_count"], found["subscriptions"]) == (1, 0, [])
    publisher = found["publishers"][0]
    assert publisher["node_name"] == "robot"
    assert publisher["topic_type_hash"] == type_hash(Int32)
    assert publisher["qos_profile"]["deadline"] == 1.5
    assert publisher["qos_profile"]["lifespan"] is None
    assert publisher["qos_profile"]["history"] == "KEEP_ALL"


def test_info_says_which_end_is_behind_a_bridge(node: Node, capsys: Captured) -> None:
    transport = node.context.transport
    own = node.context.graph.endpoints(EndpointKind.PUBLISHER, name="/cmd_vel")[0]
    transport.announce(format_token(own._replace(session="b1", node_name="base")))
    transport.announce(format_bridge(BridgeToken(7, "b1", "dds", "turtle.local")))
    transport.announce("robolink_bridge/7/nonsense")
    assert main(["topic", "info", "/cmd_vel", "-v"]) == 0
    ends = capsys.readouterr().out.split("Node name: ")[1:]
    line = "Network: DDS, through the bridge on turtle.local"
    assert [(each.splitlines()[0], line in each.splitlines()) for each in ends] == [
        ("base", True),
        ("robot", False),
        ("robot", False),
    ]
    assert main(["topic", "info", "/cmd_vel", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["publishers"]
    assert [each.get("bridge") for each in found] == [{"network": "dds", "host": "turtle.local"}, None]


def test_the_gid_is_that_of_the_announcement_as_it_was_written(node: Node, capsys: Captured) -> None:
    own = node.context.graph.endpoints(EndpointKind.PUBLISHER, name="/cmd_vel")[0]
    spelled = format_token(own._replace(name="/odd", endpoint_id="99")).rpartition("/")[0] + "/1:2:1,10:,:,:,,"
    node.context.transport.announce(spelled)
    assert main(["topic", "info", "/odd", "-v"]) == 0
    assert f"GID: {gid_of(spelled).hex('.')}\n" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("name", "shown"),
    [("/cmd_vel", "geometry_msgs/msg/Twist\n"), ("both", "std_msgs/msg/Int32\nstd_msgs/msg/String\n")],
)
def test_type_says_the_types(node: Node, name: str, shown: str, capsys: Captured) -> None:
    assert main(["topic", "type", name]) == 0
    assert capsys.readouterr() == (shown, "")
    assert main(["topic", "type", name, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == shown.splitlines()


@pytest.mark.parametrize("verb", ["info", "type"])
@pytest.mark.parametrize(
    ("name", "report"),
    [
        ("/cmd_vell", "no topic named '/cmd_vell' in domain 7 (did you mean '/cmd_vel'?)"),
        ("/a b", "invalid topic name '/a b': must not contain characters other than"),
        ("//x", "invalid topic name '//x': must not contain '//'"),
        ("", "invalid topic name '/': must not end with '/'"),
        ("/" + "x" * 1_000_000, "invalid topic name '/xxxx"),
        ("/x\n\x1b[2J", "invalid topic name "),
    ],
)
def test_an_unknown_topic_is_one_line_and_1(node: Node, verb: str, name: str, report: str, capsys: Captured) -> None:
    assert main(["topic", verb, name]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"robolink: {report}")
    assert err.count("\n") == 1
    assert len(err) < 1000


@pytest.mark.parametrize(
    "type_", ["Twist", "geometry_msgs/Twist", "geometry_msgs/msg/Twist", "geometry_msgs.msg.Twist"]
)
def test_find_lists_the_topics_of_a_type(node: Node, type_: str, capsys: Captured) -> None:
    made(node.context, "other").create_publisher(Twist, "/a/cmd_vel", 10)
    assert main(["topic", "find", type_]) == 0
    assert capsys.readouterr() == ("/a/cmd_vel\n/cmd_vel\n", "")


@pytest.mark.parametrize(
    ("args", "shown"),
    [
        (["Int32"], "/both\n"),
        (["Int32", "--include-hidden-topics"], "/_quiet\n/both\n"),
        (["Int32", "-c"], "1\n"),
        (["Int32", "--json"], '["/both"]\n'),
        (["Image", "-c"], "0\n"),
        (["Image", "--json"], "[]\n"),
    ],
)
def test_find_counts_and_leaves_out_what_is_hidden(node: Node, args: list[str], shown: str, capsys: Captured) -> None:
    assert main(["topic", "find", *args]) == 0
    assert capsys.readouterr() == (shown, "")


def test_find_of_a_type_that_no_topic_has_says_what_is_near(node: Node, capsys: Captured) -> None:
    assert main(["topic", "find", "Twst"]) == 0
    assert capsys.readouterr() == ("", "no topic is of type Twst (did you mean 'Twist'?)\n")
    assert main(["topic", "find", "a b"]) == 1
    assert capsys.readouterr().err.startswith("robolink: 'a b' is not a type name; it should look like Twist")


def test_what_cannot_be_read_hides_nothing_else(node: Node, capsys: Captured) -> None:
    node.context.transport.announce("@ros2_lv/7/zz/nonsense")
    for args in (["list"], ["info", "/cmd_vel"], ["type", "/cmd_vel"], ["find", "Twist"]):
        assert main(["topic", *args]) == 0
        assert "cmd_vel" in capsys.readouterr().out or args[0] in ("info", "type")


@pytest.mark.parametrize(
    ("argument", "completes"),
    [
        (topic_options.Topic, complete.topic_names),
        (topic_options.TopicsOrAll, complete.topic_names),
        (topic_options.Type, complete.message_types),
        (topic_options.TypeOfTopic, complete.type_of_topic),
        (topic_options.TypeOrValues, complete.type_of_topic),
    ],
)
def test_the_shell_completes_live_names(argument: Any, completes: Any) -> None:
    assert argument.__metadata__[0].autocompletion is completes


def test_what_subscriptions_have_lost_is_shown(node: Node, capsys: Captured) -> None:
    publisher = node.create_publisher(Int32, "/count", 10)
    subscription = node.create_subscription(Int32, "/count", lambda message: None, 2)
    for number in range(5):
        publisher.publish(Int32(data=number))
    with spinning(node):
        wait_until(lambda: node.count_publishers("/diagnostics") == 1)
        wait_until(lambda: "Messages lost" in _info(capsys))
    assert _info(capsys).count("Messages lost: 0 on the way, 3 dropped for newer ones") == 1
    assert main(["topic", "info", "/count", "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["subscriptions"][0]["messages_lost"] == {"dropped": 3, "lost": 0}
    assert shown["subscriptions"][0]["gid"] == subscription.gid.hex(".")
    assert "messages_lost" not in shown["publishers"][0]


def _info(capsys: Captured) -> str:
    assert main(["topic", "info", "-v", "/count"]) == 0
    return capsys.readouterr().out
