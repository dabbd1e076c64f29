"""Definitions that bags and views carry, read by rosbags."""

from __future__ import annotations

import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from robolink.bag.topic import SEPARATOR, message_definition
from robolink.interfaces import find, names
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.std_srvs.srv import SetBool

JAZZY = get_typestore(Stores.ROS2_JAZZY).fielddefs
NESTED = ("Pose", "Twist", "Point", "Quaternion", "Vector3")
PLACEHOLDER = "structure_needs_at_least_one_member"


def fields(definition: object) -> list[object]:
    """The fields as rosbags has them, without the one that it adds to empty messages."""
    return [each for each in definition[1] if each[0] != PLACEHOLDER]  # type: ignore[index]


@pytest.mark.slow
@pytest.mark.parametrize("name", names("msg"))
def test_rosbags_reads_the_same_types(name: str) -> None:
    read = get_types_from_msg(message_definition(find(name)), name)
    assert name in read
    for each, definition in read.items():
        if each in JAZZY:
            assert fields(definition) == fields(JAZZY[each]), each


def test_each_type_stands_there_once_in_the_order_of_use() -> None:
    text = message_definition(Odometry)
    heads = [line.removeprefix("MSG: ") for line in text.splitlines() if line.startswith("MSG: ")]
    assert heads[:3] == ["std_msgs/Header", "geometry_msgs/PoseWithCovariance", "geometry_msgs/TwistWithCovariance"]
    assert len(heads) == len(set(heads)) == text.count(SEPARATOR)
    assert set(heads[3:]) == {"builtin_interfaces/Time", *(f"geometry_msgs/{each}" for each in NESTED)}


def test_a_type_of_primitives_is_its_own_text() -> None:
    assert SEPARATOR not in message_definition(Time)
    assert message_definition(Time).endswith("\nint32 sec\nuint32 nanosec\n")


def test_events_of_a_service_have_its_request_and_response() -> None:
    read = get_types_from_msg(message_definition(SetBool.Event), "std_srvs/srv/SetBool_Event")
    assert {"SetBool_Request", "SetBool_Response", "ServiceEventInfo"} <= {each.rpartition("/")[2] for each in read}


def test_a_twist() -> None:
    assert f"Vector3 angular\n{SEPARATOR}\nMSG: geometry_msgs/Vector3\n" in message_definition(Twist)
