"""The base class of action types: a goal, a result and a feedback message.

class Fibonacci(Action):
    class Goal(Message):
        order: int32

    class Result(Message):
        sequence: Sequence[int32]

    class Feedback(Message):
        partial_sequence: Sequence[int32]
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import msgspec

from robolink.exceptions import MessageError
from robolink.message.annotations import boolean, int8
from robolink.message.base import Message, MessageMeta
from robolink.message.description import TypeDescription, combine
from robolink.message.service import Service, name_part

PARTS = ("Goal", "Result", "Feedback")
"""Names of the three message classes of an action."""


class ActionImpl(msgspec.Struct, frozen=True):
    """Services and topics that an action is made of, by rclpy's names."""

    SendGoalService: type[Service]
    """Request: goal_id (UUID) and goal. Response: accepted, and stamp, its time."""
    GetResultService: type[Service]
    """Request: goal_id. Response: status, a code of action_msgs/msg/GoalStatus, and result."""
    FeedbackMessage: type[Message]
    """Message of goal_id and feedback."""
    CancelGoalService: type[Service]
    """Service action_msgs/srv/CancelGoal, the same for all actions."""
    GoalStatusMessage: type[Message]
    """Message action_msgs/msg/GoalStatusArray, the same for all actions."""


class _ImplOfAction:
    """Descriptor of `Fibonacci.Impl`, made when it is first asked for: it needs types of the packages above."""

    def __get__(self, _: object, owner: type[Action]) -> ActionImpl:
        if "_impl" not in owner.__dict__:
            owner._impl = _impl(owner)
        return owner._impl


def _impl(action: type[Action]) -> ActionImpl:
    from robolink.interfaces.action_msgs.msg import GoalStatusArray
    from robolink.interfaces.action_msgs.srv import CancelGoal
    from robolink.interfaces.builtin_interfaces.msg import Time
    from robolink.interfaces.unique_identifier_msgs.msg import UUID

    send_goal_request: dict[str, Any] = {"goal_id": UUID, "goal": action.Goal}
    get_result_response: dict[str, Any] = {"status": int8, "result": action.Result}
    return ActionImpl(
        SendGoalService=_service(action, "SendGoal", send_goal_request, {"accepted": boolean, "stamp": Time}),
        GetResultService=_service(action, "GetResult", {"goal_id": UUID}, get_result_response),
        FeedbackMessage=_message(action, "FeedbackMessage", {"goal_id": UUID, "feedback": action.Feedback}),
        CancelGoalService=CancelGoal,
        GoalStatusMessage=GoalStatusArray,
    )


def _service(action: type[Action], name: str, request: dict[str, Any], response: dict[str, Any]) -> type[Service]:
    body = {
        "__module__": action.__module__,
        "__qualname__": f"{action.__qualname__}.Impl.{name}Service",
        "__doc__": f"The {name} service of the action {action.__name__}.",
        "__ros_action__": action,
        "Request": _message(action, f"{name}_Request", request),
        "Response": _message(action, f"{name}_Response", response),
    }
    return type(f"{action.__name__}_{name}", (Service,), body)


def _message(action: type[Action], name: str, annotations: dict[str, Any]) -> type[Message]:
    body = {
        "__module__": action.__module__,
        "__qualname__": f"{action.__qualname__}.Impl.{name}",
        "__doc__": f"{name} of the action {action.__name__}.",
        "__annotations__": annotations,
    }
    made: type[Message] = MessageMeta(
        f"{action.__name__}_{name}", (Message,), body, type_name=f"{action.__ros_type__}_{name}"
    )
    return made


class Action:
    """Base class of action types; a subclass has the message classes `Goal`, `Result` and `Feedback`."""

    __ros_type__: ClassVar[str]
    _impl: ClassVar[ActionImpl]

    if TYPE_CHECKING:

        class Goal(Message):
            """Goal of a client."""

        class Result(Message):
            """Result of a goal."""

        class Feedback(Message):
            """Progress of a goal."""

        Impl: ClassVar[ActionImpl]
    else:
        Impl = _ImplOfAction()

    def __init_subclass__(cls) -> None:
        for part in PARTS:
            found: Any = cls.__dict__.get(part)
            if not hasattr(found, "__ros_fields__"):
                raise MessageError(f"action {cls.__name__} needs a message class {part}")
            if not found.__ros_type__.endswith(f"{cls.__name__}_{part}"):
                raise MessageError(f"action {cls.__name__}: {part} must be a class inside it, got {found.__ros_type__}")
        cls.__ros_type__ = cls.Goal.__ros_type__.removesuffix("_Goal").replace("/msg/", "/action/")
        for part in PARTS:
            name_part(cls, cls.__dict__[part], part)

    def __new__(cls) -> Any:  # NoReturn would make a type checker take the class for a function
        """Refuse to make one: an action is its three messages, and rclpy's class cannot be instantiated either."""
        raise NotImplementedError(f"an action cannot be instantiated: make a {cls.__name__}.Goal()")

    @classmethod
    def describe(cls) -> TypeDescription:
        """Return the description of the action as rosidl has it: three messages, two services, the feedback message."""
        parts: dict[str, Any] = {
            "goal": cls.Goal,
            "result": cls.Result,
            "feedback": cls.Feedback,
            "send_goal_service": cls.Impl.SendGoalService,
            "get_result_service": cls.Impl.GetResultService,
            "feedback_message": cls.Impl.FeedbackMessage,
        }
        return combine(cls.__ros_type__, parts)


def action_type(cls: Any) -> type[Action]:
    """Return `cls` if it is an action class. Raises MessageError otherwise."""
    if isinstance(cls, type) and issubclass(cls, Action):
        return cls
    raise MessageError(f"{cls!r} is not an action class")
