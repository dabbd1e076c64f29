"""The expressions of --filter: what they let through, what they refuse, and that they do nothing else."""

from __future__ import annotations

import builtins
import warnings
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robolink.cli.topic.filter import FilterError, compile_filter
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
        (SCAN, "m.ranges == [1, 2, 0.5]", True),
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
        (Byte(data=b"\x07"), "m.data == 7", True),
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
        (Twist, "m.linear.x.real", "column 1: no field 'real': what stands before it is no message"),
        (LaserScan, "m.ranges.x", "column 1: no field 'x': what stands before it is a sequence"),
        (Twist, "m.__class__", "column 1: no field '__class__'; geometry_msgs/msg/Twist has linear, angular"),
        (Twist, "m.linear[0]", "column 1: what stands before [ is neither a sequence nor a text"),
        (Twist, "msg.linear.x > 0", "column 1: no name 'msg'; there is m, the message, and abs, bool"),
        (Twist, "1 + __import__('os').getpid()", "column 5: no function '__import__('os').getpid'; there is abs"),
        (Twist, "open('x')", "column 1: no function 'open'"),
        (Twist, "lenn(m.linear)", "column 1: no function 'lenn' (did you mean 'len'?)"),
        (Twist, "len > 3", "column 1: len is a function: len(...)"),
        (Twist, "'a'.format(m)", "column 1: no function ''a'.format'"),
        (Twist, "m.linear.lower()", "column 1: .lower() needs a text before it"),
        (Twist, "(lambda: 1)()", "column 2: no function 'lambda: 1'"),
        (Twist, "[x for x in m]", "column 1: a comprehension cannot stand in a filter"),
        (Twist, "f'{m}'", "column 1: an f-string cannot stand in a filter"),
        (Twist, "b'a'", "column 1: expected a number, a text, True or False, got b'a'"),
        (Twist, "1j", "column 1: expected a number, a text, True or False, got 1j"),
        (Twist, "m is None", "column 6: expected a number, a text, True or False, got None"),
        (Twist, "m is m", "column 1: 'is' cannot stand in a filter: use =="),
        (Twist, "1 @ 2", "column 1: 1 @ 2: that operator cannot stand in a filter"),
        (Twist, "@".join(["1"] * 400), "column"),
        (Twist, "m.linear.x >", "column 13: no Python expression: invalid syntax"),
        (Twist, "m.linear.x = 3", "column"),
        (Twist, "import os", "column 1: no Python expression"),
        (Twist, "len(obj=m)", "column 1: a function takes no named arguments in a filter"),
        (Twist, "round(1, 2)", "column 1: round() takes 1 argument in a filter, got 2"),
        (String, "len() > 3", "column 1: len() takes 1 argument in a filter, got 0"),
        (String, "m.data.lower(1)", "column 1: lower() takes 0 arguments in a filter, got 1"),
        (String, "m.data.startswith()", "column 1: startswith() takes 1 argument in a filter, got 0"),
        (String, "'ä' + m.dat", "column 7: no field 'dat' (did you mean 'data'?)"),
        (Twist, "x" * 1001, "an expression has at most 1000 characters, got 1001"),
        (Twist, "-" * 900 + "1", "column"),
        (Twist, "(" * 400 + "1" + ")" * 400, ""),
        (Twist, "m\0", ""),
        (Twist, "'\ud800'", ""),
    ],
)
def test_what_is_no_filter_is_refused_with_its_column(message_class: type[Any], text: str, report: str) -> None:
    with pytest.raises(FilterError) as caught:
        compile_filter(text, message_class)
    assert str(caught.value).startswith("--filter: " + report)


@pytest.mark.parametrize(
    ("message", "text", "report"),
    [
        (TWIST, "1 / m.angular.x > 0", "column 1: float division by zero"),
        (SCAN, "m.ranges[9] > 0", "column 1: there is no such element"),
        (SCAN, "m.header.frame_id * 1000000000", "column 1: expected a number, got a text"),
        (SCAN, "m.header.frame_id + 'x'", "column 1: expected a number, got a text"),
        (SCAN, "'%1000000000d' % 1", "column 1: expected a number, got a text"),
        (SCAN, "m.ranges * 1000000000", "column 1: expected a number, got a sequence"),
        (TWIST, "9 ** 9 ** 9 > 1", "column 1: an integer of more than 4096 bits"),
        (TWIST, "2 ** -10000000000 > 1", "column 1: an integer of more than 4096 bits"),
        (TWIST, "1 << 1000000000", "column 1: an integer of more than 4096 bits"),
        (TWIST, "2 ** 4000 * 2 ** 4000", "column 1: an integer of more than 4096 bits"),
        (TWIST, "(-2) ** 0.5", "column 1: the root of a negative number"),
        (TWIST, "m.linear < m.angular", "column 1: '<' not supported between"),
        (TWIST, "m.linear + 1", "column 1: expected a number, got a geometry_msgs/msg/Vector3"),
        (SCAN, "m.header.frame_id > 3", "column 1: '>' not supported between"),
        (SCAN, "min(m.intensities) > 3", "column 1: "),
        (SCAN, "sqrt(0 - 1)", "column 1: "),
        (SCAN, "len(3)", "column 1: len() of int"),
    ],
)
def test_what_cannot_be_computed_is_one_line(message: Any, text: str, report: str) -> None:
    passes = compile_filter(text, type(message))
    with pytest.raises(FilterError) as caught:
        passes(message)
    assert str(caught.value).startswith("--filter: " + report)
    assert "\n" not in str(caught.value)


def outcome(text: str, message: Any) -> bool | str:
    try:
        return compile_filter(text, type(message))(message)
    except FilterError as error:
        return str(error)


WORDS = (
    "m . m.ranges m.header.frame_id m.range_max [ ] ( ) : , 0 1 9 -1 1e9 ** * + - // / % << >> & | ^ ~ == != < > <= in "
    "not and or if else is len( min( max( sum( abs( int( round( .lower() .startswith( 'x' True None lambda __class__ "
    "__import__ open eval exec print x for yield await := @ \\ # é ٣"
)
WORD = st.sampled_from(WORDS.split())


@given(st.text(max_size=60) | st.lists(WORD, max_size=25).map(" ".join) | st.lists(WORD, max_size=25).map("".join))
@example("9**9**9**9")
@example("m" + ".ranges[0:]" * 30)
@example("m.ranges" + "[m.ranges" * 30 + "]" * 30)
def test_any_text_is_a_filter_or_refused_in_one_line(text: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = outcome(text, SCAN)
    assert isinstance(found, bool) or (found.startswith("--filter: ") and "\n" not in found)


@pytest.mark.parametrize("text", ["__import__('os')", "open('/x','w')", "eval('1')", "exec('1')", "print(1)", "m()"])
def test_nothing_is_executed(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*arguments: Any, **named: Any) -> Any:
        raise AssertionError("it was called")

    for name in ("eval", "exec", "open", "print"):
        monkeypatch.setattr(builtins, name, forbidden)
    assert isinstance(outcome(text, TWIST), str)
