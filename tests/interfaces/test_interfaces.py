"""The standard types: their hashes are ROS 2 Jazzy's, their constants too, and each is found by its name."""

import importlib
import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from rosbags.typesys import Stores, get_typestore

from robolink.exceptions import EncodeError, MessageError
from robolink.interfaces import find, find_announced, names
from robolink.interfaces.action_msgs.msg import GoalStatusArray
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from robolink.interfaces.nav2_msgs.action import NavigateToPose
from robolink.interfaces.sensor_msgs.msg import LaserScan, NavSatStatus
from robolink.interfaces.standard import KINDS, packages, types_of
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.message import (
    Action,
    Message,
    action_type,
    decode,
    encode,
    float64,
    string,
    type_hash,
    type_name,
)
from tests.support import ros_test_types as ros

DATA = Path(__file__).parents[1] / "data"
ALL_HASHES: dict[str, str] = json.loads((DATA / "type_hashes.json").read_text())
"""Jazzy's hashes, of messages, services, actions and what these are made of.

Those of the common packages' messages are rosbags', those of services and of some actions' parts were announced by
real ROS 2 nodes. Where a .msg file has a char (Char, ServiceEventInfo, rmw_dds_common's Gid and what holds it), rosbags
takes it for IDL's; Jazzy makes it a uint8 (rosidl_adapter), and the announced hash of every service, which covers a
ServiceEventInfo, agrees. The other rows are our own: rosbags read the same fields from the files of the Jazzy branches
and gave the same hash for every message, request, response, goal, result and feedback. That of nav_msgs/Goals, which
Jazzy has not, is in the file that Kilted's rosidl generated.
"""
COMPUTED: dict[str, Any] = json.loads((DATA / "type_hashes_computed.json").read_text())
"""Hashes and constants of packages whose hashes nobody publishes, with the place of their definitions.

Computed by tools/type_hashes.py from the files there. Of the 181 files in the wheels of Kilted's common packages and
test_msgs, which hold rosidl's own hashes, the tool gives the same ones.
"""
HASHES = {
    name: each
    for table in (ALL_HASHES, *(package["hashes"] for package in COMPUTED.values()))
    for name, each in table.items()
    if not name.startswith("test_msgs/")
}
"""Those of the types that come with robolink: test_msgs is made of the tests' own files."""
ALL = names("msg") + names("srv") + names("action")
PARTS = ("Request", "Response", "Goal", "Result", "Feedback")


def announced_of(name: str) -> list[str]:
    """The types that endpoints of an action announce; for a message or service, its own name."""
    parts = ("", "_SendGoal", "_GetResult", "_FeedbackMessage") if "/action/" in name else ("",)
    return [name + part for part in parts]


def defined() -> Iterator[Any]:
    """Every message, service and action class of the packages."""
    for package in packages():
        for kind in KINDS:
            for short in types_of(package, kind):
                yield getattr(importlib.import_module(f"robolink.interfaces.{package}.{kind}"), short)


def messages_in(interface: Any) -> list[Any]:
    """The messages that are written in a class: itself, or the parts of a service or an action."""
    return [getattr(interface, part) for part in PARTS if part in interface.__dict__] or [interface]


def test_hashes_are_those_of_ros() -> None:
    assert {name: type_hash(find_announced(name)) for name in HASHES} == HASHES


def test_hashes_of_classes_made_of_files_are_those_of_ros() -> None:
    found = dict[str, str]()
    for each in (*vars(ros.msg).values(), *vars(ros.srv).values(), *vars(ros.action).values()):
        impl = each.Impl if hasattr(each, "Impl") else None
        parts = () if impl is None else (impl.SendGoalService, impl.GetResultService, impl.FeedbackMessage)
        found.update((type_name(part), type_hash(part)) for part in (each, *parts))
    assert found == {name: each for name, each in ALL_HASHES.items() if name.startswith("test_msgs/")}


def test_no_type_is_without_a_hash_to_compare_with() -> None:
    expected = {part for name in ALL for part in announced_of(name)} - set(names("action"))
    assert set(HASHES) == expected | set(names("action"))


def test_the_names_are_what_the_modules_define() -> None:
    assert sorted(type_name(cls) for cls in defined()) == sorted(ALL)


def test_each_package_says_what_it_is_for() -> None:
    assert len(packages()) > 40
    for package in packages():
        module = importlib.import_module(f"robolink.interfaces.{package}")
        assert str(module.__doc__).startswith(f"# {package}\n\n")


@pytest.mark.processes
def test_a_type_is_made_when_it_is_first_used_and_once() -> None:
    program = """
import sys
from robolink.interfaces.geometry_msgs import msg
assert "Twist" not in vars(msg)
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces import find
assert find("Twist") is Twist is msg.Twist and type(Twist().linear) is msg.Vector3
assert "Wrench" not in vars(msg) and "Wrench" in dir(msg) and "Wrench" in msg.__all__
try:
    msg.Twits
except AttributeError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == (
        "module 'robolink.interfaces.geometry_msgs.msg' has no attribute 'Twits' (did you mean 'Twist'?)\n"
    )


@pytest.mark.processes
def test_threads_that_use_a_type_first_get_one_class() -> None:
    program = """
import threading
from concurrent.futures import ThreadPoolExecutor
from robolink.interfaces.nav_msgs import msg
start = threading.Barrier(8)
def use(_):
    start.wait()
    return msg.Odometry
with ThreadPoolExecutor(8) as pool:
    assert len(set(pool.map(use, range(8)))) == 1
"""
    subprocess.run([sys.executable, "-c", program], check=True)


@pytest.mark.processes
def test_stubs_are_fresh() -> None:
    # In a process of its own, as a developer runs it: what other tests make of these types does not count.
    checked = subprocess.run([sys.executable, "tools/interface_stubs.py", "--check"], capture_output=True, text=True)
    assert (checked.returncode, checked.stderr) == (0, "")


def test_every_class_says_what_it_means() -> None:
    parts = [getattr(cls, part) for cls in defined() for part in PARTS if part in cls.__dict__]
    classes = [*defined(), *parts]
    assert len(classes) > len(ALL)
    assert [type_name(cls) for cls in classes if not cls.__dict__.get("__doc__")] == []


def test_constants_are_those_of_ros() -> None:
    store = get_typestore(Stores.ROS2_JAZZY)
    known = [name for name in names("msg") if name in store.fielddefs]
    wrong = {}
    for name in known:
        found = find(name).__ros_constants__
        constants = {
            key: (kind.base, value[0] if kind.base == "byte" else value) for key, (kind, value) in found.items()
        }
        expected = {key: (kind.replace("octet", "byte"), value) for key, kind, value in store.fielddefs[name][0]}
        if constants != expected:
            wrong[name] = constants, expected
    assert wrong == {}
    assert len(known) > 150
    assert LaserScan.__ros_constants__ == {}
    assert NavSatStatus.STATUS_FIX == 0
    assert DiagnosticStatus.ERROR == b"\x02"


def test_constants_are_those_of_the_files() -> None:
    expected = {name: each for package in COMPUTED.values() for name, each in package["constants"].items()}
    parts = [part for each in defined() if type_name(each).split("/")[0] in COMPUTED for part in messages_in(each)]
    found = {type_name(part): {key: value for key, (_, value) in part.__ros_constants__.items()} for part in parts}
    assert {name: each for name, each in found.items() if each} == expected


def test_the_constants_of_test_msgs() -> None:
    values = {name: value for name, (_, value) in ros.msg.Constants.__ros_constants__.items()}
    assert values == {
        "BOOL_CONST": True,
        "BYTE_CONST": b"2",
        "CHAR_CONST": 100,
        "FLOAT32_CONST": 1.125,
        "FLOAT64_CONST": 1.125,
        "INT8_CONST": -50,
        "UINT8_CONST": 200,
        "INT16_CONST": -1000,
        "UINT16_CONST": 2000,
        "INT32_CONST": -30000,
        "UINT32_CONST": 60000,
        "INT64_CONST": -40000000,
        "UINT64_CONST": 50000000,
    }
    assert (ros.msg.Constants.BYTE_CONST, ros.msg.Strings.STRING_CONST) == (b"2", "Hello world!")


def test_the_defaults_of_test_msgs() -> None:
    assert [getattr(ros.msg.Defaults(), name) for name in ros.msg.Defaults.__ros_fields__] == [
        True, b"2", 100, 1.125, 1.125, -50, 200, -1000, 2000, -30000, 60000, -40000000, 50000000
    ]  # fmt: skip
    assert ros.msg.Strings().bounded_string_value_default5 == 'Hello"world!'
    assert ros.msg.Strings().string_value_default4 == "Hello'world!"
    assert ros.msg.WStrings().wstring_value_default3 == "ハローワールド"
    assert len(ros.msg.WStrings().array_of_wstrings) == 3


@pytest.mark.parametrize("cls", [ros.msg.Arrays, ros.msg.BoundedSequences, ros.msg.UnboundedSequences])
def test_defaults_of_sequences(cls: Any) -> None:
    message = cls()
    assert list(message.bool_values_default) == [False, True, False]
    assert list(message.byte_values_default) == [b"\0", b"\1", b"\xff"]
    assert list(message.int64_values_default) == [0, 2**63 - 1, -(2**63)]
    assert list(message.uint64_values_default) == [0, 1, 2**64 - 1]
    assert list(message.float32_values_default) == [1.125, 0.0, -1.125]
    assert list(message.string_values_default) == ["", "max value", "min value"]
    assert decode(cls, encode(message)) == message
    message.bool_values_default[0] = True
    assert cls().bool_values_default[0] is False


def test_a_uuid_takes_bytes() -> None:
    octets = bytes(range(16))
    assert UUID(uuid=octets) == UUID(uuid=list(octets))
    assert encode(UUID(uuid=octets))[4:] == octets
    with pytest.raises(EncodeError, match=r"UUID.uuid: expected uint8\[16\], got 15 elements"):
        encode(UUID(uuid=octets[1:]))


# ---- actions -------------------------------------------------------------------------------------------------------


class Fetch(Action):
    """An action of a user's own, in a node file."""

    class Goal(Message):
        """What to fetch."""

        name: string

    class Result(Message):
        """Whether it was there."""

        found: bool

    class Feedback(Message):
        """How far it is."""

        distance: float64


def test_the_names_of_an_actions_parts() -> None:
    impl = Fetch.Impl
    assert type_name(Fetch) == "test_interfaces/action/Fetch"
    parts = (
        Fetch.Goal,
        Fetch.Result,
        Fetch.Feedback,
        impl.SendGoalService,
        impl.GetResultService,
        impl.FeedbackMessage,
    )
    assert [type_name(part).removeprefix("test_interfaces/action/Fetch_") for part in parts] == [
        "Goal",
        "Result",
        "Feedback",
        "SendGoal",
        "GetResult",
        "FeedbackMessage",
    ]
    assert type_name(impl.SendGoalService.Request) == "test_interfaces/action/Fetch_SendGoal_Request"
    assert type_name(impl.GetResultService.Event) == "test_interfaces/action/Fetch_GetResult_Event"
    assert impl is Fetch.Impl


def test_what_an_action_sends() -> None:
    impl = Fetch.Impl
    fields = {
        part: list(part.__ros_fields__)
        for service in (impl.SendGoalService, impl.GetResultService)
        for part in (service.Request, service.Response)
    }
    assert list(fields.values()) == [["goal_id", "goal"], ["accepted", "stamp"], ["goal_id"], ["status", "result"]]
    goal_id = UUID(uuid=bytes(range(16)))
    request = impl.SendGoalService.Request(goal_id=goal_id, goal=Fetch.Goal(name="ball"))
    assert decode(impl.SendGoalService.Request, encode(request)) == request
    feedback = impl.FeedbackMessage(goal_id=goal_id, feedback=Fetch.Feedback(distance=2.0))
    assert decode(impl.FeedbackMessage, encode(feedback)).feedback.distance == 2.0
    assert (impl.CancelGoalService, impl.GoalStatusMessage) == (CancelGoal, GoalStatusArray)
    assert Fetch.Impl is not NavigateToPose.Impl


def test_an_action_is_described_as_rosidl_does() -> None:
    described = Fetch.describe()
    assert [(field.name, field.nested_type_name) for field in described.fields] == [
        ("goal", "test_interfaces/action/Fetch_Goal"),
        ("result", "test_interfaces/action/Fetch_Result"),
        ("feedback", "test_interfaces/action/Fetch_Feedback"),
        ("send_goal_service", "test_interfaces/action/Fetch_SendGoal"),
        ("get_result_service", "test_interfaces/action/Fetch_GetResult"),
        ("feedback_message", "test_interfaces/action/Fetch_FeedbackMessage"),
    ]
    referenced = [each.type_name for each in described.referenced]
    assert referenced == sorted(referenced)
    assert {
        "unique_identifier_msgs/msg/UUID",
        "service_msgs/msg/ServiceEventInfo",
        "test_interfaces/action/Fetch_SendGoal_Event",
    } < set(referenced)


def test_what_is_no_action() -> None:
    assert action_type(Fetch) is Fetch
    with pytest.raises(MessageError, match="is not an action class"):
        action_type(SetBool)
    with pytest.raises(MessageError, match="action Fetch needs a message class Result"):
        type("Fetch", (Action,), {"Goal": Fetch.Goal})
    with pytest.raises(
        MessageError, match=r"action Other: Goal must be a class inside it, got test_interfaces/action/Fetch_Goal"
    ):
        type("Other", (Action,), dict(vars(Fetch)))
