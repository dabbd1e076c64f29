"""What message classes say of their fields in rosidl's words."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import pytest

from robolink.interfaces.geometry_msgs.msg import PoseWithCovariance, Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.message import Message
from robolink.message.slot_types import (
    AbstractNestableType,
    AbstractNestedType,
    AbstractSequence,
    AbstractString,
    Array,
    BasicType,
    BoundedSequence,
    BoundedString,
    NamespacedType,
    UnboundedSequence,
    UnboundedString,
    UnboundedWString,
)
from tests.support.ros_test_types import msg as ros


def slots(of: Any) -> tuple[str, ...]:
    found: tuple[str, ...] = of.__slots__
    return found


def test_a_field_s_type_is_one_word_of_rosidl_s() -> None:
    assert PoseWithCovariance.get_fields_and_field_types() == {
        "pose": "geometry_msgs/Pose",
        "covariance": "double[36]",
    }
    assert LaserScan.get_fields_and_field_types()["ranges"] == "sequence<float>"
    assert ros.BasicTypes.get_fields_and_field_types()["bool_value"] == "boolean"
    assert ros.BasicTypes.get_fields_and_field_types()["byte_value"] == "octet"
    assert ros.BasicTypes.get_fields_and_field_types()["char_value"] == "uint8"
    assert ros.Strings.get_fields_and_field_types()["bounded_string_value"] == "string<22>"
    assert ros.BoundedSequences.get_fields_and_field_types()["int32_values"] == "sequence<int32, 3>"


def test_each_slot_has_an_object() -> None:
    assert (
        NamespacedType(("geometry_msgs", "msg"), "Pose"),
        Array(BasicType("double"), 36),
    ) == PoseWithCovariance.SLOT_TYPES
    assert PoseWithCovariance().SLOT_TYPES[0].namespaced_name() == ("geometry_msgs", "msg", "Pose")
    ranges = dict(zip(slots(LaserScan), LaserScan.SLOT_TYPES, strict=True))["_ranges"]
    assert ranges == UnboundedSequence(BasicType("float"))
    assert {UnboundedString(), BoundedString(22)} == set(ros.Strings.SLOT_TYPES)
    assert UnboundedWString() in ros.WStrings.SLOT_TYPES
    assert BoundedSequence(UnboundedString(), 3) in ros.BoundedSequences.SLOT_TYPES


def test_the_slots_name_the_fields_in_order_and_can_be_looked_up() -> None:
    twist = Twist()
    twist.linear.x = 0.3
    assert slots(Twist) == ("_linear", "_angular")
    assert [getattr(twist, slot) for slot in slots(twist)] == [twist.linear, twist.angular]
    assert [slot[1:] for slot in slots(twist)] == list(twist.get_fields_and_field_types())


def test_a_slot_of_numbers_has_the_array() -> None:
    scan = LaserScan(ranges=[1.0, 2.0])
    assert getattr(scan, "_ranges") is scan.ranges  # noqa: B009 - mypy would see it


class Guarded(Message):
    """A message with a method that is named as the slot of a field would be."""

    speed: float

    def _speed(self) -> float:
        return abs(self.speed)


def test_a_method_of_the_class_s_own_stays() -> None:
    assert Guarded(speed=-2.0)._speed() == 2.0


@pytest.mark.parametrize("name", ["liner", "_liner", "w"])
def test_a_field_that_is_not_there_is_refused_as_in_rclpy(name: str) -> None:
    assert not hasattr(Twist(), name)
    with pytest.raises(AttributeError, match=f"'Twist' object has no attribute '{name}'"):
        getattr(Twist(), name)


def test_messages_are_still_copied_and_pickled() -> None:
    twist = Twist()
    twist.angular.z = -1.0
    assert pickle.loads(pickle.dumps(twist)) == copy.deepcopy(twist) == copy.copy(twist) == twist


def test_kinds_of_types_are_told_by_rosidls_base_classes() -> None:
    number, text, word = BasicType("double"), UnboundedString(), BoundedString(5)
    few, three, many = BoundedSequence(number, 3), Array(number, 3), UnboundedSequence(text)
    message = NamespacedType(("geometry_msgs", "msg"), "Pose")
    assert all(isinstance(each, AbstractNestableType) for each in (number, text, word, message))
    assert all(isinstance(each, AbstractNestedType) for each in (few, three, many))
    assert [isinstance(each, AbstractSequence) for each in (few, three, many)] == [True, False, True]
    assert [isinstance(each, AbstractString) for each in (text, UnboundedWString())] == [True, False]
    bounded = [each.has_maximum_size() for each in (number, text, word, few, three, many)]
    assert bounded == [False, False, True, True, True, False]
