"""Action client: sends goals, receives feedback, cancels goals, and receives results."""

from __future__ import annotations

import math
import uuid
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.action.states import ENDED
from robolink.callback_groups import CallbackGroup
from robolink.client import Client
from robolink.exceptions import ServiceError
from robolink.graph import action_names as graph
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatusArray
from robolink.interfaces.action_msgs.msg import GoalStatus as GoalStatus
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.message import action_type as checked_action_type
from robolink.qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from robolink.running.entity import Entity, next_number
from robolink.subscription import MessageInfo, Subscription
from robolink.task import Future
from robolink.type_support import in_brackets
from robolink.waitable import Waitable

if TYPE_CHECKING:
    from robolink.clock import Clock
    from robolink.message import Action, Message
    from robolink.node import BaseNode
    from robolink.service_introspection import ServiceIntrospectionState


class ClientGoalHandle:
    """Handle of a goal on the client's side; made by `ActionClient.send_goal_async`."""

    __class_getitem__ = in_brackets(3)

    def __init__(self, action_client: ActionClient, goal_id: UUID, goal_response: Any) -> None:
        self._action_client = action_client
        self._goal_id = goal_id
        self._goal_response = goal_response
        self._status: int = GoalStatus.STATUS_ACCEPTED if goal_response.accepted else GoalStatus.STATUS_UNKNOWN

    def __eq__(self, other: object) -> bool:
        return bool(self._goal_id == other._goal_id) if isinstance(other, ClientGoalHandle) else NotImplemented

    def __hash__(self) -> int:
        return hash(key_of(self._goal_id))

    def __repr__(self) -> str:
        return f"ClientGoalHandle <id={key_of(self._goal_id).hex()}, accepted={self.accepted}, status={self.status}>"

    @property
    def goal_id(self) -> UUID:
        """Id that the goal was sent with."""
        return self._goal_id

    @property
    def stamp(self) -> Time:
        """Time at which the server accepted it, by the server's clock."""
        stamp: Time = self._goal_response.stamp
        return stamp

    @property
    def accepted(self) -> bool:
        """True if the server accepted it."""
        return bool(self._goal_response.accepted)

    @property
    def status(self) -> int:
        """The state last received from the server, a code of action_msgs/msg/GoalStatus."""
        return self._status

    def cancel_goal(self) -> CancelGoal.Response:
        """Ask the server to cancel the goal, and return its response. Raises what `Client.call` raises."""
        return self._action_client._cancel_goal(self)

    def cancel_goal_async(self) -> Future[CancelGoal.Response]:
        """Ask the server to cancel the goal; the returned future gets its response, or a ServiceError."""
        return self._action_client._cancel_goal_async(self)

    def get_result(self) -> Any:
        """Wait for the goal's end, and return ``status`` and ``result``. Raises what `Client.call` raises."""
        return self._action_client._get_result(self)

    def get_result_async(self) -> Future[Any]:
        """Return a future of a response with ``status`` and ``result``, done when the goal has ended.

        It fails with ServiceError (a RuntimeError) if the server goes away before.
        """
        return self._action_client._get_result_async(self)


def key_of(goal_id: UUID) -> bytes:
    """Return an id as a key of a table."""
    return bytes(goal_id.uuid)


LATELY = 16
"""Upper bound of the ended goals whose feedback callbacks are kept, for feedback that was sent before the end."""


class ActionClient(Waitable):
    """Client of one action."""

    __class_getitem__ = in_brackets(3)

    def __init__(
        self,
        node: BaseNode,
        action_type: type[Any],
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile = QoSProfile(depth=10),  # noqa: B008 - rclpy's
        status_sub_qos_profile: QoSProfile = qos_profile_action_status_default,
        enable_feedback_msg_optimization: bool = False,
    ) -> None:
        """Create a client of an action.

        Args:
            node: BaseNode of the client; it must be spun for anything to arrive.
            action_type: Class of the action, such as `example_interfaces.action.Fibonacci`.
            action_name: Name of the action; a relative one is resolved as the node's names are.
            callback_group: Group of the feedback callbacks; the node's default group by default. Responses come
                whatever the groups do.
            goal_service_qos_profile: QoS of the client that sends goals.
            result_service_qos_profile: QoS of the client that asks for results.
            cancel_service_qos_profile: QoS of the client that cancels goals.
            feedback_sub_qos_profile: QoS of the subscription to feedback; depth 10 by default.
            status_sub_qos_profile: QoS of the subscription to the goals' states.
            enable_feedback_msg_optimization: Lyrical's, which lets the network leave out feedback of other clients'
                goals. It has no effect: that is left out here, after it has come.

        Raises:
            ValueError: if the name is not valid, or the class is not an action.
        """
        super().__init__(callback_group or node._group_of_part_())
        self._node, self._action_type = node, checked_action_type(action_type)
        self._action_name = node.resolve_topic_name(action_name)
        self._logger = node.get_logger().get_child("action_client")
        self._goal_handles: weakref.WeakValueDictionary[bytes, ClientGoalHandle] = weakref.WeakValueDictionary()
        self._feedback_callbacks: dict[bytes, Callable[[Any], Any]] = {}
        self._lately_ended: dict[bytes, int] = {}  # and when they did, in nanoseconds
        self._statuses: dict[bytes, int] = {}
        self._lane = next_number()
        self._parts: list[Client | Subscription[Any]] = []
        self._open_futures: dict[Future[Any], None] = {}
        """Futures that are not done."""
        try:
            self._declare_topics(feedback_sub_qos_profile, status_sub_qos_profile)
            self._declare_clients(result_service_qos_profile, cancel_service_qos_profile, goal_service_qos_profile)
        except BaseException:
            self.destroy()
            raise
        # In virtual time from the client's gid, so that runs repeat.
        self._random = node.context.time.random_ids(self._goal_client._endpoint.gid)
        node.add_waitable(self)

    def _declare_topics(self, feedback: QoSProfile, status: QoSProfile) -> None:
        impl = self._action_type.Impl
        self._subscription(graph.STATUS, impl.GoalStatusMessage, self._on_status, status)
        self._feedback = self._subscription(graph.FEEDBACK, impl.FeedbackMessage, self._on_feedback, feedback)

    def _declare_clients(self, result: QoSProfile, cancel: QoSProfile, goal: QoSProfile) -> None:
        impl = self._action_type.Impl
        self._result_client = self._client(graph.GET_RESULT, impl.GetResultService, result)
        self._cancel_client = self._client(graph.CANCEL_GOAL, impl.CancelGoalService, cancel)
        self._goal_client = self._client(graph.SEND_GOAL, impl.SendGoalService, goal)

    def _subscription(
        self, part: str, msg_type: type[Message], callback: Callable[..., Any], qos: QoSProfile
    ) -> Subscription[Any]:
        name = self._node.resolve_topic_name(graph.part_name(self._action_name, part))
        made = Subscription(self._node._owner_, msg_type, name, callback, self.callback_group, qos)
        made.serves = True  # feedback goes on while a callback waits for a result
        made.lane = self._lane
        self._parts.append(made)
        return made

    def _client(self, part: str, srv_type: type[Any], qos: QoSProfile) -> Client:
        name = self._node.resolve_service_name(graph.part_name(self._action_name, part))
        made = Client(self._node._owner_, srv_type, name, qos, self.callback_group)
        made.lane = self._lane  # a goal is accepted before its feedback comes, and that comes before its result
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
            if isinstance(part, Client):
                part.configure_introspection(clock, service_event_qos_profile, introspection_state)

    @property
    def action_type(self) -> type[Action]:
        """Class of the action."""
        return self._action_type

    # Goals

    def send_goal(self, goal: Any, **kwargs: Any) -> Any:
        """Send a goal and wait until it has ended.

        A callback may call this: services, clients and feedback go on meanwhile.

        Args:
            goal: The goal, a message of the action's ``Goal``.
            kwargs: `feedback_callback` and `goal_uuid`, as for `send_goal_async`.

        Returns:
            A response with ``status`` (a code of action_msgs/msg/GoalStatus) and ``result``; the status is
            STATUS_UNKNOWN if the server rejected the goal.

        Raises:
            TypeError: if `goal` or the id is of another type.
            ServiceError: (a RuntimeError) if nobody serves the action, the server goes away, or only a callback that
                this very call blocks could answer.
        """
        request = self._request(goal, **kwargs)
        try:
            handle = self._handle(request.goal_id, self._goal_client.call(request))
            if handle.accepted:
                return self._get_result(handle)
            return self._action_type.Impl.GetResultService.Response(status=GoalStatus.STATUS_UNKNOWN)
        finally:
            self._stop_feedback(request.goal_id)

    def send_goal_async(
        self, goal: Any, feedback_callback: Callable[[Any], Any] | None = None, goal_uuid: UUID | None = None
    ) -> Future[ClientGoalHandle]:
        """Send a goal without waiting.

        A goal that is sent while there is no server is lost, and its future stays open, as in rclpy: call
        `wait_for_server` before.

        Args:
            goal: The goal, a message of the action's ``Goal``.
            feedback_callback: Called with each feedback message; its field ``feedback`` has the action's ``Feedback``.
            goal_uuid: Id of the goal; random by default.

        Returns:
            A future of the goal's handle, done when a server has accepted or rejected the goal. It fails with
            ServiceError (a RuntimeError) if the server goes away before.

        Raises:
            TypeError: if `goal` or `goal_uuid` is of another type.
        """
        request = self._request(goal, feedback_callback, goal_uuid)
        failed = self._not_answered if self.server_is_ready() else self._not_served

        def on_failure(error: BaseException) -> ServiceError | None:
            self._feedback_callbacks.pop(key_of(request.goal_id), None)
            return failed(error)

        return self._ask(self._goal_client, request, lambda answer: self._handle(request.goal_id, answer), on_failure)

    def _request(
        self, goal: Any, feedback_callback: Callable[[Any], Any] | None = None, goal_uuid: UUID | None = None
    ) -> Any:
        if not isinstance(goal, self._action_type.Goal):
            raise TypeError(f"Expected {self._action_type.Goal}, got {type(goal)}")
        if goal_uuid is None:
            goal_uuid = UUID(uuid=list(uuid.UUID(int=self._random.getrandbits(128), version=4).bytes))
        elif not isinstance(goal_uuid, UUID):
            raise TypeError(f"goal_uuid: expected a unique_identifier_msgs.msg.UUID, got {goal_uuid!r:.80}")
        if feedback_callback is not None:
            key = key_of(goal_uuid)
            self._feedback_callbacks[key] = feedback_callback
            self._lately_ended.pop(key, None)
        request: Any = self._action_type.Impl.SendGoalService.Request
        return request(goal_id=goal_uuid, goal=goal)

    def _handle(self, goal_id: UUID, response: Any) -> ClientGoalHandle:
        """Return the handle of a goal that was answered. Raises RuntimeError if there is another of its id."""
        key, handle = key_of(goal_id), ClientGoalHandle(self, goal_id, response)
        if not handle.accepted:
            self._feedback_callbacks.pop(key, None)
            return handle
        handle._status = self._statuses.get(key, handle._status)
        if self._goal_handles.setdefault(key, handle) is not handle:
            raise RuntimeError(f"{self._action_name}: the server took a goal whose id another one still has: {handle}")
        return handle

    def _not_answered(self, error: BaseException) -> ServiceError:
        return ServiceError(f"action {self._action_name}: the goal was not answered: {error}")

    def _not_served(self, error: BaseException) -> None:
        self._logger.warning(
            f"{self._action_name}: nobody serves this action: the goal went nowhere, and its future stays open;"
            " call wait_for_server() before sending one"
        )

    def _cancel_goal(self, goal_handle: ClientGoalHandle) -> CancelGoal.Response:
        response: CancelGoal.Response = self._cancel_client.call(_cancel_request(goal_handle))
        return response

    def _cancel_goal_async(self, goal_handle: ClientGoalHandle) -> Future[CancelGoal.Response]:
        def failed(error: BaseException) -> ServiceError:
            return ServiceError(f"{self._named(goal_handle)}: no answer to the wish to cancel it: {error}")

        return self._ask(self._cancel_client, _cancel_request(goal_handle), lambda answer: answer, failed)

    def _get_result(self, goal_handle: ClientGoalHandle) -> Any:
        try:
            return self._ended(goal_handle, self._result_client.call(self._result_request(goal_handle)))
        finally:
            self._stop_feedback(goal_handle.goal_id)

    def _get_result_async(self, goal_handle: ClientGoalHandle) -> Future[Any]:
        def ended(answer: Any) -> Any:
            self._stop_feedback(goal_handle.goal_id)
            return self._ended(goal_handle, answer)

        def failed(error: BaseException) -> ServiceError:
            self._feedback_callbacks.pop(key_of(goal_handle.goal_id), None)
            goal_handle._status = GoalStatus.STATUS_UNKNOWN
            return ServiceError(f"{self._named(goal_handle)}: no result: {error}")

        return self._ask(self._result_client, self._result_request(goal_handle), ended, failed)

    def _result_request(self, goal_handle: ClientGoalHandle) -> Any:
        _check_handle(goal_handle)
        request: Any = self._action_type.Impl.GetResultService.Request
        return request(goal_id=goal_handle.goal_id)

    def _ended(self, goal_handle: ClientGoalHandle, answer: Any) -> Any:
        goal_handle._status = answer.status
        self._goal_handles.pop(key_of(goal_handle.goal_id), None)
        return answer

    def _ask(
        self,
        client: Client,
        request: Message,
        answered: Callable[[Any], Any],
        failed: Callable[[BaseException], BaseException | None],
    ) -> Future[Any]:
        """Call a service; the future gets ``answered(response)``, or ``failed(error)``, or nothing if that is None."""
        response = client.try_call_async(request)
        future: Future[Any] = Future(executor=self._node._loop_)

        def pass_on() -> None:
            self._open_futures.pop(future, None)
            if future.over():
                return
            future.set_executor(self._node._loop_)  # there may not have been one before
            error = response.exception()
            if error is None:
                _complete(future, answered, response.result())
            elif (reason := failed(error)) is not None:
                future.set_exception(reason)

        def give_up() -> None:
            self._open_futures.pop(future, None)
            if future.cancelled():
                client.remove_pending_request(response)

        self._open_futures[future] = None
        response.when_done(pass_on)
        future.when_done(give_up)
        return future

    def _named(self, goal_handle: ClientGoalHandle) -> str:
        return f"action {self._action_name}, goal {key_of(goal_handle.goal_id).hex()}"

    # Messages of servers

    def _on_feedback(self, message: Any, info: MessageInfo) -> Any:
        """Call the callback of the feedback's goal; return its coroutine, if it is one."""
        key = key_of(message.goal_id)
        callback = self._feedback_callbacks.get(key)
        if callback is None or info["source_timestamp"] > self._lately_ended.get(key, math.inf):
            return None
        return callback(message)

    def _on_status(self, message: GoalStatusArray) -> None:
        self._statuses = {key_of(each.goal_info.goal_id): each.status for each in message.status_list}
        for key, status in self._statuses.items():
            handle = self._goal_handles.get(key)
            if handle is not None:
                handle._status = status
                if status in ENDED:
                    self._goal_handles.pop(key, None)

    def _stop_feedback(self, goal_id: UUID) -> None:
        """Drop a feedback callback, though not at once: what was sent before the result may still wait its turn."""
        key = key_of(goal_id)
        if key in self._feedback_callbacks and key not in self._lately_ended:
            self._lately_ended[key] = self._node.context.time.now()
            if len(self._lately_ended) > LATELY:
                oldest = next(iter(self._lately_ended))
                for each in (self._lately_ended, self._feedback_callbacks):
                    each.pop(oldest, None)

    # Discovery of servers

    def server_is_ready(self) -> bool:
        """True if there is a server of this action and type, with all of its five topics and services."""
        clients = (each for each in self._parts if isinstance(each, Client))
        topics = (each for each in self._parts if isinstance(each, Subscription))
        return all(each.service_is_ready() for each in clients) and all(each.get_publisher_count() for each in topics)

    def wait_for_server(self, timeout_sec: float | None = None) -> Any:
        """Wait until there is a server; of an AsyncNode it is awaited: `await client.wait_for_server()`.

        Args:
            timeout_sec: Longest wait in seconds; None waits until the context ends.

        Returns:
            True if there is a server, False after the timeout or at the context's end.
        """
        return self._node._wait_until_(self.server_is_ready, timeout_sec)

    # Called by the node and the executor

    def entities(self) -> list[Entity]:
        """Return the entities that an executor runs."""
        return [*self._parts]

    def interfaces(self) -> list[type[Any]]:
        """Return the message and service classes that the action is made of."""
        return [getattr(self._action_type.Impl, each) for each in self._action_type.Impl.__struct_fields__]

    def destroy(self) -> None:
        """Destroy the client: futures under way are never done; of an AsyncNode they are cancelled."""
        for part in self._parts:
            part.destroy()
        for future in list(self._open_futures):
            self._node._abandon_(future)
        self._node.remove_waitable(self)


def _complete(future: Future[Any], function: Callable[[Any], Any], value: Any) -> None:
    try:
        result = function(value)
    except RuntimeError as error:
        future.set_exception(error)
    else:
        future.set_result(result)


def _check_handle(goal_handle: ClientGoalHandle) -> None:
    if not isinstance(goal_handle, ClientGoalHandle):
        raise TypeError(f"Expected type ClientGoalHandle but received {type(goal_handle)}")


def _cancel_request(goal_handle: ClientGoalHandle) -> CancelGoal.Request:
    _check_handle(goal_handle)
    return CancelGoal.Request(goal_info=GoalInfo(goal_id=goal_handle.goal_id))
