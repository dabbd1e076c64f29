"""topic list, echo and pub, and node list: ros2's output, and what is said when nothing comes."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from robolink import Node
from robolink.cli.main import main
from robolink.cli.topic import echo, pub
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import Trigger
from tests.support.seen_by_commands import a_node_that_commands_see, latch, made
from tests.support.spins import spin_until

TWIST_YAML = "linear:\n  x: 0.3\n  y: 0.0\n  z: 0.0\nangular:\n  x: 0.0\n  y: 0.0\n  z: 0.0\n---\n"
TWIST_REPR = (
    "geometry_msgs.msg.Twist(linear=geometry_msgs.msg.Vector3(x=0.3, y=0.0, z=0.0), "
    "angular=geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=0.0))"
)
Captured = pytest.CaptureFixture[str]
Hook = Callable[[str], object]


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


@pytest.fixture
def when_said(monkeypatch: pytest.MonkeyPatch) -> Callable[[Any, str, Hook], None]:
    """Do something whenever a command has said something: `when_said(module, "say" or "tell", action)`."""

    def install(module: Any, function: str, action: Hook) -> None:
        original = getattr(module, function)

        def speak(text: str, **options: Any) -> None:
            original(text, **options)
            action(text)

        monkeypatch.setattr(module, function, speak)

    return install


def press_ctrl_c(text: str) -> None:
    raise KeyboardInterrupt


# --- topic list and node list ---------------------------------------------------------------------------------


def busy(node: Node) -> None:
    node.create_publisher(Twist, "/cmd_vel", 10)
    node.create_subscription(Twist, "/cmd_vel", print, 10)
    node.create_subscription(LaserScan, "scan", print, 10)
    node.create_publisher(Int32, "/_quiet", 10)
    node.create_publisher(String, "/both", 10)
    node.create_subscription(Int32, "/both", print, 10)
    node.create_service(Trigger, "reset", lambda request, response: response)


@pytest.mark.parametrize(
    ("options", "shown"),
    [
        ([], "/both\n/cmd_vel\n/lab/scan\n/parameter_events\n"),
        (["--include-hidden-topics"], "/_quiet\n/both\n/cmd_vel\n/lab/scan\n/parameter_events\n"),
        (["-c"], "4\n"),
        (["--count-topics", "--include-hidden-topics"], "5\n"),
    ],
)
def test_topics_are_listed_by_name(node: Node, options: list[str], shown: str, capsys: Captured) -> None:
    busy(node)
    assert main(["topic", "list", *options]) == 0
    assert capsys.readouterr().out == shown


@pytest.mark.parametrize("option", ["-t", "--show-types"])
def test_types_are_shown_as_ros2_shows_them(node: Node, option: str, capsys: Captured) -> None:
    busy(node)
    assert main(["topic", "list", option]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "/both [std_msgs/msg/Int32, std_msgs/msg/String]",
        "/cmd_vel [geometry_msgs/msg/Twist]",
        "/lab/scan [sensor_msgs/msg/LaserScan]",
        "/parameter_events [rcl_interfaces/msg/ParameterEvent]",
    ]


def test_topics_are_given_to_programs_as_json(node: Node, capsys: Captured) -> None:
    busy(node)
    assert main(["topic", "list", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert listed["/both"] == ["std_msgs/msg/Int32", "std_msgs/msg/String"]
    assert list(listed) == ["/both", "/cmd_vel", "/lab/scan", "/parameter_events"]


@pytest.mark.parametrize(
    ("options", "shown"),
    [
        ([], "/alone\n/lab/robot\n"),
        (["-a"], "/_hidden\n/alone\n/lab/robot\n"),
        (["-c"], "2\n"),
        (["--all", "--count-nodes"], "3\n"),
        (["--json"], '["/alone","/lab/robot"]\n'),
    ],
)
def test_nodes_are_listed_by_full_name(node: Node, options: list[str], shown: str, capsys: Captured) -> None:
    _others = [made(node.context, "alone"), made(node.context, "_hidden")]
    assert main(["node", "list", *options]) == 0
    assert capsys.readouterr() == (shown, "")


@pytest.mark.usefixtures("node")
@pytest.mark.parametrize(("noun", "shown"), [("topic", "{}\n"), ("node", "[]\n")])
def test_an_empty_network_is_an_empty_list(
    noun: str, shown: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://nobody")
    assert [main([noun, "list"]), main([noun, "list", "--json"])] == [0, 0]
    assert capsys.readouterr() == (shown, "")


# --- topic echo -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("type_", [[], ["Twist"], ["geometry_msgs/Twist"], ["geometry_msgs/msg/Twist"]])
def test_echo_shows_yaml_and_a_rule_and_finds_the_type_itself(node: Node, type_: list[str], capsys: Captured) -> None:
    latch(node, "/cmd_vel", Twist(linear=Vector3(x=0.3)), Twist())
    assert main(["topic", "echo", "/cmd_vel", *type_, "--once"]) == 0
    assert capsys.readouterr() == (TWIST_YAML, "")


@pytest.mark.parametrize(
    ("options", "shown"),
    [
        (["--field", "linear"], "x: 0.3\ny: 0.0\nz: 0.0\n---\n"),
        (["--field", "linear.x"], "0.3\n---\n"),
        (["--json"], '{"linear":{"x":0.3,"y":0.0,"z":0.0},"angular":{"x":0.0,"y":0.0,"z":0.0}}\n'),
        (["--json", "--field", "linear.x"], "0.3\n"),
    ],
)
def test_echo_shows_a_field_or_json(node: Node, options: list[str], shown: str, capsys: Captured) -> None:
    latch(node, "/cmd_vel", Twist(linear=Vector3(x=0.3)))
    assert main(["topic", "echo", "cmd_vel", "--once", *options]) == 0
    assert capsys.readouterr() == (shown, "")


@pytest.mark.parametrize(("options", "last"), [([], "- '...'"), (["-f"], "- 0.0")])
def test_echo_cuts_what_is_long_unless_it_is_wanted_whole(
    node: Node, options: list[str], last: str, capsys: Captured
) -> None:
    latch(node, "/scan", LaserScan(ranges=[0.0] * 200))
    assert main(["topic", "echo", "/scan", "--once", "--field", "ranges", *options]) == 0
    assert capsys.readouterr().out.splitlines()[-2:] == [last, "---"]


def test_echo_goes_on_until_ctrl_c(node: Node, when_said: Any, capsys: Captured) -> None:
    latch(node, "/count", *(Int32(data=number) for number in range(3)))
    when_said(echo, "say", lambda text: press_ctrl_c(text) if "2" in text else None)
    assert main(["topic", "echo", "/count"]) == 130
    assert capsys.readouterr() == ("data: 0\n---\ndata: 1\n---\ndata: 2\n---\n", "")


def test_echo_says_why_nothing_comes_and_goes_on_waiting(
    node: Node, when_said: Any, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(echo, "PATIENCE", 0.01)
    node.create_publisher(Twist, "/cmd_vell", 10)
    when_said(echo, "tell", lambda text: latch(node, "/cmd_vel", Twist(linear=Vector3(x=0.3))))
    assert main(["topic", "echo", "/cmd_vel", "--once"]) == 0
    said = "waiting for a publisher of /cmd_vel: nobody publishes it on domain 7 yet (did you mean '/cmd_vell'?)\n"
    assert capsys.readouterr() == (TWIST_YAML, said)


@pytest.mark.parametrize(
    ("published", "reason"),
    [
        (None, "waiting for a publisher of /x: nobody publishes it on domain 7 yet"),
        (Twist, "waiting: /x is published by /lab/robot, which has sent nothing since this began"),
        (Int32, "nothing will come: /x is published as std_msgs/msg/Int32, not as geometry_msgs/msg/Twist"),
    ],
)
def test_echo_of_a_type_says_why_nothing_comes(
    node: Node,
    published: type[Any] | None,
    reason: str,
    when_said: Any,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
) -> None:
    monkeypatch.setattr(echo, "PATIENCE", 0.01)
    if published is not None:
        node.create_publisher(published, "/x", 10)
    when_said(echo, "tell", press_ctrl_c)
    assert main(["topic", "echo", "/x", "Twist"]) == 130
    out, err = capsys.readouterr()
    assert (out, err.splitlines()[-1]) == ("", reason)


def test_echo_gives_the_reason_after_a_second() -> None:
    assert echo.PATIENCE == 1.0


# --- pub ------------------------------------------------------------------------------------------------------


def received(node: Node, message_class: type[Any], topic: str) -> list[Any]:
    got: list[Any] = []
    node.create_subscription(message_class, topic, got.append, 1000)
    return got


def taken(node: Node, got: list[Any], count: int) -> list[Any]:
    """Spin until so many have been received."""
    with SingleThreadedExecutor(context=node.context) as executor:
        executor.add_node(node)
        spin_until(executor, lambda: len(got) >= count)
    return got


@pytest.mark.parametrize("command", [["pub"], ["topic", "pub"]])
def test_pub_publishes_once_and_says_so_as_ros2_does(node: Node, command: list[str], capsys: Captured) -> None:
    got = received(node, Twist, "/cmd_vel")
    assert main([*command, "/cmd_vel", "Twist", "{linear: {x: 0.3}}", "-1"]) == 0
    assert taken(node, got, 1) == [Twist(linear=Vector3(x=0.3))]
    assert capsys.readouterr() == (f"publisher: beginning loop\npublishing #1: {TWIST_REPR}\n\n", "")


def test_pub_publishes_so_many_times_at_a_rate(node: Node, capsys: Captured) -> None:
    got = received(node, String, "/chatter")
    assert main(["pub", "/chatter", "String", "data: hi", "-t", "5", "-r", "200", "-p", "2"]) == 0
    assert taken(node, got, 5) == [String(data="hi")] * 5
    lines = [line for line in capsys.readouterr().out.splitlines() if line]
    said = [f"publishing #{number}: std_msgs.msg.String(data='hi')" for number in (2, 4)]
    assert lines == ["publisher: beginning loop", *said]


def test_pub_without_values_publishes_the_defaults(node: Node) -> None:
    got = received(node, Twist, "/cmd_vel")
    assert main(["pub", "/cmd_vel", "geometry_msgs/msg/Twist", "-1"]) == 0
    assert taken(node, got, 1) == [Twist()]


def test_pub_waits_for_its_subscriptions(node: Node, when_said: Any, capsys: Captured) -> None:
    got = received(node, String, "/chatter")
    when_said(pub, "say", lambda text: node.create_subscription(String, "/chatter", print, 1) if "Wait" in text else 0)
    assert main(["pub", "/chatter", "String", "{data: hi}", "-1", "-w", "2"]) == 0
    assert taken(node, got, 1) == [String(data="hi")]
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == ["Waiting for at least 2 matching subscription(s)...", "publisher: beginning loop"]


def test_pub_with_w_0_waits_for_nobody(node: Node, capsys: Captured) -> None:
    assert main(["pub", "/chatter", "String", "-1", "-w", "0"]) == 0
    assert "publishing #1" in capsys.readouterr().out
    assert node.count_subscribers("/chatter") == 0


def test_pub_goes_on_until_ctrl_c(node: Node, when_said: Any, capsys: Captured) -> None:
    got = received(node, String, "/chatter")
    when_said(pub, "say", lambda text: press_ctrl_c(text) if "#3" in text else None)
    assert main(["pub", "/chatter", "String", "-r", "500"]) == 130
    assert taken(node, got, 2) == [String()] * 2
    assert capsys.readouterr().err == ""
