"""How commands show messages: YAML that ros2 would print, JSON that reads back, and fields by their path."""

from __future__ import annotations

import json
import math
from array import array
from typing import Any

import pytest
import yaml
from hypothesis import example, given
from hypothesis import strategies as st

from robolink.cli.shared.messages import Style, as_csv, as_json, as_yaml, check_path, field_of
from robolink.exceptions import EncodeError
from robolink.interfaces.geometry_msgs.msg import Pose, PoseArray, PoseWithCovariance, Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan
from robolink.interfaces.std_msgs.msg import Byte, ByteMultiArray, Empty, Header, String
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.message import to_builtins

POSE = "{position: {x: 0.0, y: 0.0, z: 0.0}, orientation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}}"
TWIST = Twist(linear=Vector3(x=0.3), angular=Vector3(z=-1.5))


def scan(*ranges: float) -> LaserScan:
    return LaserScan(header=Header(frame_id="laser"), ranges=array("f", ranges))


# --- YAML -----------------------------------------------------------------------------------------------------


def test_a_message_is_block_yaml_in_the_order_of_its_fields() -> None:
    assert as_yaml(TWIST) == "linear:\n  x: 0.3\n  y: 0.0\n  z: 0.0\nangular:\n  x: 0.0\n  y: 0.0\n  z: -1.5"


def test_a_long_sequence_and_a_long_text_are_cut_unless_wanted_whole() -> None:
    long = scan(*range(200))
    shown = yaml.safe_load(as_yaml(long))["ranges"]
    assert shown == [*map(float, range(128)), "..."]
    assert len(yaml.safe_load(as_yaml(long, Style(longest=None)))["ranges"]) == 200
    assert as_yaml(String(data="x" * 129)) == f"data: {'x' * 128}..."
    assert as_yaml(String(data="x" * 128)) == f"data: {'x' * 128}"


def test_scalars_texts_and_what_is_empty() -> None:
    assert [as_yaml(each) for each in (0.5, 3, True, "hello", "", "a b")] == ["0.5", "3", "true", "hello", "''", "a b"]
    assert as_yaml(Empty()) == "{}"
    assert as_yaml(scan().ranges) == "[]"
    assert as_yaml(math.inf) == ".inf"
    assert [as_yaml(Byte(data=each)) for each in (b"2", b"\0", b"\xff")] == ["data: '2'", 'data: "\\0"', "data: ÿ"]
    assert as_yaml(Byte(data=b"a").data) == "a"


@given(st.text(), st.lists(st.floats(width=32, allow_nan=False)), st.floats(allow_nan=False))
@example("\x85", [], 0.0)
@example("a\u2028b\u2029", [], 0.0)
def test_yaml_reads_back_as_what_was_sent(frame: str, ranges: list[float], angle: float) -> None:
    message = LaserScan(header=Header(frame_id=frame), ranges=array("f", ranges), angle_min=angle)
    assert yaml.safe_load(as_yaml(message, Style(longest=None))) == to_builtins(message)


@pytest.mark.parametrize(
    ("value", "style", "shown"),
    [
        (TWIST.linear, Style(flow=True), "x: 0.3\ny: 0.0\nz: 0.0"),
        (scan(1.0, 2.0).ranges, Style(flow=True), "[1.0, 2.0]"),
        (PoseArray(poses=[Pose()]).poses, Style(flow=True), f"[{POSE}]"),
        (scan(1.0, 2.0).ranges, Style(longest=1), "- 1.0\n- '...'"),
        (String(data="hello"), Style(longest=2), "data: he..."),
        (String(data="hello"), Style(longest=0), "data: '...'"),
        (String(data="hello"), Style(strings=False), "data: '<string length: <5>>'"),
        (
            TFMessage(),
            Style(arrays=False),
            "transforms: '<sequence type: geometry_msgs/msg/TransformStamped, length: 0>'",
        ),
        (Image(data=bytes(70_000)).data, Style(longest=2), "- 0\n- 0\n- '...'"),
        (ByteMultiArray(data=[b"\x01", b"\x02"]).data, Style(), '- "\\x01"\n- "\\x02"'),
    ],
)
def test_how_much_is_shown_is_up_to_the_style(value: Any, style: Style, shown: str) -> None:
    assert as_yaml(value, style) == shown


def test_sequences_are_described_with_ros2s_words() -> None:
    described = yaml.safe_load(as_yaml(scan(1.0, 2.0), Style(arrays=False)))
    assert described["ranges"] == "<sequence type: float, length: 2>"
    assert (
        yaml.safe_load(as_yaml(PoseWithCovariance(), Style(arrays=False)))["covariance"] == "<array type: double[36]>"
    )


# --- values between commas ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "style", "shown"),
    [
        (TWIST, Style(), "0.3,0.0,0.0,0.0,0.0,-1.5"),
        (scan(1.0, 2.0), Style(), "0,0,laser,0.0,0.0,0.0,0.0,0.0,0.0,0.0,1.0,2.0,"),
        (scan(1.0, 2.0, 4.0).ranges, Style(longest=2), "1.0,2.0,..."),
        (String(data="a,b"), Style(), "a,b"),
        (String(data="a,b"), Style(strings=False), "<string length: <3>>"),
        (
            scan(1.0),
            Style(arrays=False),
            "0,0,laser,0.0,0.0,0.0,0.0,0.0,0.0,0.0,<sequence type: float, length: 1>,<sequence type: float, length: 0>",
        ),
        (Byte(data=b"\x07"), Style(), r"b'\x07'"),
        (TWIST.linear.x, Style(), "0.3"),
    ],
)
def test_values_stand_between_commas(value: Any, style: Style, shown: str) -> None:
    assert as_csv(value, style) == shown


# --- JSON -----------------------------------------------------------------------------------------------------


def test_json_is_one_line_that_every_reader_takes() -> None:
    shown = as_json(scan(1.5, math.inf, -math.inf, math.nan))
    assert "\n" not in shown
    read = json.loads(shown)
    assert read["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "laser"}
    assert read["ranges"] == [1.5, math.inf, -math.inf, None]


@given(st.text(), st.lists(st.floats(width=32, allow_nan=False)))
def test_json_reads_back_as_what_was_sent(frame: str, ranges: list[float]) -> None:
    message = LaserScan(header=Header(frame_id=frame), ranges=array("f", ranges))
    assert json.loads(as_json(message)) == to_builtins(message)


# --- fields ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("message", "path", "value"),
    [
        (TWIST, "linear.x", 0.3),
        (TWIST, "linear", Vector3(x=0.3)),
        (scan(1.0, 2.0, 3.0), "ranges[1]", 2.0),
        (scan(1.0, 2.0, 3.0), "ranges[-1]", 3.0),
        (scan(1.0), "header.stamp.nanosec", 0),
        (PoseWithCovariance(), "covariance[35]", 0.0),
    ],
)
def test_a_field_is_found_by_its_path(message: Any, path: str, value: Any) -> None:
    assert field_of(message, path) == value


def test_a_field_of_an_element_is_found() -> None:
    message = TFMessage()
    check_path(TFMessage, "transforms[0].child_frame_id")
    with pytest.raises(EncodeError, match=r"--field transforms\[0\]: there are 0 elements, no \[0\]"):
        field_of(message, "transforms[0]")


@pytest.mark.parametrize(
    ("message_class", "path", "report"),
    [
        (Twist, "liner.x", "--field liner.x: no field 'liner' (did you mean 'linear'?); there is linear, angular"),
        (Twist, "linear.w", "--field linear.w: no field 'w'; there is x, y, z"),
        (Twist, "linear.x.y", "--field linear.x.y: no field 'y'; there is nothing in it"),
        (Twist, "linear[0]", "--field linear[0]: what stands before [0] is not a sequence"),
        (LaserScan, "ranges[0][1]", "--field ranges[0][1]: what stands before [1] is not a sequence"),
        (TFMessage, "transforms.header", "no field 'header'; it is a sequence: say which, as in [0]"),
        (Twist, "", "--field: expected a path such as linear.x or ranges[0], got ''"),
        (Twist, "linear..x", "--field: expected a path such as linear.x or ranges[0], got 'linear..x'"),
        (Twist, "linear.", "--field: expected a path such as linear.x or ranges[0], got 'linear.'"),
        (Twist, ".linear", "--field: expected a path such as linear.x or ranges[0], got '.linear'"),
        (LaserScan, "ranges.[0]", "--field: expected a path such as linear.x or ranges[0], got 'ranges.[0]'"),
        (LaserScan, "ranges[0]x", "--field: expected a path such as linear.x or ranges[0], got 'ranges[0]x'"),
        (LaserScan, "ranges[a]", "--field: expected a path such as linear.x or ranges[0], got 'ranges[a]'"),
        (Twist, "__ros_type__", "--field: expected a path such as linear.x or ranges[0], got '__ros_type__'"),
    ],
)
def test_a_wrong_path_is_told_before_any_message_comes(message_class: type[Any], path: str, report: str) -> None:
    with pytest.raises(EncodeError) as caught:
        check_path(message_class, path)
    assert report in str(caught.value)
    with pytest.raises(EncodeError):
        field_of(message_class(), path)


PART = st.sampled_from(["header", "ranges", "stamp", "sec", "frame_id", "[0]", "[-3]", ".", "[", "]", "é", "٣"])


@given(st.lists(PART | st.text(max_size=3)).map("".join))
def test_any_path_gives_a_field_or_one_line(path: str) -> None:
    message = scan(1.0, 2.0)
    try:
        report = f"--field: {field_of(message, path)}"
    except EncodeError as error:
        report = str(error)
    assert report.startswith("--field")
