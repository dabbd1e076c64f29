"""Sequences and arrays of messages: the values that they accept, and how they are kept."""

import array

import numpy as np
from geometry_msgs.msg import *
from probe import show
from sensor_msgs.msg import *
from std_msgs.msg import *
from test_msgs.msg import Arrays, BoundedPlainSequences, BoundedSequences, Strings, UnboundedSequences, WStrings


def kind_of(v):
    return type(v).__name__ + (
        ":" + (v.typecode if isinstance(v, array.array) else str(v.dtype))
        if isinstance(v, (array.array, np.ndarray))
        else ""
    )


def a(label, f):
    show(label, lambda: (lambda v: (kind_of(v), list(v) if not isinstance(v, (str,)) else v))(f()))


a("ranges default", lambda: LaserScan().ranges)
a("list", lambda: LaserScan(ranges=[1.0, 2.0]).ranges)
a("ints", lambda: LaserScan(ranges=[1, 2]).ranges)
a("tuple", lambda: LaserScan(ranges=(1.0,)).ranges)
a("np32", lambda: LaserScan(ranges=np.array([1.0], dtype=np.float32)).ranges)
a("np64", lambda: LaserScan(ranges=np.array([1.0])).ranges)
a("array f", lambda: LaserScan(ranges=array.array("f", [1.0])).ranges)
a("array d", lambda: LaserScan(ranges=array.array("d", [1.0])).ranges)
a("generator", lambda: LaserScan(ranges=(x for x in [1.0])).ranges)
a("set", lambda: LaserScan(ranges={1.0}).ranges)
a("str", lambda: LaserScan(ranges="ab").ranges)
a("None", lambda: LaserScan(ranges=None).ranges)
a("float", lambda: LaserScan(ranges=1.0).ranges)
a("range", lambda: LaserScan(ranges=range(2)).ranges)
a("list of str", lambda: LaserScan(ranges=["a"]).ranges)
a("inf", lambda: LaserScan(ranges=[float("inf"), float("nan")]).ranges)
a("too big", lambda: LaserScan(ranges=[1e39]).ranges)
a("0.1", lambda: LaserScan(ranges=[0.1]).ranges)
a("dict", lambda: LaserScan(ranges={1.0: 2}).ranges)
a("map", lambda: LaserScan(ranges=map(float, [1])).ranges)
a("image default", lambda: Image().data)
a("bytes", lambda: Image(data=b"abc").data)
a("bytearray", lambda: Image(data=bytearray(b"abc")).data)
a("list u8", lambda: Image(data=[1, 255]).data)
a("256", lambda: Image(data=[256]).data)
a("neg", lambda: Image(data=[-1]).data)
a("np u8", lambda: Image(data=np.zeros(3, np.uint8)).data)
a("np 2d", lambda: Image(data=np.zeros((2, 2), np.uint8)).data)
a("memoryview", lambda: Image(data=memoryview(b"ab")).data)
a("tobytes", lambda: Image(data=np.zeros(3, np.uint8).tobytes()).data)
a("array B", lambda: Image(data=array.array("B", [1])).data)
a("array b", lambda: Image(data=array.array("b", [1])).data)
a("floats in u8", lambda: Image(data=[1.0]).data)
a("str u8", lambda: Image(data="abc").data)
a("cov default", lambda: Imu().orientation_covariance)
a("cov list", lambda: Imu(orientation_covariance=[1.0] * 9).orientation_covariance)
a("cov short", lambda: Imu(orientation_covariance=[1.0] * 8).orientation_covariance)
a("cov ints", lambda: Imu(orientation_covariance=[1] * 9).orientation_covariance)
a("cov np", lambda: Imu(orientation_covariance=np.ones(9)).orientation_covariance)
a("cov np32", lambda: Imu(orientation_covariance=np.ones(9, np.float32)).orientation_covariance)
a("cov np33", lambda: Imu(orientation_covariance=np.ones((3, 3))).orientation_covariance)
a("cov tuple", lambda: Imu(orientation_covariance=(1.0,) * 9).orientation_covariance)
a("cov array", lambda: Imu(orientation_covariance=array.array("d", [1.0] * 9)).orientation_covariance)
show(
    "item assign",
    lambda: (lambda m: (m.orientation_covariance.__setitem__(0, 5), m.orientation_covariance[0])[1])(Imu()),
)
show(
    "item assign int type",
    lambda: (lambda m: (m.orientation_covariance.__setitem__(0, 5), type(m.orientation_covariance[0]).__name__)[1])(
        Imu()
    ),
)
show("append", lambda: (lambda m: (m.ranges.append(1.5), list(m.ranges))[1])(LaserScan()))
show("append str", lambda: LaserScan().ranges.append("x"))
show("append u8", lambda: Image().data.append(300))
show("list shared", lambda: (lambda l, m: (setattr(m, "poses", l), m.poses is l)[1])([], PoseArray()))
show("array shared", lambda: (lambda l, m: (setattr(m, "ranges", l), m.ranges is l)[1])(array.array("f"), LaserScan()))
show("default not shared", lambda: PoseArray().poses is PoseArray().poses)
a("poses", lambda: PoseArray(poses=[]).poses)
a("poses tuple", lambda: PoseArray(poses=(Pose(),)).poses[:0])
a("poses wrong", lambda: PoseArray(poses=[Point()]).poses)
a("poses None elem", lambda: PoseArray(poses=[None]).poses)
a("poses gen", lambda: PoseArray(poses=(Pose() for _ in range(1))).poses)
show("append wrong elem", lambda: PoseArray().poses.append(3))
a("names", lambda: JointState(name=["a", "b"]).name)
a("names str", lambda: JointState(name="ab").name)
a("names ints", lambda: JointState(name=[1]).name)
a("names np", lambda: JointState(name=np.array(["a"])).name)
a("position", lambda: JointState(position=[1.0]).position)
a("position np", lambda: JointState(position=np.array([1.0])).position)
a("position deque", lambda: JointState(position=__import__("collections").deque([1.0])).position)
A = Arrays
B = BoundedSequences
U = UnboundedSequences
for f in (
    "bool_values",
    "byte_values",
    "char_values",
    "float32_values",
    "int8_values",
    "uint8_values",
    "int64_values",
    "string_values",
):
    a(f"array {f}", lambda: getattr(A(), f))
    a(f"bounded {f}", lambda: getattr(B(), f))
    a(f"unbounded {f}", lambda: getattr(U(), f))
a("bounded 3", lambda: B(int32_values=[1, 2, 3]).int32_values)
a("bounded 4", lambda: B(int32_values=[1, 2, 3, 4]).int32_values)
a("bounded str 4", lambda: B(string_values=["a"] * 4).string_values)
a("bool ints", lambda: U(bool_values=[1, 0]).bool_values)
a("byte seq", lambda: U(byte_values=[b"a", b"b"]).byte_values)
a("byte seq bytes", lambda: U(byte_values=b"ab").byte_values)
a("byte seq ints", lambda: U(byte_values=[1, 2]).byte_values)
a("fixed short", lambda: A(int32_values=[1, 2]).int32_values)
a("fixed list", lambda: A(int32_values=[1, 2, 3]).int32_values)
a("fixed floats", lambda: A(int32_values=[1.5, 2.0, 3.0]).int32_values)
a("fixed strings", lambda: A(string_values=["a", "b", "c"]).string_values)
a("fixed strings short", lambda: A(string_values=["a"]).string_values)
a("int8 200", lambda: U(int8_values=[200]).int8_values)
a("np int64 to int32", lambda: U(int32_values=np.array([1])).int32_values)
a("np int32", lambda: U(int32_values=np.array([1], np.int32)).int32_values)
a("np bool", lambda: U(bool_values=np.array([True])).bool_values)
show("bounded string", lambda: Strings(bounded_string_value="x" * 22).bounded_string_value)
show("bounded string 23", lambda: Strings(bounded_string_value="x" * 23))
show("wstring", lambda: WStrings(wstring_value="é").wstring_value)
show("unicode bound", lambda: len(Strings(bounded_string_value="é" * 22).bounded_string_value))
