"""The expressions of --filter: what they let through, what is refused at once, and what fails on one message."""

from __future__ import annotations

import warnings
from typing import Any

import pytest

from robolink.cli.topic.arrivals import FilterError, compile_filter
from robolink.interfaces.geometry_msgs.msg import PoseWithCovariance, Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan
from robolink.interfaces.std_msgs.msg import Bool, Byte, Header, Int32, String
from robolink.interfaces.tf2_msgs.msg import TFMessage

TWIST = Twist(linear=Vector3(x=0.3, y=-2.0))
SCAN = LaserScan(header=Header(frame_id="laser"), ranges=[1.0, 2.0, 0.5], range_max=3.0)
POSE = PoseWithCovariance(covariance=[4.0] * 36)


@pytest.mark.parametrize(
    ("message", "text", "passes"),
    [
        (TWIST, "m.linear.x > 0.2", True),
        (TWIST, "m.linear.x > 0.2 and m.linear.y > 0", False),
        (TWIST, "m.linear.x > 1 or not m.linear.y > 0", True),
        (TWIST, "0 < m.linear.x < 1", True),
        (TWIST, "0 < m.linear.x < 0.1", False),
        (TWIST, "abs(m.linear.y) == 2", True),
        (TWIST, "hypot(m.linear.x, m.linear.y) > 2", True),
        (TWIST, "m.linear == m.linear and m.linear != m.angular", True),
        (TWIST, "m.linear.x in (0.3, 0.4)", True),
        (TWIST, "m.linear.x not in [0.3]", False),
        (TWIST, "(1 if m.linear.x else 0) == 1", True),
        (TWIST, "-m.linear.x ** 2 + 7 // 2 % 2 - 1.5 * 2 / 3 < +1", True),
        (TWIST, "m", True),
        (TWIST, "True", True),
        (TWIST, "  m.linear.x > 0\n and m.linear.x < 1 ", True),
        (SCAN, "min(m.ranges) < 0.6 and max(m.ranges) == 2.0", True),
        (SCAN, "min(m.ranges[0:2]) < 0.6", False),
        (SCAN, "m.ranges[-1] == 0.5 and len(m.ranges) == 3", True),
        (SCAN, "sum(m.ranges) == 3.5", True),
        (SCAN, "list(m.ranges) == [1, 2, 0.5]", True),
        (SCAN, "any(each > 1.5 for each in m.ranges)", True),
        (SCAN, "all(isfinite(each) for each in m.ranges[1:])", True),
        (SCAN, "f'{m.header.frame_id}_1' == 'laser_1'", True),
        (SCAN, "sin(pi / 2) == 1 and pow(2, 3) == 8", True),
        (SCAN, "m.ranges", True),
        (SCAN, "m.intensities", False),
        (SCAN, "2 in m.ranges", True),
        (SCAN, "m.header.frame_id == 'laser'", True),
        (SCAN, "'ase' in m.header.frame_id", True),
        (SCAN, "m.header.frame_id.startswith('la') and m.header.frame_id.upper() == 'LASER'", True),
        (SCAN, "m.header.frame_id[0] == 'l'", True),
        (SCAN, "isnan(m.range_max) or isinf(m.range_max)", False),
        (POSE, "m.covariance[35] == 4 and max(m.covariance) == 4 and sum(m.covariance) == 144", True),
        (Int32(data=6), "m.data & 2 and m.data | 1 == 7 and m.data ^ 1 == 7 and ~m.data == -7", True),
        (Int32(data=6), "m.data << 2 == 24 and m.data >> 1 == 3 and round(2.6) == 3", True),
        (Byte(data=b"\x07"), "m.data == b'\\x07'", True),
        (Bool(data=True), "m.data", True),
        (Bool(data=True), "not m.data", False),
        (TFMessage(), "len(m.transforms) > 0 and m.transforms[0].child_frame_id == 'x'", False),
        (Image(data=bytes(100_000)), "len(m.data) == 100000 and m.data[5] == 0", True),
    ],
)
def test_a_filter_lets_through_what_python_would(message: Any, text: str, passes: bool) -> None:
    assert compile_filter(text, type(message))(message) is passes


def test_m_is_a_field_where_one_is_shown() -> None:
    kind = LaserScan.__ros_fields__["ranges"]
    assert compile_filter("len(m) == 3 and m[0] == 1", kind)(SCAN.ranges) is True


@pytest.mark.parametrize(
    ("message_class", "text", "report"),
    [
        (Twist, "", "expected an expression such as 'm.data > 3', got nothing"),
        (Twist, "m.liner.x > 0", "column 1: no field 'liner' (did you mean 'linear'?); geometry_msgs/msg/Twist has"),
        (Twist, "0 < m.linear.w", "column 5: no field 'w'; geometry_msgs/msg/Vector3 has x, y, z"),
        (TFMessage, "m.transforms[0].transfrom", "column 1: no field 'transfrom' (did you mean 'transform'?)"),
        (TFMessage, "m.transforms[1:][0].header.stmp", "column 1: no field 'stmp' (did you mean 'stamp'?)"),
        (Twist, "msg.linear.x > 0", "column 1: no name 'msg'; there is m, the message, and what Python and its module"),
        (Twist, "lenn(m.linear)", "column 1: no name 'lenn' (did you mean 'len'?)"),
        (Twist, "1 < isnann(m.linear.x)", "column 5: no name 'isnann' (did you mean 'isnan'?)"),
        (Twist, "m.linear.x >", "column 13: no Python expression: invalid syntax"),
        (Twist, "m.linear.x = 3", "column"),
        (Twist, "import os", "column 1: no Python expression"),
        (Twist, "await m", "column 1: no Python expression"),
        (String, "'ä' + m.dat", "column 7: no field 'dat' (did you mean 'data'?)"),
        (Twist, "(" * 400 + "1" + ")" * 400, ""),
        (Twist, "m\0", ""),
        (Twist, "'\ud800'", ""),
    ],
)
def test_what_no_message_can_make_right_is_refused_at_once(message_class: type[Any], text: str, report: str) -> None:
    with pytest.raises(FilterError) as caught:
        compile_filter(text, message_class)
    assert str(caught.value).startswith("--filter: " + report)
    assert "\n" not in str(caught.value)


def test_names_that_the_expression_binds_are_known() -> None:
    assert compile_filter("(n := len(m.ranges)) == 3 and sorted(m.ranges, key=lambda x: -x)[0] == n - 1", LaserScan)(
        SCAN
    )
    assert compile_filter("[m.nothing for m in ()] == []", LaserScan)(SCAN)  # another m: not the message


@pytest.mark.parametrize(
    ("message", "text", "report"),
    [
        (TWIST, "1 / m.angular.x > 0", "ZeroDivisionError: "),
        (SCAN, "m.ranges[9] > 0", "IndexError: array index out of range"),
        (SCAN, "m.header.frame_id + 3", "TypeError: "),
        (TWIST, "m.linear < m.angular", "TypeError: '<' not supported between"),
        (SCAN, "min(m.intensities) > 3", "ValueError: "),
        (POSE, "m.covariance == 4", "ValueError: "),
        (SCAN, "sqrt(0 - 1)", "ValueError: "),
        (SCAN, "len(3)", "TypeError: object of type 'int' has no len()"),
        (SCAN, "next(iter(()))", "StopIteration"),
        (SCAN, "{}['a\\nb']", "KeyError: "),
    ],
)
def test_what_fails_on_one_message_is_one_line(message: Any, text: str, report: str) -> None:
    passes = compile_filter(text, type(message))
    with pytest.raises(FilterError) as caught:
        passes(message)
    assert str(caught.value).startswith("--filter: " + report)
    assert "\n" not in str(caught.value)


def test_python_warns_of_nothing() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert compile_filter(r"'\d' != 'd' and m is not 3", Twist)(TWIST) is True
