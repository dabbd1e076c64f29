"""Output of service events for `robolink service echo`: requests and responses, if introspection is on."""

from __future__ import annotations

from typing import Any, NamedTuple

from robolink.cli.shared import messages
from robolink.cli.shared.messages import service_type
from robolink.cli.shared.output import say, tell
from robolink.cli.shared.session import node_of, opened
from robolink.exceptions import RobolinkError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.service_msgs.msg import ServiceEventInfo
from robolink.qos import qos_profile_services_default
from robolink.service_introspection import SUFFIX
from robolink.task import Future

NAMES = {number: name for name, (_, number) in ServiceEventInfo.__ros_constants__.items()}
"""Names of the kinds of events, by number."""


class Format(NamedTuple):
    """Format in which events are shown."""

    style: messages.Style = messages.Style()
    csv: bool = False
    json: bool = False

    def text(self, event: Any) -> str:
        """Return an event as text, like ros2: with a name in place of its number but for CSV."""
        if self.csv:
            return messages.as_csv(event, self.style)
        event.info.event_type = NAMES.get(event.info.event_type, event.info.event_type)
        return messages.as_json(event) if self.json else f"{messages.as_yaml(event, self.style)}\n---"


def run(service: str, type_: str, form: Format, *, once: bool = False) -> None:
    """Show what a service and its clients say to each other, until Ctrl-C; one event if `once`.

    Raises NotFoundError for an unknown service or type.
    """
    done: Future[None] = Future()

    def on_event(event: Any) -> None:
        if done.done():
            return
        try:
            say(form.text(event))
        except (RobolinkError, OSError) as error:  # a closed pipe
            done.set_exception(error)
            return
        if once:
            done.set_result(None)

    with opened() as context:
        node = node_of(context)
        name = node.resolve_service_name(service)
        events = service_type(context, name, type_).Event
        subscription = node.create_subscription(events, name + SUFFIX, on_event, qos_profile_services_default)
        if subscription.get_publisher_count() < 1:
            tell(
                f"No publishers on topic '{name}{SUFFIX}'; is service introspection on the client or server enabled?"
                " (node.create_service(...).configure_introspection(...))"
            )
        with SingleThreadedExecutor(context=context) as executor:
            executor.add_node(node)
            executor.spin_until_future_complete(done)
        if done.done():
            done.result()
