"""Attributes of message classes that programs read, as rosidl's classes have them."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import pytest

from robolink.interfaces import find
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.geometry_msgs.msg import PoseWithCovariance, Quaternion, Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import NavSatStatus
from robolink.interfaces.std_msgs.msg import Empty, String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import Action, Message, Service
from tests.support.ros_test_types import msg as ros


def test_the_fields_are_known_by_rosidls_private_name_too() -> None:
    cls: Any = PoseWithCovariance
    assert cls._fields_and_field_types == {"pose": "geometry_msgs/Pose", "covariance": "double[36]"}
    assert cls()._fields_and_field_types == cls.get_fields_and_field_types()


def test_a_change_of_the_fields_that_a_program_got_changes_no_class() -> None:
    Twist.get_fields_and_field_types().clear()
    assert list(Twist.get_fields_and_field_types()) == ["linear", "angular"]


def test_an_events_fields_are_the_parts_of_the_service() -> None:
    assert SetBool.Event.get_fields_and_field_types() == {
        "info": "service_msgs/ServiceEventInfo",
        "request": "sequence<std_srvs/SetBool_Request, 1>",
        "response": "sequence<std_srvs/SetBool_Response, 1>",
    }
    goal = Fibonacci.Impl.SendGoalService.Request.get_fields_and_field_types()
    assert goal == {"goal_id": "unique_identifier_msgs/UUID", "goal": "example_interfaces/Fibonacci_Goal"}


def test_defaults_are_attributes() -> None:
    quaternion: Any = Quaternion
    assert (quaternion.W__DEFAULT, quaternion().X__DEFAULT) == (1.0, 0.0)
    assert [name for name in dir(NavSatStatus) if name.endswith("__DEFAULT")] == ["STATUS__DEFAULT"]
    assert not hasattr(Twist, "LINEAR__DEFAULT")


def test_a_default_that_can_be_changed_is_a_new_one_each_time() -> None:
    arrays: Any = ros.UnboundedSequences
    arrays.INT32_VALUES_DEFAULT__DEFAULT.append(5)
    assert ros.UnboundedSequences().int32_values_default == arrays.INT32_VALUES_DEFAULT__DEFAULT


@pytest.mark.parametrize(
    ("cls", "name"),
    [
        (SetBool.Request, "SetBool_Request"),
        (SetBool.Response, "SetBool_Response"),
        (SetBool.Event, "SetBool_Event"),
        (Fibonacci.Goal, "Fibonacci_Goal"),
        (Fibonacci.Impl.FeedbackMessage, "Fibonacci_FeedbackMessage"),
        (Fibonacci.Impl.SendGoalService, "Fibonacci_SendGoal"),
        (Fibonacci.Impl.SendGoalService.Request, "Fibonacci_SendGoal_Request"),
        (Twist, "Twist"),
    ],
)
def test_classes_have_rosidls_names(cls: type[Any], name: str) -> None:
    assert cls.__name__ == name


@pytest.mark.parametrize("cls", [SetBool, Fibonacci, Fibonacci.Impl.GetResultService])
def test_a_service_or_an_action_cannot_be_instantiated(cls: type[Service] | type[Action]) -> None:
    with pytest.raises(NotImplementedError, match=rf"make a {cls.__name__}\.(Request|Goal)\(\)"):
        cls()


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: find("String")("x"), r"std_msgs/msg/String takes its fields by name: String\(data=\.\.\.\)"),
        (lambda: find("Empty")(1), "std_msgs/msg/Empty takes its fields by name: it has none"),
        (lambda: find("String")(Data="x"), r"Unexpected keyword argument 'Data'\. Did you mean: 'data'\?"),
        (lambda: find("Twist")(w=1.0), r"Unexpected keyword argument 'w' \(only linear, angular\)"),
    ],
)
def test_a_message_is_made_of_its_fields_by_name(make: Any, text: str) -> None:
    with pytest.raises(TypeError, match=text):
        make()


class Talking(Vector3):
    """A message with a method."""

    def say(self) -> str:
        """Return a text."""
        return f"{self.x}"


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda each: pickle.loads(pickle.dumps(each))])
@pytest.mark.parametrize(
    "message",
    [String(data="x"), Empty(), Twist(linear=Vector3(x=1.0)), PoseWithCovariance(), SetBool.Request(), Talking(x=2.0)],
)
def test_messages_are_copied_and_pickled(message: Message, copied: Any) -> None:
    found = copied(message)
    assert type(found) is type(message)
    assert found == message
    assert found is not message
