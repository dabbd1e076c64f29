"""topic echo: how messages are shown, which of them, and what is told when one is lost or none comes."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
import yaml

from robolink import Context, Node
from robolink.cli.main import main
from robolink.cli.shared import graph
from robolink.cli.topic import echo
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan
from robolink.interfaces.std_msgs.msg import Header, Int32, String
from robolink.message import encode
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.wire import EndpointKind, pack_attachment
from tests.support.seen_by_commands import LATCHED, a_node_that_commands_see, latch, made, press_ctrl_c, when_said

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


@pytest.mark.parametrize(
    ("options", "shown"),
    [
        (["--csv"], "0.3,0.0,0.0,0.0,0.0,0.0\n"),
        (["--csv", "--field", "linear"], "0.3,0.0,0.0\n"),
        (["--flow-style", "--field", "linear"], "x: 0.3\ny: 0.0\nz: 0.0\n---\n"),
        (["--clear", "--field", "linear.x"], "\x1b[H\x1b[2J\n0.3\n---\n"),
        (["--raw"], repr(encode(Twist(linear=Vector3(x=0.3)))) + "\n---\n"),
    ],
)
def test_a_message_is_shown_in_many_ways(node: Node, options: list[str], shown: str, capsys: Captured) -> None:
    latch(node, "/cmd_vel", Twist(linear=Vector3(x=0.3)))
    assert main(["topic", "echo", "/cmd_vel", "--once", *options]) == 0
    assert capsys.readouterr() == (shown, "")


def test_sequences_and_texts_may_be_only_described(node: Node, capsys: Captured) -> None:
    latch(node, "/scan", LaserScan(header=Header(frame_id="laser"), ranges=[1.0, 2.0]))
    assert main(["topic", "echo", "/scan", "--once", "--no-arr", "--no-str"]) == 0
    shown = yaml.safe_load(capsys.readouterr().out.removesuffix("---\n"))
    assert shown["ranges"] == "<sequence type: float, length: 2>"
    assert shown["header"]["frame_id"] == "<string length: <5>>"


@pytest.mark.parametrize(
    ("options", "count"), [([], 129), (["-l", "3"], 4), (["--truncate-length", "0"], 1), (["-l", "3", "-f"], 7_000)]
)
def test_what_is_long_is_cut_where_asked(node: Node, options: list[str], count: int, capsys: Captured) -> None:
    latch(node, "/image", Image(data=bytes(7_000)))
    assert main(["topic", "echo", "/image", "--once", "--field", "data", "--flow-style", *options]) == 0
    assert len(yaml.safe_load(capsys.readouterr().out.removesuffix("---\n"))) == count


def test_message_info_comes_first_as_in_ros2(node: Node, capsys: Captured) -> None:
    latch(node, "/count", Int32(data=1), Int32(data=2))
    assert main(["topic", "echo", "/count", "--once", "-i"]) == 0
    info, message = list(yaml.safe_load_all(capsys.readouterr().out.removesuffix("---\n")))
    assert list(info) == sorted(info)
    assert (info["publication_sequence_number"], message) == (1, {"data": 1})
    assert info["received_timestamp"] > info["source_timestamp"] > 0
    assert main(["topic", "echo", "/count", "--once", "-i", "--csv"]) == 0
    source, received, number, reception, value = capsys.readouterr().out.rstrip().split(",")
    assert (number, reception, value) == ("1", "None", "1")
    assert int(received) > int(source)
    assert main(["topic", "echo", "/count", "--once", "-i", "--json"]) == 0
    both = json.loads(capsys.readouterr().out)
    assert (both["message"], both["info"]["publication_sequence_number"]) == ({"data": 1}, 1)


def test_a_filter_lets_only_some_through(node: Node, capsys: Captured) -> None:
    latch(node, "/count", *(Int32(data=number) for number in range(5)))
    assert main(["topic", "echo", "/count", "--once", "--filter", "m.data > 1 and m.data % 2 == 1"]) == 0
    assert capsys.readouterr() == ("data: 3\n---\n", "")
    assert main(["topic", "echo", "/count", "--once", "--field", "data", "--filter", "m >= 4"]) == 0
    assert capsys.readouterr() == ("4\n---\n", "")


def test_a_message_that_a_filter_cannot_tell_of_is_left_out_and_told_once(node: Node, capsys: Captured) -> None:
    latch(node, "/count", Int32(data=0), Int32(data=0), Int32(data=2))
    assert main(["topic", "echo", "/count", "--once", "--filter", "10 / m.data == 5"]) == 0
    out, err = capsys.readouterr()
    assert out == "data: 2\n---\n"
    assert err.startswith("robolink: --filter: ZeroDivisionError: division by zero (a message is left out")
    assert err.count("\n") == 1


@pytest.mark.slow
def test_lost_messages_are_told_unless_not_wanted(node: Node, capsys: Captured) -> None:
    publisher = node.create_publisher(Int32, "/count", LATCHED)
    for number in range(5):
        if number in (1, 2):
            publisher._attachment()  # numbered, and lost on its way
        publisher.publish(Int32(data=number))
    for options, reported in (([], True), (["--no-lost-messages"], False)):
        assert main(["topic", "echo", "/count", "--csv", "--timeout", "1", *options]) == 0
        out, err = capsys.readouterr()
        assert out.split() == ["0", "1", "2", "3", "4"]
        assert ("A message was lost!!!" in err) is reported
        assert ("\ttotal count: 2\n" in err) is reported


def test_a_timeout_ends_it(node: Node, capsys: Captured) -> None:
    node.create_publisher(Int32, "/silent", 10)
    assert main(["topic", "echo", "/silent", "--timeout", "0.02"]) == 1
    assert capsys.readouterr() == ("", "robolink: no message on /silent within 0.02 s\n")
    assert main(["topic", "echo", "/nobody", "--timeout", "0.02"]) == 1
    err = capsys.readouterr().err
    assert err == "robolink: nobody publishes /nobody: its type is not known, and 0.02 s have passed\n"
    latch(node, "/count", Int32(data=1))
    assert main(["topic", "echo", "/count", "--timeout", "0.5"]) == 0
    assert capsys.readouterr() == ("data: 1\n---\n", "")


def test_the_node_may_have_a_name(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    latch(node, "/count", Int32(data=1))
    seen: list[str] = []
    when_said(monkeypatch, echo, "say", lambda _: seen.extend(node.get_node_names()))
    assert main(["topic", "echo", "/count", "--once", "-n", "ear"]) == 0
    assert "ear" in seen


# --- quality of service ---------------------------------------------------------------------------------------


def asked(node: Node, monkeypatch: pytest.MonkeyPatch, *options: str) -> QoSProfile:
    """The profile with which echo subscribes."""
    found: list[QoSProfile] = []

    def look(_: str) -> None:
        ends = node.context.graph.endpoints(EndpointKind.SUBSCRIPTION, name="/x")
        found.extend(each.qos for each in ends)

    with monkeypatch.context() as patch:
        when_said(patch, echo, "say", look)
        assert main(["topic", "echo", "/x", "--once", "--timeout", "30", *options]) == 0
    return found[0]


def test_the_profile_is_that_of_the_publishers(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    best_effort = QoSProfile(
        depth=20, reliability=ReliabilityPolicy.BEST_EFFORT, durability=DurabilityPolicy.TRANSIENT_LOCAL
    )
    node.create_publisher(Int32, "/x", best_effort).publish(Int32())
    found = asked(node, monkeypatch)
    assert found.reliability is ReliabilityPolicy.BEST_EFFORT
    assert (found.durability, found.depth) == (DurabilityPolicy.TRANSIENT_LOCAL, 20)


def test_one_publisher_that_keeps_something_is_enough(node: Node, capsys: Captured) -> None:
    node.create_publisher(String, "/x", 10)
    latch(made(node.context, "other"), "/x", String(data="kept"))
    assert main(["topic", "echo", "/x", "--once", "--csv"]) == 0
    assert capsys.readouterr().out == "kept\n"


def test_flags_ask_for_another_profile(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    latch(node, "/x", Int32())
    durable = ["--qos-durability", "transient_local"]
    found = asked(node, monkeypatch, "--qos-depth", "3", "--qos-reliability", "reliable", *durable)
    assert (found.depth, found.reliability) == (3, ReliabilityPolicy.RELIABLE)
    assert asked(node, monkeypatch, *durable).depth == 5  # of the preset, sensor_data
    assert asked(node, monkeypatch, *durable).reliability is ReliabilityPolicy.BEST_EFFORT


def test_a_huge_depth_on_the_wire_asks_for_no_more_than_can_be() -> None:
    context = Context(transport="memory://huge")
    context.init([])
    with context:
        made(context, "huge").create_publisher(Int32, "/x", QoSProfile(depth=10**15, durability=LATCHED.durability))
        assert graph.matching_qos(context, "/x").depth == graph.DEEPEST


# --- why nothing comes ----------------------------------------------------------------------------------------

SILENT = "waiting: /x is published by /lab/robot, which has sent nothing since this began"


@pytest.mark.parametrize(
    ("published", "options", "reason"),
    [
        (10, [], SILENT),
        (LATCHED, [], "waiting: /x is published by /lab/robot, which has sent nothing yet"),
        (
            LATCHED,
            ["--qos-durability", "volatile"],
            SILENT + "; what it sent before was kept for those who ask for it (durability transient_local)",
        ),
        (
            10,
            ["--qos-durability", "transient_local"],
            SILENT + ", and keeps nothing for late joiners (durability volatile)",
        ),
    ],
)
def test_the_reason_names_the_publisher_and_what_it_keeps(
    node: Node,
    published: QoSProfile | int,
    options: list[str],
    reason: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
) -> None:
    monkeypatch.setattr(echo, "PATIENCE", 0.01)
    publisher = node.create_publisher(Int32, "/x", published)
    if options and published is LATCHED:
        publisher.publish(Int32(data=1))
    when_said(monkeypatch, echo, "tell", press_ctrl_c)
    assert main(["topic", "echo", "/x", *options]) == 130
    assert capsys.readouterr() == ("", f"{reason}\n")


def test_another_definition_of_the_type_is_told(node: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setattr(echo, "PATIENCE", 0.01)
    publisher = node.create_publisher(Int32, "/x", 10)
    own = node.context.graph.endpoints(EndpointKind.PUBLISHER, name="/x")[0]
    reader = node.create_subscription(Int32, "/x", print, 10)
    node.context.graph.announce(own._replace(endpoint_id="99", type_hash="RIHS01_" + "0" * 64))
    node.destroy_publisher(publisher)
    when_said(monkeypatch, echo, "tell", press_ctrl_c)
    monkeypatch.setattr("robolink.cli.topic.echo.message_type", lambda *_: Int32)
    assert main(["topic", "echo", "/x", "Int32"]) == 130
    reported = capsys.readouterr().err.splitlines()[-1]
    assert reported.startswith(
        "nothing will come: /lab/robot has another definition of std_msgs/msg/Int32 (its hash is RIHS"
    )
    node.destroy_subscription(reader)


def test_another_domain_that_can_be_seen_is_named(
    node: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(echo, "PATIENCE", 0.01)
    node.create_publisher(Int32, "/x", 10)
    monkeypatch.setenv("ROS_DOMAIN_ID", "9")
    when_said(monkeypatch, echo, "tell", press_ctrl_c)
    assert main(["topic", "echo", "/x"]) == 130
    reported = (
        "waiting for a publisher of /x: nobody publishes it on domain 9 yet; it is on domain 7: set ROS_DOMAIN_ID=7\n"
    )
    assert capsys.readouterr().err == reported


def test_a_payload_that_is_no_message_ends_nothing(node: Node, capsys: Captured) -> None:
    publisher = node.create_publisher(Int32, "/x", LATCHED)
    publisher.publish(b"")
    publisher.publish(b"\x00\x01\x00\x00\x01")
    outlet = node.context.transport.advertise(publisher._endpoint.key, LATCHED)
    outlet.put(encode(Int32(data=1)), b"no attachment")
    outlet.put(encode(Int32(data=7)), pack_attachment(-(2**63), 0, bytes(16)))
    assert main(["topic", "echo", "/x", "--once", "--csv"]) == 0
    out, err = capsys.readouterr()
    assert out == "7\n"
    assert "Traceback" not in err
