"""Bytes that serialize_message writes and deserialize_message reads."""

import math

import rclpy.serialization as S
import std_msgs.msg as sm
import test_msgs.msg as tm
from geometry_msgs.msg import *
from nav_msgs.msg import *
from probe import masked, show
from rcl_interfaces.msg import Log, ParameterEvent
from sensor_msgs.msg import *
from std_msgs.msg import *
from std_srvs.srv import SetBool, Trigger
from test_msgs.msg import *


def s(label, m):
    show(label, lambda: masked(m, S.serialize_message(m)))


s("String", String(data="hello"))
s("String empty", String())
s("unicode", String(data="é€😀"))
s("nul", String(data="a\0b"))
s("surrogate", String(data="\ud800"))
s("Bool", Bool(data=True))
s("Int8", Int8(data=-1))
s("UInt64", UInt64(data=2**64 - 1))
s("Float32", Float32(data=0.1))
s("Float32 nan", Float32(data=math.nan))
s("Float64 -0", Float64(data=-0.0))
s("Char", sm.Char(data=65))
s("Byte", sm.Byte(data=b"\xff"))
s("Empty", sm.Empty())
s("TEmpty", tm.Empty())
s("Header", Header(frame_id="base", stamp=__import__("builtin_interfaces.msg").msg.Time(sec=-1, nanosec=7)))
s("Twist", Twist())
s("Pose", PoseStamped(header=Header(frame_id="m")))
s("LaserScan", LaserScan(ranges=[1.0, math.inf], intensities=[]))
s("Image", Image(data=b"\1\2\3", width=3, encoding="mono8"))
s("Imu", Imu())
s("JointState", JointState(name=["a", "bcd"], position=[1.0]))
s("empty seqs", JointState())
s("PoseArray", PoseArray(poses=[Pose(), Pose()]))
s("Odometry", Odometry(child_frame_id="c"))
s("OccGrid", OccupancyGrid(data=[-1, 100]))
s("Path", Path(poses=[PoseStamped()]))
s("PointCloud2", PointCloud2(fields=[PointField(name="x", offset=0, datatype=7, count=1)], data=b"ab", is_dense=True))
s(
    "MultiArray",
    Float32MultiArray(data=[1.0], layout=MultiArrayLayout(dim=[MultiArrayDimension(label="x", size=1, stride=1)])),
)
s("ByteMultiArray", ByteMultiArray(data=[b"a"]))
s("Color", ColorRGBA(r=1.0))
s("BasicTypes", BasicTypes(bool_value=True, uint64_value=5, char_value=3))
s("Arrays", Arrays())
s("Bounded", BoundedSequences(bool_values=[True], string_values=["x"]))
s("Unbounded", UnboundedSequences(int64_values=[1], string_values=["x", ""]))
s("MultiNested", MultiNested())
s("Nested", Nested())
s("WStrings", WStrings(wstring_value="é😀"))
s("Strings", Strings(string_value="q"))
s("Defaults", Defaults())
s("Constants", Constants())
s("Param event", ParameterEvent(node="/n"))
s("Log", Log(msg="x"))
s("srv request", SetBool.Request(data=True))
s("srv response", Trigger.Response(success=True, message="m"))
s("TransformStamped", TransformStamped(child_frame_id="x"))
s("Polygon", PolygonStamped(polygon=Polygon(points=[Point32(x=1.0)])))
show("wrong", lambda: S.serialize_message(3))
show("class", lambda: S.serialize_message(String))
show("SRV class", lambda: S.serialize_message(SetBool))


def d(label, b, t):
    show(label, lambda: S.deserialize_message(b, t))


H = bytes.fromhex
d("string", H("000100000300000061620000"), String)
d("no nul", H("00010000020000006162"), String)
d("short", H("000100000500000061"), String)
d("empty bytes", b"", String)
d("header only", H("00010000"), String)
d("big endian", H("000000000000000361620000"), String)
d("trailing", H("0001000001000000000102030405"), String)
d("bad utf8", H("0001000002000000ff00"), String)
d("bool 2", H("0001000002"), Bool)
d("zero length", H("0001000000000000"), String)
d("huge", H("00010000ffffffff"), String)
d("point", S.serialize_message(Point(x=1.0, y=2.0)), Point)
d("bytearray", bytearray(S.serialize_message(Int32(data=5))), Int32)
d("memoryview", memoryview(S.serialize_message(Int32(data=5))), Int32)
d("str", "abc", Int32)
d("wrong type", H("00010000"), int)
d("empty msg", H("0001000000"), sm.Empty)
d("pl cdr", H("000300000300000061620000"), String)
for m in (
    Image(data=b"\1\2"),
    LaserScan(ranges=[0.1]),
    Imu(),
    JointState(name=["a"]),
    ByteMultiArray(data=[b"a"]),
    BasicTypes(),
    Arrays(),
    BoundedSequences(int32_values=[1]),
    WStrings(wstring_value="é"),
    MultiNested(),
    Defaults(),
):
    show(f"round {type(m).__name__}", lambda: S.deserialize_message(S.serialize_message(m), type(m)) == m)
r = S.deserialize_message(S.serialize_message(LaserScan(ranges=[0.1])), LaserScan)
show("types", lambda: (type(r.ranges).__name__, list(r.ranges)))
r = S.deserialize_message(S.serialize_message(Image(data=b"ab")), Image)
show("types", lambda: (type(r.data).__name__, list(r.data)))
r = S.deserialize_message(S.serialize_message(Imu()), Imu)
show("types", lambda: type(r.orientation_covariance).__name__)
r = S.deserialize_message(S.serialize_message(Float32(data=0.1)), Float32)
show("f32", lambda: r.data)
r = S.deserialize_message(
    S.serialize_message(UnboundedSequences(bool_values=[True], byte_values=[b"a"], string_values=["s"])),
    UnboundedSequences,
)
show("seq", lambda: (r.bool_values, r.byte_values, r.string_values))
