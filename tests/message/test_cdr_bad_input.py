"""Bytes that are no message and values that fit no field: one clear error each, at once, and never another."""

# mypy: disable-error-code="arg-type, call-arg, list-item"
# Values of wrong types are what this file is about.

import tracemalloc
from array import array
from typing import Annotated, Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robolink.exceptions import DecodeError, EncodeError, MessageError
from robolink.interfaces import find, names
from robolink.interfaces.geometry_msgs.msg import Point, Pose, PoseArray, Quaternion, Twist, Vector3
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, ParameterValue
from robolink.interfaces.sensor_msgs.msg import Image, Imu, JointState, LaserScan
from robolink.interfaces.std_msgs.msg import (
    Bool,
    Byte,
    Char,
    Empty,
    Float32,
    Float64,
    Header,
    Int8,
    Int64,
    String,
    UInt8,
    UInt16,
)
from robolink.message import (
    AtMost,
    Message,
    Sequence,
    Size,
    boolean,
    byte,
    decode,
    decoder,
    encode,
    float64,
    string,
    type_name,
    uint8,
    wstring,
)

HEAD = b"\x00\x01\x00\x00"
DAEH = b"\x00\x00\x00\x00"
"""The encapsulation headers of little- and big-endian messages."""
QUICK = settings(deadline=None, suppress_health_check=list(HealthCheck), max_examples=30)


class Mixed(Message):
    """What the standard types have not: wide and bounded text, sequences of nothing, fixed arrays of everything."""

    text: wstring
    word: Annotated[string, AtMost(4)]
    octets: Annotated[Sequence[byte], Size(2)]
    bools: Sequence[boolean]
    three_bools: Annotated[Sequence[boolean], Size(3)]
    words: Annotated[Sequence[string], Size(2)]
    nothings: Sequence[Empty]
    few: Annotated[Sequence[uint8], AtMost(3)]
    poses: Annotated[Sequence[Pose], Size(2)]
    doubles: Sequence[float64]


SAMPLES: list[Any] = [
    Bool(data=True),
    Empty(),
    String(data="süß"),
    Twist(linear=Vector3(x=0.3)),
    Odometry(header=Header(frame_id="odom"), child_frame_id="base_link"),
    LaserScan(ranges=[1.0, 2.0, 3.0], intensities=[5.0]),
    JointState(name=["left", "", "right"], position=[1.0, 2.0], effort=[0.5]),
    Imu(header=Header(frame_id="imu")),
    PoseArray(poses=[Pose(), Pose()]),
    Image(encoding="mono8", data=bytes(range(7))),
    ParameterValue(bool_array_value=[True, False], byte_array_value=[b"x"], string_array_value=["a", "bc"]),
    ParameterDescriptor(name="speed", floating_point_range=[FloatingPointRange(to_value=1.0)]),
    Mixed(text="wide", word="four", bools=[True], nothings=[Empty()] * 3, few=[1, 2, 3], doubles=[1.0]),
]
each_sample = pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: type_name(type(sample)))


def message_or_error(cls: Any, data: bytes) -> Any:
    """What comes of any bytes: a message or a DecodeError; everything else fails the test."""
    try:
        return decode(cls, data)
    except DecodeError as error:
        return error


# ---- bytes ---------------------------------------------------------------------------------------------------------


@each_sample
def test_the_samples_come_back(sample: Any) -> None:
    assert decode(type(sample), encode(sample)) == sample


@each_sample
def test_cut_off_anywhere(sample: Any) -> None:
    data = encode(sample)
    for length in range(len(data)):
        error = message_or_error(type(sample), data[:length])
        assert isinstance(error, DecodeError)
        assert str(error).startswith(f"{type_name(type(sample))}: ")


@pytest.mark.slow
def test_every_type_cut_off_anywhere() -> None:
    for name in names("msg"):
        cls: Any = find(name)
        data = encode(cls())
        for length in range(len(data)):
            assert isinstance(message_or_error(cls, data[:length]), DecodeError), name


@each_sample
@pytest.mark.parametrize("filling", [b"\0", b"\xff"])
def test_bytes_behind_a_message_are_ignored(sample: Any, filling: bytes) -> None:
    data = encode(sample)
    for more in range(201):
        assert decode(type(sample), data + more * filling) == sample


@pytest.mark.parametrize("more", [0, 1, 4, 8, 200])
def test_a_length_that_lies_is_refused_whatever_is_behind(more: int) -> None:
    for count in (2**32 - 1, 2**31, 6 + more + 1):
        data = HEAD + count.to_bytes(4, "little") + b"hello\0" + bytes(more)
        assert isinstance(message_or_error(String, data), DecodeError)


@each_sample
@given(data=st.binary(max_size=200), head=st.sampled_from([b"", HEAD, DAEH]))
@QUICK
def test_random_bytes(sample: Any, data: bytes, head: bytes) -> None:
    assert isinstance(message_or_error(type(sample), head + data), (type(sample), DecodeError))


@each_sample
@given(index=st.integers(0, 2**16), values=st.binary(min_size=1, max_size=8))
@QUICK
def test_some_bytes_changed(sample: Any, index: int, values: bytes) -> None:
    data = encode(sample)
    index %= len(data)
    found = message_or_error(type(sample), data[:index] + values + data[index + len(values) :])
    assert isinstance(found, (type(sample), DecodeError))


@each_sample
@pytest.mark.parametrize("count", [2**32 - 1, 2**31 - 1, 2**24, 2**16])
def test_huge_counts_cost_nothing(sample: Any, count: int) -> None:
    data = encode(sample)
    message_or_error(type(sample), data)  # compiled before memory is measured
    tracemalloc.start()
    try:
        for index in range(4, len(data) - 3, 4):
            message_or_error(type(sample), data[:index] + count.to_bytes(4, "little") + data[index + 4 :])
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 200_000


@pytest.mark.parametrize("fill", [b"\x00", b"\x01", b"\xff"])
@pytest.mark.parametrize("cls", [Mixed, JointState, PoseArray, ParameterValue], ids=type_name)
def test_a_megabyte_of_nonsense_costs_no_more_than_a_message(cls: Any, fill: bytes) -> None:
    tracemalloc.start()
    try:
        for head in (HEAD, DAEH):
            message_or_error(cls, head + fill * 1_000_000)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 20_000_000


@pytest.mark.parametrize("data", [b"", b"\x00", b"\x00\x01", b"\x00\x02\x00\x00abcd", b"\x01\x01\x00\x00abcd", b"{}  "])
def test_no_encapsulation_header(data: bytes) -> None:
    with pytest.raises(DecodeError, match="std_msgs/msg/UInt8"):
        decode(UInt8, data)


def test_the_wrong_type() -> None:
    with pytest.raises(DecodeError, match="LaserScan"):
        decode(LaserScan, encode(Twist(linear=Vector3(y=0.1))))


def test_text_that_is_no_utf8_is_replaced() -> None:
    data = HEAD + b"\x03\x00\x00\x00\xffo\x00"
    assert decode(String, data).data == "\ufffdo"


def test_bounds_hold_when_decoding_too() -> None:
    data = encode(Mixed(few=[1, 2, 3]))
    place = data.index(b"\x03\x00\x00\x00\x01\x02\x03")
    with pytest.raises(DecodeError, match="over the bound"):
        decode(Mixed, data[:place] + b"\x04" + data[place + 1 :])


def test_views_and_bytearrays_decode_too() -> None:
    data = encode(String(data="x"))
    views: list[Any] = [bytearray(data), memoryview(data)]
    assert [decode(String, view) for view in views] == [String(data="x")] * 2
    assert decoder(String)(data) == String(data="x")


# ---- values --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (Twist(linear=Vector3(x="fast")), "Twist.linear.x: expected float64, got 'fast'"),
        (Twist(linear=Vector3(y=None)), "Twist.linear.y: expected float64, got None"),
        (Twist(linear=None), "Twist.linear: expected geometry_msgs/msg/Vector3, got None"),
        (Twist(angular={"z": 1.0}), "Twist.angular: expected geometry_msgs/msg/Vector3, got {'z': 1.0}"),
        (Int8(data=200), "Int8.data: expected int8, got 200"),
        (Int8(data=1.5), "Int8.data: expected int8, got 1.5"),
        (UInt8(data=-1), "UInt8.data: expected uint8, got -1"),
        (UInt16(data="7"), "UInt16.data: expected uint16, got '7'"),
        (Char(data="c"), "Char.data: expected char, got 'c'"),
        (Int64(data=2**63), "Int64.data: expected int64, got 9223372036854775808"),
        (Float32(data=1e39), "Float32.data: expected float32, got 1e+39"),
        (Float64(data=10**400), "Float64.data: expected float64, got 1000"),
        (Bool(data="no"), "Bool.data: expected bool, got 'no'"),
        (Bool(data=2), "Bool.data: expected bool, got 2"),
        (Bool(data=None), "Bool.data: expected bool, got None"),
        (Byte(data=b"ab"), "Byte.data: expected byte, got b'ab'"),
        (Byte(data=3), "Byte.data: expected byte, got 3"),
        (String(data=5), "String.data: expected string, got 5"),
        (String(data=b"bytes"), "String.data: expected string, got b'bytes'"),
        (String(data="\ud800"), "String.data: '\\ud800' is not valid Unicode"),
        (Header(stamp=3.5), "Header.stamp: expected builtin_interfaces/msg/Time, got 3.5"),
        (JointState(name="left"), "JointState.name: expected string[], got 'left'"),
        (JointState(name=["left", 2]), "JointState.name[1]: expected string, got 2"),
        (JointState(name=7), "JointState.name: expected string[], got 7"),
        (PoseArray(poses=[Pose(), Twist()]), "PoseArray.poses[1]: expected geometry_msgs/msg/Pose, got"),
        (PoseArray(poses=[Pose(position=Point(z="up"))]), "PoseArray.poses[0].position.z: expected float64"),
        (PoseArray(poses=None), "PoseArray.poses: expected geometry_msgs/Pose[], got None"),
        (LaserScan(ranges="abc"), "LaserScan.ranges: expected float32[], got 'abc'"),
        (LaserScan(ranges=[1.0, "far"]), "LaserScan.ranges: expected float32[], got [1.0, 'far']"),
        (LaserScan(ranges=None), "LaserScan.ranges: expected float32[], got None"),
        (LaserScan(ranges=np.array([1 + 2j])), "LaserScan.ranges: expected float32[]"),
        (Image(data=[256]), "Image.data: expected uint8[], got [256]"),
        (Image(data=np.array([-1, 3])), "Image.data: expected uint8[]"),
        (Imu(orientation_covariance=[0.0] * 8), "Imu.orientation_covariance: expected float64[9], got 8"),
        (Imu(orientation_covariance=np.zeros(8)), "Imu.orientation_covariance: expected float64[9], got 8"),
        (Imu(orientation_covariance=["a"] * 9), "Imu.orientation_covariance: expected float64[9], got"),
        (Imu(orientation_covariance=None), "Imu.orientation_covariance: expected float64[9], got None"),
        (
            ParameterDescriptor(floating_point_range=[FloatingPointRange()] * 2),
            "ParameterDescriptor.floating_point_range: expected rcl_interfaces/FloatingPointRange[<=1], got 2",
        ),
        (ParameterValue(bool_array_value=[True, "no"]), "ParameterValue.bool_array_value[1]: expected bool"),
        (Mixed(word="hello"), "Mixed.word: expected at most 4 characters, got 5"),
        (Mixed(few=[1, 2, 3, 4]), "Mixed.few: expected uint8[<=3], got 4"),
        (Mixed(three_bools=[True]), "Mixed.three_bools: expected bool[3], got 1"),
        (Mixed(octets=[b"a"]), "Mixed.octets: expected byte[2], got 1"),
        (Mixed(words=["a", "b", "c"]), "Mixed.words: expected string[2], got 3"),
        (Mixed(poses=[Pose()]), "Mixed.poses: expected geometry_msgs/Pose[2], got 1"),
        (Mixed(text=3), "Mixed.text: expected wstring, got 3"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_value_that_does_not_fit_is_named(message: Any, text: str) -> None:
    with pytest.raises(EncodeError) as raised:
        encode(message)
    assert str(raised.value).startswith(text)


@pytest.mark.parametrize("wrong", [Point(), Quaternion(), Twist()], ids=type_name)
def test_another_message_class_is_refused_even_if_it_has_the_same_fields(wrong: Any) -> None:
    with pytest.raises(EncodeError, match=r"Twist.linear: expected geometry_msgs/msg/Vector3, got"):
        encode(Twist(linear=wrong))


def test_an_assignment_that_does_not_fit_is_refused_at_once() -> None:
    scan: Any = LaserScan()
    imu = Imu()
    with pytest.raises(EncodeError, match=r"LaserScan.ranges: expected float32\[\], got 'abc'"):
        scan.ranges = "abc"
    with pytest.raises(EncodeError, match=r"Imu.orientation_covariance: expected float64\[9\], got 3 elements"):
        imu.orientation_covariance = [1.0, 2.0, 3.0]


def test_an_unknown_field_is_refused() -> None:
    with pytest.raises(TypeError, match="lineal"):
        Twist(lineal=Vector3())


def test_what_is_no_message_is_refused() -> None:
    wrong: Any = "fast"
    with pytest.raises(MessageError, match="<class 'str'> is not a message class"):
        encode(wrong)
    with pytest.raises(MessageError, match="<class 'str'> is not a message class"):
        decode(type(wrong), b"")


@pytest.mark.parametrize(
    "ranges",
    [[1.0, 2.5], (1.0, 2.5), np.array([1.0, 2.5]), array("d", [1.0, 2.5]), np.array([1.0, 9.0, 2.5])[::2], range(1, 3)],
    ids=["list", "tuple", "numpy", "array of doubles", "numpy with a stride", "range"],
)
def test_any_sequence_of_numbers_will_do(ranges: Any) -> None:
    expected = [float(each) for each in ranges]
    given, assigned = LaserScan(ranges=ranges), LaserScan()
    assigned.ranges = ranges
    assert given == assigned
    assert encode(given) == encode(assigned)
    assert decode(LaserScan, encode(given)).ranges == array("f", expected)


@pytest.mark.parametrize("kind", ["int32", "float32", "float64", "bool"])
def test_a_fixed_array_takes_other_numbers(kind: str) -> None:
    covariance = np.eye(3).reshape(9).astype(kind)
    imu = Imu(orientation_covariance=covariance, angular_velocity_covariance=covariance.tolist())
    back = decode(Imu, encode(imu))
    assert back.orientation_covariance.dtype == np.float64
    assert back.orientation_covariance.tolist() == back.angular_velocity_covariance.tolist()
    assert back.orientation_covariance.tolist() == np.eye(3).reshape(9).tolist()


def test_numpy_scalars_will_do() -> None:
    twist = Twist(linear=Vector3(x=np.float32(0.5), y=np.float64(1.5), z=np.int32(2)))
    assert decode(Twist, encode(twist)) == Twist(linear=Vector3(x=0.5, y=1.5, z=2.0))
    assert decode(Bool, encode(Bool(data=np.bool_(True)))) == Bool(data=True)
    assert decode(UInt8, encode(UInt8(data=np.uint8(7)))) == UInt8(data=7)


def test_not_a_number_and_infinity_pass() -> None:
    scan = decode(LaserScan, encode(LaserScan(ranges=[float("nan"), float("inf"), float("-inf")])))
    assert np.array_equal(scan.ranges, [np.nan, np.inf, -np.inf], equal_nan=True)
