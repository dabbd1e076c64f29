"""Action server: accepts or rejects goals, executes them, and sends feedback and results."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING, Any

from robolink.action.server_entities import Executions, LateService, Results, run_to_its_end
from robolink.action.states import ACTIVE, Statuses, goals_to_cancel, next_status
from robolink.action.states import GoalEvent as GoalEvent
from robolink.callback_groups import CallbackGroup
from robolink.exceptions import (
    EncodeError,
    ExternalShutdownException,
    TransportClosedError,
    TransportError,
)
from robolink.exceptions import RCLError as RCLError
from robolink.graph import action_names as graph
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatus
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.message import Message, encode
from robolink.message import action_type as checked_action_type
from robolink.publisher import Publisher
from robolink.qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from robolink.running.entity import Entity, next_number
from robolink.service import RequestHeader
from robolink.text.tracebacks import formatted
from robolink.type_support import in_brackets
from robolink.waitable import Waitable

if TYPE_CHECKING:
    from robolink.clock import Clock
    from robolink.message import Action
    from robolink.node import BaseNode
    from robolink.service_introspection import ServiceIntrospectionState


class ServerGoalHandle:
    """Handle of an accepted goal on the server's side: its request, feedback and end. Usable from any thread.

    Once the server has been destroyed, or the goal's result has expired, its methods do nothing.
    """

    __class_getitem__ = in_brackets(3)

    def __init__(self, action_server: ActionServer, goal_info: GoalInfo, goal_request: Any) -> None:
        self._action_server = action_server
        self._goal_info = goal_info
        self._goal_request = goal_request
        self._status: int = GoalStatus.STATUS_ACCEPTED
        self._executed = False
        self._destroyed = False

    def __eq__(self, other: object) -> bool:
        return bool(self.goal_id == other.goal_id) if isinstance(other, ServerGoalHandle) else NotImplemented

    def __hash__(self) -> int:
        return hash(bytes(self.goal_id.uuid))

    @property
    def request(self) -> Any:
        """The goal: a message of the action's type ``Goal``."""
        return self._goal_request

    @property
    def goal_id(self) -> UUID:
        """Id that the client gave it."""
        return self._goal_info.goal_id

    @property
    def is_active(self) -> bool:
        """True until the goal has succeeded or was aborted or cancelled."""
        return self.status in ACTIVE

    @property
    def is_cancel_requested(self) -> bool:
        """True once the goal is to be cancelled: end it then, usually by `canceled`."""
        return self.status == GoalStatus.STATUS_CANCELING

    @property
    def status(self) -> int:
        """State, a code of action_msgs/msg/GoalStatus; STATUS_UNKNOWN once it is forgotten."""
        return GoalStatus.STATUS_UNKNOWN if self._destroyed else self._status

    def execute(self, execute_callback: Callable[[ServerGoalHandle], Any] | None = None) -> None:
        """Schedule the execution of the goal.

        Args:
            execute_callback: Called with this handle; None takes the server's.

        Raises:
            RCLError: if it was executed before.
        """
        with self._action_server._lock:
            if self._executed:
                raise RCLError("a goal can be executed once only")
            if not self.is_cancel_requested:  # the callback is called then too: it is what ends the goal
                self._update_state(GoalEvent.EXECUTE)
            self._executed = True
        self._action_server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: Any) -> None:
        """Send feedback to the client.

        Args:
            feedback: A message of the action's ``Feedback``.

        Raises:
            TypeError: if it is of another type.
        """
        expected = self._action_server.action_type.Feedback
        if not isinstance(feedback, expected):
            raise TypeError(f"Expected {expected}, got {type(feedback)}")
        with self._action_server._lock:
            if not self._destroyed:
                self._action_server._publish_feedback(self.goal_id, feedback)

    def succeed(self) -> None:
        """End the goal as reached. Raises RCLError unless it is executing or to be cancelled."""
        self._update_state(GoalEvent.SUCCEED)

    def abort(self) -> None:
        """End the goal as failed. Raises RCLError unless it is executing or to be cancelled."""
        self._update_state(GoalEvent.ABORT)

    def canceled(self) -> None:
        """End the goal as cancelled. Raises RCLError unless that was asked for."""
        self._update_state(GoalEvent.CANCELED)

    def _update_state(self, event: GoalEvent) -> None:
        server = self._action_server
        with server._lock:
            if self._destroyed:
                return
            self._status = next_status(self._status, event)
            server._note_status(self)
            if not (self.is_active or self._executed):
                server.notify_goal_done()

    def destroy(self) -> None:
        """Forget the goal: nothing more is published about it."""
        self._destroyed = True


class GoalResponse(Enum):
    """Return value of a goal callback."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """Return value of a cancel callback."""

    REJECT = 1
    ACCEPT = 2


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Execute each goal at once."""
    goal_handle.execute()


def default_goal_callback(goal_request: Any) -> GoalResponse:
    """Accept every goal."""
    return GoalResponse.ACCEPT


def default_cancel_callback(cancel_request: ServerGoalHandle) -> CancelResponse:
    """Reject every request to cancel."""
    return CancelResponse.REJECT


class ActionServer(Waitable):
    """Server of one action of a node.

    ``execute_callback(goal_handle)`` executes the goal, ends it by a method of the handle (`succeed`, `abort`,
    `canceled`) and returns the action's ``Result``. It may block while a MultiThreadedExecutor spins, or be a coroutine
    function. A goal whose callback raises, or returns without having ended it, is aborted.
    """

    __class_getitem__ = in_brackets(3)

    def __init__(
        self,
        node: BaseNode,
        action_type: type[Any],
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle], Any],
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: Callable[[Any], Any] | None = default_goal_callback,
        handle_accepted_callback: Callable[[ServerGoalHandle], Any] | None = default_handle_accepted_callback,
        cancel_callback: Callable[[ServerGoalHandle], Any] | None = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile = QoSProfile(depth=10),  # noqa: B008 - rclpy's
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = 10,
    ) -> None:
        """Create a server of an action.

        Args:
            node: BaseNode of the server; it must be spun.
            action_type: Class of the action, such as `example_interfaces.action.Fibonacci`.
            action_name: Name of the action; a relative one is resolved as the node's names are.
            execute_callback: Called with a goal handle for each goal to execute; may be a coroutine function. The
                executor runs it outside of all callback groups.
            callback_group: Group of the goal, accepted and cancel callbacks; the node's default group by default.
            goal_callback: Called with each new goal; returns a GoalResponse. By default, and with None, every goal is
                accepted.
            handle_accepted_callback: Called with the handle of each accepted goal, to execute it now or later. By
                default, and with None, it is executed at once.
            cancel_callback: Called with the handle of a goal that somebody wants to cancel; returns a CancelResponse.
                By default, and with None, every such request is rejected.
            goal_service_qos_profile: QoS of the service that receives goals.
            result_service_qos_profile: QoS of the service that sends results.
            cancel_service_qos_profile: QoS of the service that cancels goals.
            feedback_pub_qos_profile: QoS of the publisher of feedback; depth 10 by default.
            status_pub_qos_profile: QoS of the publisher of the goals' states.
            result_timeout: Time in seconds for which a result is kept after the goal's end; below 0 it is kept for
                ever.

        Raises:
            ValueError: if the name is not valid, or the class is not an action.
            TypeError: if `execute_callback` cannot be called.
        """
        super().__init__(callback_group or node._group_of_part_())
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        self._node, self._action_type = node, checked_action_type(action_type)
        self._action_name = node.resolve_topic_name(action_name)
        self._logger = node.get_logger().get_child("action_server")
        self._lock = threading.RLock()
        """Lock of the goals and their states."""
        self._goal_handles: dict[bytes, ServerGoalHandle] = {}
        self._encoded = Statuses()
        self._destroyed = False
        self._lane = next_number()
        self._executions = Executions(self._execute_goal)
        self._results = Results(self._answer_result, self._forget, result_timeout, self.callback_group, node)
        self._parts: list[Publisher[Any] | LateService] = []
        try:
            self._declare_topics(feedback_pub_qos_profile, status_pub_qos_profile)
            self._declare_services(result_service_qos_profile, cancel_service_qos_profile, goal_service_qos_profile)
        except BaseException:
            self.destroy()
            raise
        node.add_waitable(self)

    def _declare_topics(self, feedback: QoSProfile, status: QoSProfile) -> None:
        impl = self._action_type.Impl
        self._feedback = self._publisher(graph.FEEDBACK, impl.FeedbackMessage, feedback)
        self._status = self._publisher(graph.STATUS, impl.GoalStatusMessage, status)

    def _declare_services(self, result: QoSProfile, cancel: QoSProfile, goal: QoSProfile) -> None:
        impl = self._action_type.Impl
        self._result_service = self._service(graph.GET_RESULT, impl.GetResultService, self._on_get_result, result)
        self._cancel_service = self._service(graph.CANCEL_GOAL, impl.CancelGoalService, self._on_cancel, cancel)
        self._goal_service = self._service(graph.SEND_GOAL, impl.SendGoalService, self._on_goal, goal)

    def _publisher(self, part: str, msg_type: type[Message], qos: QoSProfile) -> Publisher[Any]:
        name = self._node.resolve_topic_name(graph.part_name(self._action_name, part))
        made = Publisher(self._node._owner_, msg_type, name, qos)
        self._parts.append(made)
        return made

    def _service(self, part: str, srv_type: type[Any], callback: Callable[..., Any], qos: QoSProfile) -> LateService:
        name = self._node.resolve_service_name(graph.part_name(self._action_name, part))
        made = LateService(self._node._owner_, srv_type, name, callback, self.callback_group, qos)
        made.lane = self._lane  # a goal comes before it is cancelled
        self._parts.append(made)
        return made

    def configure_introspection(
        self, clock: Clock, service_event_qos_profile: QoSProfile, introspection_state: ServiceIntrospectionState
    ) -> None:
        """Publish the requests and responses of the action's three services as events from now on, or no more.

        Args:
            clock: Clock of the events' stamps.
            service_event_qos_profile: Quality of service of the events.
            introspection_state: OFF, METADATA or CONTENTS.
        """
        for part in self._parts:
            if isinstance(part, LateService):
                part.configure_introspection(clock, service_event_qos_profile, introspection_state)

    @property
    def action_type(self) -> type[Action]:
        """Class of the action."""
        return self._action_type

    # Requests

    async def _on_goal(self, request: Any, header: RequestHeader) -> None:
        """Accept or reject a goal, answer, and hand it over then."""
        expected = bytes(request.goal_id.uuid) not in self._goal_handles and await self._is_requested(request.goal)
        handle = self._accept(request.goal_id, request.goal) if expected else None
        response: Any = self._action_type.Impl.SendGoalService.Response(accepted=handle is not None)
        if handle is not None:
            response.stamp = handle._goal_info.stamp
        self._answer(self._goal_service, response, header)
        if handle is not None:
            await run_to_its_end(self._handle_accepted_callback, handle)

    async def _is_requested(self, goal: Any) -> bool:
        response = await run_to_its_end(self._goal_callback, goal)
        if not isinstance(response, GoalResponse):
            self._logger.warning(
                f"{self._action_name}: a goal is rejected, since the goal callback returned {response!r:.80},"
                " which is not a GoalResponse"
            )
        return response is GoalResponse.ACCEPT

    def _accept(self, goal_id: UUID, goal: Any) -> ServerGoalHandle | None:
        """Register a goal; None if another one has its id, or the server has been destroyed meanwhile."""
        key = bytes(goal_id.uuid)
        with self._lock:
            if self._destroyed or key in self._goal_handles:
                return None
            stamp = self._node.get_clock().now().to_msg()
            handle = ServerGoalHandle(self, GoalInfo(goal_id=goal_id, stamp=stamp), goal)
            self._goal_handles[key] = handle
            self._encoded.put(handle._goal_info, handle.status)
            self._results.expect(key)
            self._publish_status()
        return handle

    async def _on_cancel(self, request: CancelGoal.Request, header: RequestHeader) -> None:
        with self._lock:
            code, meant = goals_to_cancel(request.goal_info, self._statuses())
        canceling = [each for each in meant if await self._cancel(bytes(each.goal_id.uuid))]
        response = CancelGoal.Response(return_code=code, goals_canceling=canceling)
        self._answer(self._cancel_service, response, header)

    async def _cancel(self, key: bytes) -> bool:
        """Cancel a goal if its callback agrees; True if it is being cancelled now."""
        handle = self._goal_handles.get(key)
        if handle is None or await run_to_its_end(self._cancel_callback, handle) is not CancelResponse.ACCEPT:
            return False
        try:
            handle._update_state(GoalEvent.CANCEL_GOAL)
        except RCLError:  # it ended while the callback was deciding
            return False
        return True

    async def _on_get_result(self, request: Any, header: RequestHeader) -> None:
        key = bytes(request.goal_id.uuid)
        if not self._results.ask(key, header):
            self._logger.warning(f"{self._action_name}: somebody wants the result of {key.hex()}: unknown, or expired")
            unknown = self._action_type.Impl.GetResultService.Response(status=GoalStatus.STATUS_UNKNOWN)
            self._answer_result(unknown, header)

    def _answer_result(self, response: Any, header: RequestHeader) -> None:
        self._answer(self._result_service, response, header)

    def _answer(self, service: LateService, response: Message, header: RequestHeader) -> None:
        try:
            service.send_response(response, header)
        except TransportError as error:
            self._logger.warning(f"{service.service_name}: could not answer: {error}")

    # Execution

    def notify_execute(
        self, goal_handle: ServerGoalHandle, execute_callback: Callable[[ServerGoalHandle], Any] | None
    ) -> None:
        """Schedule the execution of `goal_handle` with `execute_callback`; None takes the one that was registered."""
        self._executions.add(execute_callback or self._execute_callback, goal_handle)

    async def _execute_goal(self, callback: Callable[[ServerGoalHandle], Any], handle: ServerGoalHandle) -> None:
        """Run a goal's callback to its end, whatever comes; the goal has ended and has a result then."""
        try:
            result = await run_to_its_end(callback, handle)
        except (ExternalShutdownException, KeyboardInterrupt):  # Ctrl-C is not a fault of the callback
            self._end(handle, self._action_type.Result())
            raise
        except GeneratorExit:
            raise
        except Exception as error:  # noqa: BLE001 - the goal has failed, not the node
            self._logger.error(f"{self._named(handle)}: an exception in its execute callback\n{formatted(error)}")
            self._end(handle, self._action_type.Result())
        except BaseException:  # asyncio cancels it: the client is not to wait for ever
            self._end(handle, self._action_type.Result(), "its callback was cancelled")
            raise
        else:
            self._end(handle, self._checked(handle, result))

    def _checked(self, handle: ServerGoalHandle, result: Any) -> Message:
        """Return the result, or an empty one in place of another object: the client waits for something."""
        expected = self._action_type.Result
        try:
            if not isinstance(result, expected):
                raise TypeError(f"expected {expected.__name__}, got {result!r:.80}")
            encode(result)
        except (TypeError, EncodeError) as error:
            self._logger.error(f"{self._named(handle)}: its execute callback returned no result: {error}")
            return expected()
        return result

    def _end(
        self, handle: ServerGoalHandle, result: Message, reason: str = "its callback did not say how it ended"
    ) -> None:
        with self._lock:
            if handle.is_active:
                self._logger.warning(f"{self._named(handle)}: aborted, since {reason}")
                handle.abort()
        self._set_result(handle, result)

    def notify_goal_done(self) -> None:
        """Set an empty result for each goal that ended without having been executed."""
        for handle in list(self._goal_handles.values()):
            if not (handle.is_active or handle._executed):
                self._set_result(handle, self._action_type.Result())

    def _set_result(self, handle: ServerGoalHandle, result: Message) -> None:
        response = self._action_type.Impl.GetResultService.Response(status=handle.status, result=result)
        self._results.set(bytes(handle.goal_id.uuid), response)

    def _forget(self, key: bytes) -> None:
        """Remove a goal whose result has expired."""
        with self._lock:
            self._goal_handles.pop(key).destroy()
            self._encoded.drop(key)

    # Topics

    def _statuses(self) -> list[GoalStatus]:
        return [GoalStatus(goal_info=each._goal_info, status=each.status) for each in self._goal_handles.values()]

    def _publish_status(self) -> None:
        self._publish(self._status, self._encoded.message())

    def _note_status(self, handle: ServerGoalHandle) -> None:
        """Publish a goal's new state."""
        self._encoded.put(handle._goal_info, handle.status)
        self._publish_status()

    def _publish_feedback(self, goal_id: UUID, feedback: Message) -> None:
        message = self._action_type.Impl.FeedbackMessage(goal_id=goal_id, feedback=feedback)
        self._publish(self._feedback, message)

    def _publish(self, publisher: Publisher[Any], message: Message | bytes) -> None:
        with contextlib.suppress(TransportClosedError):  # the context ends just now
            publisher.publish(message)

    def _named(self, handle: ServerGoalHandle) -> str:
        return f"{self._action_name}: goal {bytes(handle.goal_id.uuid).hex()}"

    # Callbacks

    def register_handle_accepted_callback(self, handle_accepted_callback: Callable[..., Any] | None) -> None:
        """Set `handle_accepted_callback`, called with each accepted goal's handle; None executes it at once."""
        self._handle_accepted_callback = handle_accepted_callback or default_handle_accepted_callback

    def register_goal_callback(self, goal_callback: Callable[..., Any] | None) -> None:
        """Set `goal_callback`, which is called with each goal and returns a GoalResponse; None accepts every goal."""
        self._goal_callback = goal_callback or default_goal_callback

    def register_cancel_callback(self, cancel_callback: Callable[..., Any] | None) -> None:
        """Set `cancel_callback`, called with a goal's handle, which returns a CancelResponse; None rejects always."""
        self._cancel_callback = cancel_callback or default_cancel_callback

    def register_execute_callback(self, execute_callback: Callable[..., Any]) -> None:
        """Set `execute_callback`, which executes goals from now on. Raises TypeError if it cannot be called."""
        if not callable(execute_callback):
            raise TypeError(f"the execute callback must be callable, got {execute_callback!r:.80}")
        self._execute_callback = execute_callback

    # Called by the node and the executor

    def entities(self) -> list[Entity]:
        """Return the entities that an executor runs."""
        services = [each for each in self._parts if isinstance(each, LateService)]
        return [*services, self._executions, self._results.timer]

    def interfaces(self) -> list[type[Any]]:
        """Return the message and service classes that the action is made of."""
        return [getattr(self._action_type.Impl, each) for each in self._action_type.Impl.__struct_fields__]

    def destroy(self) -> None:
        """Destroy the server: goals are forgotten, and whoever waits for a result learns that none comes."""
        with self._lock:
            self._destroyed = True
            for handle in self._goal_handles.values():
                handle.destroy()
        self._results.close()
        for part in self._parts:
            part.destroy()
        self._node.remove_waitable(self)
