"""robolink action echo: what an action's server and clients say to each other, part by part."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.shared import messages
from robolink.cli.shared.output import say
from robolink.cli.shared.session import node_of, opened
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.executors import SingleThreadedExecutor
from robolink.graph.action_names import CANCEL_GOAL, FEEDBACK, GET_RESULT, SEND_GOAL, STATUS, part_name
from robolink.interfaces.service_msgs.msg import ServiceEventInfo
from robolink.qos import QoSProfile, qos_profile_action_status_default, qos_profile_services_default
from robolink.service_introspection import SUFFIX
from robolink.system.terminal import shown
from robolink.task import Future
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.message import Action

NAMES = {number: name for name, (_, number) in ServiceEventInfo.__ros_constants__.items()}
"""Names of the kinds of events, by number."""

INTERFACES = ["GOAL_SERVICE", "CANCEL_SERVICE", "RESULT_SERVICE", "FEEDBACK_TOPIC", "STATUS_TOPIC"]
"""Parts of an action, as ros2 calls them."""


class Format(NamedTuple):
    """Format in which messages are shown."""

    style: messages.Style = messages.Style()
    csv: bool = False

    def text(self, interface: str, message: Any) -> str:
        """Return a message of a part as text, like ros2: with a name in place of an event's number but for CSV."""
        if self.csv:
            return f"interface: {interface}\n{messages.as_csv(message, self.style)}"
        if hasattr(message, "info"):
            message.info.event_type = NAMES.get(message.info.event_type, message.info.event_type)
        return f"interface: {interface}\n{messages.as_yaml(message, self.style)}\n---"


class _Part(NamedTuple):
    """Topic of a part: its suffix, type and profile."""

    name: str
    msg_type: type[Any]
    qos: QoSProfile


def _parts(chosen: type[Action]) -> dict[str, _Part]:
    impl: Any = chosen.Impl
    events = qos_profile_services_default
    return {
        "GOAL_SERVICE": _Part(SEND_GOAL + SUFFIX, impl.SendGoalService.Event, events),
        "CANCEL_SERVICE": _Part(CANCEL_GOAL + SUFFIX, impl.CancelGoalService.Event, events),
        "RESULT_SERVICE": _Part(GET_RESULT + SUFFIX, impl.GetResultService.Event, events),
        "FEEDBACK_TOPIC": _Part(FEEDBACK, impl.FeedbackMessage, QoSProfile(depth=10)),
        "STATUS_TOPIC": _Part(STATUS, impl.GoalStatusMessage, qos_profile_action_status_default),
    }


def echo(action: str, type_: str, interfaces: Sequence[str], form: Format) -> None:
    """Show what an action's server and clients say to each other, until Ctrl-C.

    Raises NotFoundError for an unknown action or type.
    """
    done: Future[None] = Future()

    def show(interface: str, message: Any) -> None:
        if done.done():
            return
        try:
            say(form.text(interface, message))
        except (RobolinkError, OSError) as error:  # a closed pipe
            done.set_exception(error)

    with opened() as context:
        node = node_of(context)
        name = node.resolve_topic_name(action)
        mark = part_name("", SEND_GOAL)
        known = [each.name for each in context.graph.endpoints(EndpointKind.SERVICE) if each.name.endswith(mark)]
        if not type_ and name + mark not in known:
            actions = [each.removesuffix(mark) for each in known]
            raise NotFoundError("action", shown(name), actions, f"domain {context.get_domain_id()}")
        parts = _parts(messages.action_type(context, name, type_))
        for each in interfaces:
            part = parts[each]
            topic = part_name(name, part.name)
            node.create_subscription(part.msg_type, topic, lambda message, each=each: show(each, message), part.qos)
        with SingleThreadedExecutor(context=context) as executor:
            executor.add_node(node)
            executor.spin_until_future_complete(done)
        if done.done():
            done.result()
