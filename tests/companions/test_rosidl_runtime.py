"""What programs import from rosidl_runtime_py: messages from and to plain data, and types by name."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from robolink.companions.rosidl_runtime import (
    _kind_of,
    get_action,
    get_action_interfaces,
    get_interface,
    get_interface_packages,
    get_interface_path,
    get_interfaces,
    get_message,
    get_message_interfaces,
    get_message_slot_types,
    get_service,
    get_service_interfaces,
    import_message_from_namespaced_type,
    is_action,
    is_message,
    is_service,
    message_to_csv,
    message_to_ordereddict,
    message_to_yaml,
    set_message_fields,
)
from robolink.exceptions import EncodeError, MessageError, NotFoundError
from robolink.interfaces import find
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.geometry_msgs.msg import PointStamped, PoseArray, PoseStamped, Twist
from robolink.interfaces.sensor_msgs.msg import Imu, JointState, LaserScan
from robolink.interfaces.std_msgs.msg import Bool, Byte, Float64, Header, Int32, String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import encode
from robolink.message.convert import UnknownFieldError
from robolink.message.definition import parse
from robolink.message.slot_types import BasicType, BoundedSequence, NamespacedType, UnboundedString
from robolink.workspace import VARIABLE


def test_a_message_as_text() -> None:
    scan = LaserScan(header=Header(frame_id="lidar"), ranges=[1.0, 2.0, 3.0])
    text = message_to_yaml(scan)
    assert text.startswith("header:\n  stamp:\n    sec: 0\n")
    assert text.endswith("\n")
    assert yaml.safe_load(text) == message_to_ordereddict(scan)
    assert "ranges:\n- 1.0\n- 2.0\n- '...'" in message_to_yaml(scan, truncate_length=2)
    assert "<sequence type: float, length: 3>" in message_to_yaml(scan, no_arr=True)
    assert message_to_yaml(String(data="hello"), no_str=True) == "data: '<string length: <5>>'\n"
    assert "ranges: [1.0, 2.0, 3.0]\nintensities: []\n" in message_to_yaml(scan, flow_style=True)
    assert message_to_ordereddict(Byte(data=b"2")) == {"data": "2"}
    assert message_to_csv(PointStamped(header=Header(frame_id="map"))) == "0,0,map,0.0,0.0,0.0"
    assert list(message_to_ordereddict(scan))[:2] == ["header", "angle_min"]
    assert list(get_message_slot_types(Twist())) == ["linear", "angular"]
    with pytest.raises(MessageError):
        message_to_yaml("no message")


def test_fields_are_set_from_plain_data() -> None:
    pose = PoseStamped()
    assert set_message_fields(pose, {"header": {"frame_id": "map"}, "pose": {"position": {"x": 1, "y": "2.5"}}}) == []
    assert (pose.header.frame_id, pose.pose.position.x, pose.pose.position.y) == ("map", 1.0, 2.5)
    assert type(pose.pose.position.x) is float
    pose.pose.orientation.w = 1.0
    set_message_fields(pose, {"pose": {"position": {"z": 3.0}}})
    assert (pose.pose.orientation.w, pose.pose.position.z) == (1.0, 3.0)


def test_what_a_mapping_leaves_out_of_a_nested_message_begins_anew() -> None:
    pose = PoseStamped()
    pose.header.frame_id = "map"
    set_message_fields(pose, {"header": {"stamp": {"sec": 1}}})
    assert pose.header == Header(stamp=Time(sec=1))


def filled(message: Any, data: Any) -> Any:
    set_message_fields(message, {"data": data})
    return message


def test_sequences_numbers_and_texts() -> None:
    poses, joints = PoseArray(), JointState()
    set_message_fields(poses, {"poses": [{"position": {"x": 1.0}}, {}]})
    assert [each.position.x for each in poses.poses] == [1.0, 0.0]
    set_message_fields(joints, {"name": ["a", 7], "position": [1, 2.5]})
    assert (joints.name, list(joints.position)) == (["a", "7"], [1.0, 2.5])
    number, text, octet = Int32(), String(), Byte()
    set_message_fields(number, {"data": "12"})
    set_message_fields(text, {"data": 5})
    set_message_fields(octet, {"data": 5})
    assert (number.data, text.data, octet.data) == (12, "5", b"\x05")
    assert filled(Int32(), 5.7).data == 5
    assert [filled(Bool(), each).data for each in (2, 0.0, "on", "No", True)] == [True, False, True, False, True]
    imu = Imu()
    set_message_fields(imu, {"orientation_covariance": ["1"] * 9})
    assert list(imu.orientation_covariance) == [1.0] * 9
    inner = Header(frame_id="x")
    stamped = PointStamped()
    set_message_fields(stamped, {"header": inner})
    assert stamped.header is inner


@pytest.mark.parametrize("values", [{"header": "auto"}, {"header": {"stamp": "now", "frame_id": "map"}}])
def test_times_that_are_put_in_later(values: dict[str, Any]) -> None:
    point = PointStamped()
    setters = set_message_fields(point, values, expand_header_auto=True, expand_time_now=True)
    for each in setters:
        each(Time(sec=1, nanosec=2))
    assert (len(setters), point.header.stamp) == (1, Time(sec=1, nanosec=2))
    assert point.header.frame_id == ("map" if "auto" not in values.values() else "")
    with pytest.raises(TypeError, match=r"Value '(auto|now)' is expected to be a dictionary but is a str"):
        set_message_fields(PointStamped(), values)


def test_times_in_sequences_too() -> None:
    from robolink.interfaces.trajectory_msgs.msg import MultiDOFJointTrajectory
    from robolink.interfaces.visualization_msgs.msg import MarkerArray

    markers = MarkerArray()
    setters = set_message_fields(markers, {"markers": [{"header": "auto"}, {"header": "auto", "id": 2}]}, True, True)
    for each in setters:
        each(Time(sec=5))
    assert [each.header.stamp.sec for each in markers.markers] == [5, 5]
    assert set_message_fields(MultiDOFJointTrajectory(), {"header": "auto"}, True)


@pytest.mark.parametrize(
    ("message", "values", "kind", "report"),
    [
        (Twist(), {"linar": {}}, AttributeError, "Twist: no field 'linar' (did you mean 'linear'?)"),
        (Twist(), {"linear": {"w": 1}}, AttributeError, "Twist.linear: no field 'w'"),
        (Twist(), "fast", TypeError, "Value 'fast' is expected to be a dictionary"),
        (Twist(), {"linear": 3}, TypeError, "Value '3' is expected to be a dictionary but is a int (Twist.linear)"),
        (Float64(), {"data": "fast"}, ValueError, "Float64.data: expected float64, got 'fast'"),
        (Int32(), {"data": "fast"}, ValueError, "Int32.data: expected int32, got 'fast'"),
        (Int32(), {"data": 2**40}, ValueError, "Int32.data: expected int32, got 1099511627776"),
        (PoseArray(), {"poses": 3}, TypeError, "PoseArray.poses: expected geometry_msgs/Pose[], got 3"),
        (PoseArray(), {"poses": [3]}, TypeError, "is a int (PoseArray.poses[0])"),
        (JointState(), {"position": "abc"}, TypeError, "JointState.position: expected float64[], got 'abc'"),
        (JointState(), {"position": ["a"]}, ValueError, "JointState.position[0]: expected float64, got 'a'"),
        (Float64(), {"data": None}, TypeError, "Float64.data: expected float64, got None"),
    ],
)
def test_data_that_does_not_fit_names_the_field(message: Any, values: Any, kind: type[Exception], report: str) -> None:
    before = copy.deepcopy(message)
    with pytest.raises(kind) as caught:
        set_message_fields(message, values)
    assert report in str(caught.value)
    assert isinstance(caught.value, TypeError) == (kind is not AttributeError)  # joy_teleop goes on at a TypeError
    assert message == before


DATA = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=4)
    | st.binary(max_size=3)
    | st.just("now"),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["header", "stamp", "sec", "pose", "position", "x", "frame_id", "poses"]), inner
        )
    ),
    max_leaves=8,
)


@given(DATA, st.sampled_from([PoseStamped, PoseArray, JointState, Float64, String, Byte]))
def test_any_data_makes_a_message_or_an_error(data: Any, kind: type[Any]) -> None:
    message = kind()
    try:
        setters = set_message_fields(message, data, True, True)
    except (EncodeError, UnknownFieldError):
        assert message == kind()
        return
    for each in setters:
        each(Time(sec=1))
    assert encode(message)
    assert yaml.safe_load(message_to_yaml(message)) is not None
    assert message_to_csv(message) is not None


# --- types by name ----------------------------------------------------------------------------------------------


def test_classes_by_name() -> None:
    assert get_message("std_msgs/msg/String") is get_message("std_msgs/String") is String
    assert get_service("std_srvs/srv/SetBool") is get_service("std_srvs/SetBool") is SetBool
    assert (
        get_action("example_interfaces/Fibonacci") is get_interface("example_interfaces/action/Fibonacci") is Fibonacci
    )
    feedback = NamespacedType(("example_interfaces", "action"), "Fibonacci_FeedbackMessage")
    assert import_message_from_namespaced_type(feedback) is Fibonacci.Impl.FeedbackMessage
    kinds = [(is_message(each), is_service(each), is_action(each)) for each in (String, SetBool, Fibonacci)]
    assert kinds == [(True, False, False), (False, True, False), (False, False, True)]


@pytest.mark.parametrize(
    ("ask", "name", "kind", "report"),
    [
        (
            get_message,
            "std_srvs/srv/SetBool",
            ValueError,
            "Expected the full name of a message, got 'std_srvs/srv/SetBool'",
        ),
        (get_service, "std_msgs/msg/String", ValueError, "Expected the full name of a service"),
        (get_action, "std_msgs/msg/String", ValueError, "Expected the full name of an action"),
        (get_message, "String", ValueError, "Expected the full name of a type, as std_msgs/msg/String, got 'String'"),
        (get_message, "a/b/c/d", ValueError, "Expected the full name"),
        (get_message, "/msg/", ValueError, "Expected the full name"),
        (
            get_message,
            "std_msgs/msg/Strin",
            AttributeError,
            "no message type named 'Strin' in std_msgs (did you mean 'String'?)",
        ),
        (get_message, "stdd_msgs/msg/String", ModuleNotFoundError, "no interface package named 'stdd_msgs'"),
        (get_interface, "std_msgs/idl/String", AttributeError, "no kind of type named 'idl'"),
    ],
)
def test_names_that_find_nothing(ask: Any, name: str, kind: type[Exception], report: str) -> None:
    with pytest.raises(kind) as caught:
        ask(name)
    assert report in str(caught.value)


def test_what_there_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert {"std_msgs", "std_srvs", "example_interfaces"} <= set(get_interface_packages())
    assert "msg/Twist" in get_interfaces()["geometry_msgs"]
    assert set(get_message_interfaces(["std_msgs", "std_srvs"])) == {"std_msgs"}
    assert get_service_interfaces(["std_srvs"])["std_srvs"] == ["srv/Empty", "srv/SetBool", "srv/Trigger"]
    assert get_action_interfaces(["std_srvs", "example_interfaces"]) == {"example_interfaces": ["action/Fibonacci"]}
    assert get_interfaces(["robolink"]) == {}
    with pytest.raises(LookupError, match="no package named 'std_mgs'"):
        get_interfaces(["std_mgs"])


def test_the_idl_file_of_a_definition(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "interfaces/depths/msg"
    folder.mkdir(parents=True)
    (folder / "Depth.msg").write_text("float32 value\n")
    (folder / "Depth.idl").write_text("module depths { module msg { struct Depth { float value; }; }; };\n")
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    assert get_interface_path("depths/msg/Depth.idl") == str(folder / "Depth.idl")
    assert get_interface_path("depths/msg/Depth") == str(folder / "Depth.msg")


@pytest.mark.parametrize("name", ["geometry_msgs/msg/Twist", "geometry_msgs/msg/Twist.msg", "std_srvs/srv/SetBool"])
def test_the_file_of_a_definition(name: str) -> None:
    path = Path(get_interface_path(name))
    full = name.removesuffix(".msg")
    kind = full.split("/")[1]
    assert path.name == f"{full.split('/')[-1]}.{kind}"
    parse(path.read_text(), full, str(path))
    assert get_interface_path(name) == str(path)
    assert find(full, kind)


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("Twist", ValueError),
        ("geometry_msgs//Twist", ValueError),
        ("../msg/Twist", LookupError),
        ("geometry_msgs/msg/..", LookupError),
        ("geometry_msgs/msg/Twits", LookupError),
        ("geometry_msgs/msg/Twist.idl", LookupError),
    ],
)
def test_a_definition_that_is_not_there(name: str, kind: type[Exception]) -> None:
    with pytest.raises((kind, MessageError, NotFoundError)):
        get_interface_path(name)


class Described:
    """A class of a program's own that describes its fields as rosidl's do."""

    SLOT_TYPES = (
        NamespacedType(("std_msgs", "msg"), "Header"),
        BasicType("double"),
        BoundedSequence(UnboundedString(), 2),
    )

    def __init__(self) -> None:
        self.header, self.range, self.names = Header(), 0.0, [""]

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        return {"header": "std_msgs/Header", "range": "double", "names": "sequence<string, 2>"}


def test_a_class_that_describes_itself_is_filled_as_a_message() -> None:
    message = Described()
    (setter,) = set_message_fields(
        message, {"header": "auto", "range": 2, "names": ["a", "b"]}, expand_header_auto=True
    )
    setter(Time(sec=3))
    assert (message.header.stamp.sec, message.range, message.names) == (3, 2.0, ["a", "b"])
    with pytest.raises(EncodeError, match="names"):
        set_message_fields(message, {"names": ["a", "b", "c"]})
    with pytest.raises(AttributeError, match="rang"):
        set_message_fields(message, {"rang": 2})


@pytest.mark.parametrize("kind", [Imu, JointState, Byte, Header, PoseArray])
def test_slot_types_are_rosidls_and_lead_back_to_the_fields(kind: type[Any]) -> None:
    slots = get_message_slot_types(kind())
    assert tuple(slots.values()) == kind.SLOT_TYPES
    assert {name: _kind_of(each) for name, each in slots.items()} == dict(kind.__ros_fields__)


def test_the_class_of_the_elements_of_a_sequence() -> None:
    with pytest.warns(DeprecationWarning, match="NamespacedType object directly"):
        found = import_message_from_namespaced_type(BoundedSequence(NamespacedType(("std_msgs", "msg"), "Header"), 3))
    assert found is Header
