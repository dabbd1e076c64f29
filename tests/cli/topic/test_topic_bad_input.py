"""Mistakes in topic and node commands: each is one line on stderr that says what, where and what is near."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node, RobolinkError
from robolink.cli.main import main
from robolink.cli.topic.pub import Stamped
from robolink.documents.yamlfile import parse
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from tests.support.seen_by_commands import a_node_that_commands_see, latch

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


BAD: list[tuple[str, list[str], str]] = [
    ("type", ["pub", "/x", "Twst"], "no message type named 'Twst' (did you mean 'Twist'?)"),
    ("package", ["pub", "/x", "geometry_mgs/Twist"], "no interface package named 'geometry_mgs' (did you mean 'geome"),
    (
        "in package",
        ["pub", "/x", "geometry_msgs/Twis"],
        "no message type named 'Twis' in geometry_msgs (did you mean 'T",
    ),
    ("no type", ["pub", "/x", "a b"], "'a b' is not a type name; it should look like Twist, geometry_msgs/Twist or"),
    ("echo type", ["topic", "echo", "/x", "Odometri"], "no message type named 'Odometri' (did you mean 'Odometry'?)"),
    (
        "field",
        ["pub", "/x", "Twist", "{liner: {x: 1}}"],
        "Twist: no field 'liner' (did you mean 'linear'?); it has lin",
    ),
    ("deep field", ["pub", "/x", "Twist", "{linear: {w: 1}}"], "Twist.linear: no field 'w'; it has x, y, z"),
    ("value", ["pub", "/x", "Twist", "{linear: {x: fast}}"], "Twist.linear.x: expected float64, got 'fast'"),
    ("range", ["pub", "/x", "Int32", "data: 3000000000"], "Int32.data: expected int32, got 3000000000"),
    ("no mapping", ["pub", "/x", "Twist", "{linear: 3}"], "Twist.linear: expected a mapping of x, y, z, got 3"),
    ("scalar", ["pub", "/x", "Twist", "3"], "Twist: expected a mapping of linear, angular, got 3"),
    (
        "length",
        ["pub", "/x", "Imu", "{angular_velocity_covariance: [1, 2]}"],
        "Imu.angular_velocity_covariance: expected",
    ),
    ("yaml", ["pub", "/x", "Twist", "{linear: {x: 1}"], "<values>:1:16: expected ',' or '}', but got the end of the"),
    ("yaml line", ["pub", "/x", "Twist", "linear:\n\tx: 1"], "<values>:2:1: a tab where only spaces may stand"),
    ("key twice", ["pub", "/x", "Twist", "{linear: {}, linear: {}}"], "<values>:1:14: "),
    ("rate 0", ["pub", "/x", "Twist", "-r", "0"], "--rate: expected a number of Hz above 0, got 0"),
    ("rate -1", ["pub", "/x", "Twist", "-r", "-1"], "--rate: expected a number of Hz above 0, got -1"),
    ("rate nan", ["pub", "/x", "Twist", "-r", "nan"], "--rate: expected a number of Hz above 0, got nan"),
    ("rate inf", ["pub", "/x", "Twist", "-r", "inf"], "--rate: expected a number of Hz above 0, got inf"),
    ("tiny rate", ["pub", "/x", "Twist", "-r", "1e-320"], "--rate: expected a number of Hz above 0, got 9.99989e-321"),
    ("echo field", ["topic", "echo", "/v", "--field", "linear.w"], "--field linear.w: no field 'w'; there is x, y, z"),
    (
        "echo path",
        ["topic", "echo", "/v", "--field", "linear..x"],
        "--field: expected a path such as linear.x or range",
    ),
    ("element", ["topic", "echo", "/s", "--field", "ranges[9]"], "--field ranges[9]: there are 2 elements, no [9]"),
    ("no type yet", ["pub", "/x"], "nobody uses /x yet, so say its type: TOPIC TYPE VALUES"),
    ("near topic", ["pub", "/vv", "{}"], "nobody uses /vv yet (did you mean '/v'?), so say its type"),
    ("wait", ["pub", "/x", "Twist", "--max-wait-time-secs", "3"], "--max-wait-time-secs only says something with"),
    ("filter", ["topic", "echo", "/v", "--filter", "m.liner"], "--filter: column 1: no field 'liner' (did you mean"),
    ("filter of a field", ["topic", "echo", "/v", "--field", "linear", "--filter", "m.linear"], "--filter: column 1"),
    ("filter of hz", ["topic", "hz", "/v", "--filter", "lne(m) > 3"], "--filter: column 1: no name 'lne'"),
    ("no header", ["topic", "delay", "/v"], "topic delay needs a std_msgs/msg/Header named header; geometry_msgs/msg"),
    ("node name", ["topic", "echo", "/v", "-n", "a b"], "invalid node name 'a b'"),
]


@pytest.mark.parametrize(("args", "report"), [each[1:] for each in BAD], ids=[each[0] for each in BAD])
def test_bad_input_is_one_line_and_1(node: Node, args: list[str], report: str, capsys: Captured) -> None:
    latch(node, "/v", Twist())
    latch(node, "/s", LaserScan(ranges=[1.0, 2.0]))
    assert main(args) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"robolink: {report}")
    assert err.count("\n") == 1


@pytest.mark.usefixtures("node")
@pytest.mark.parametrize("args", [["pub", "{}", "Twist"], ["topic", "echo", "{}"], ["topic", "echo", "{}", "Twist"]])
@pytest.mark.parametrize(
    ("name", "report"),
    [
        ("/a b", "must not contain characters other than a-z, A-Z, digits, '_', '/', '~', '{' and '}' (at index 2)"),
        ("//x", "must not contain '//' (at index 1)"),
        ("/x/", "must not end with '/' (at index 2)"),
        ("/1x", "must not start with a number in any of its tokens (at index 1)"),
        ("", "must not be empty (at index 0)"),
    ],
)
def test_a_bad_topic_name_is_one_line_and_1(args: list[str], name: str, report: str, capsys: Captured) -> None:
    assert main([name if each == "{}" else each for each in args]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err == f"robolink: invalid topic name '{name}': {report}\n"


@pytest.mark.parametrize("args", [["topic", "list"], ["node", "list"], ["topic", "echo", "/x"], ["pub", "/x", "Twist"]])
@pytest.mark.parametrize(
    ("variable", "value", "report"),
    [
        ("ROS_DOMAIN_ID", "abc", "ROS_DOMAIN_ID: expected a number from 0 to 232, got 'abc'"),
        ("ROS_DOMAIN_ID", "300", "domain id: expected a number from 0 to 232, got 300"),
        ("ROBOLINK_TRANSPORT", "zeno://", "no transport 'zeno://' (did you mean 'zenoh'?)"),
    ],
)
def test_a_bad_environment_is_one_line_and_1(
    args: list[str], variable: str, value: str, report: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setenv(variable, value)
    assert main(args) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"robolink: {report}")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("args", "report"),
    [
        (["topic", "ecko"], "no command named 'topic ecko' (did you mean 'echo'?)"),
        (["node", "lst"], "no command named 'node lst' (did you mean 'list'?)"),
        (["topic", "list", "--show-type"], "No such option: --show-type"),
        (["node", "list", "--jsn"], "No such option: --jsn"),
        (["topic", "list", "extra"], "Got unexpected extra argument"),
        (["topic", "pub"], "Missing argument 'TOPIC'"),
        (["topic", "hz"], "Missing argument 'TOPIC'"),
        (["topic", "hz", "/x", "-w", "0"], "Invalid value for '--window' / '-w': 0 is not in the range"),
        (["topic", "bw", "/x", "-w", "1"], "Invalid value for '--window' / '-w': 1 is not in the range"),
        (
            ["topic", "echo", "/x", "--timeout", "nan"],
            "Invalid value for '--timeout': expected 0 to 1e+09 second",
        ),
        (
            ["topic", "echo", "/x", "--timeout", "-1"],
            "Invalid value for '--timeout': expected 0 to 1e+09 second",
        ),
        (
            ["pub", "/x", "Twist", "--keep-alive", "inf"],
            "Invalid value for '--keep-alive': expected 0 to 1e+09 sec",
        ),
        (["topic", "echo", "/x", "--csv", "--json"], "--csv and --json do not go together"),
        (["topic", "echo", "/x", "--raw", "--field", "a"], "--raw and --field or --filter do not go together"),
        (["topic", "echo", "/x", "-l", "-1"], "Invalid value for '--truncate-length' / '-l': -1 is not in the range"),
        (["pub", "/x", "Twist", "{}", "--stdin"], "--stdin and VALUES do not go together"),
        (["pub", "/x", "Twist", "--stdin", "--yaml-file", "a"], "--stdin and --yaml-file do not go together"),
        (["topic", "bw", "/x", "--all"], "TOPIC and --all do not go together"),
        (["pub", "/x", "Twist", "-1", "-t", "2"], "--once and --times do not go together"),
        (
            ["pub", "/x", "Twist", "--qos-reliability", "relable"],
            "Invalid value for '--qos-reliability': 'relable' is no",
        ),
        (["topic", "echo", "/x", "--qos-depth", "9" * 30], "Invalid value for '--qos-depth': 999"),
        (["topic", "echo", "/x", "--qos-depth", "-1"], "Invalid value for '--qos-depth': -1 is not in the range"),
        (["pub", "/x", "Twist", "--times", "-3"], "Invalid value for '--times' / '-t': -3 is not in the range x>=0"),
        (["pub", "/x", "Twist", "-t", "two"], "Invalid value for '--times' / '-t': 'two' is not a valid int"),
        (["pub", "/x", "Twist", "-r", "fast"], "Invalid value for '--rate' / '-r': 'fast' is not a valid float"),
        (["pub", "/x", "Twist", "-p", "-1"], "Invalid value for '--print' / '-p': -1 is not in the range x>=0"),
        (["topic", "echo", "/x", "--field"], "Option '--field' requires an argument"),
    ],
)
def test_wrong_usage_is_one_line_and_2(args: list[str], report: str, capsys: Captured) -> None:
    assert main(args) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"robolink: {report}")
    assert err.count("\n") == 1


@given(st.text(max_size=40) | st.text("{}[]:, linearxyz0123.", max_size=20))
def test_any_values_are_a_message_or_refused_in_one_line(values: str) -> None:
    try:
        report = f"<values>: {Stamped(Twist, parse(values, name='<values>')).message}"
    except RobolinkError as error:
        report = str(error)
    assert report.startswith(("<values>:", "Twist"))
    assert "\n" not in report
