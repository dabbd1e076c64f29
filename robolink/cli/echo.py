"""What `robolink topic echo` does."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli import show
from robolink.cli.session import node_of, opened, say, tell
from robolink.context import Context
from robolink.exceptions import RobolinkError, nearest
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces import find
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.task import Future
from robolink.wire import EndpointKind, EndpointToken

if TYPE_CHECKING:
    from robolink.node import Node

PATIENCE = 1.0
"""Seconds of silence after which the reason is given."""


class Format(NamedTuple):
    """How messages are shown."""

    field: str
    json: bool
    full_length: bool

    def text(self, message: Any) -> str:
        """Give a message as it is shown."""
        value = show.field_of(message, self.field) if self.field else message
        if self.json:
            return show.as_json(value)
        return show.as_yaml(value, None if self.full_length else show.LONGEST) + "\n---"


def run(topic: str, type_: str, *, once: bool, form: Format) -> None:
    """Show what is published on a topic; one message if `once`, else until Ctrl-C."""
    wanted = find(type_) if type_ else None
    with opened() as context:
        node = node_of(context)
        name = node.resolve_topic_name(topic)
        msg_type = wanted or find(_first_publisher(context, name).type_name)
        if form.field:
            show.check_path(msg_type, form.field)
        _show(node, name, msg_type, once, form)


def _show(node: Node, name: str, msg_type: type[Any], once: bool, form: Format) -> None:
    first, done = Future[None](), Future[None]()

    def on_message(message: Any) -> None:
        if done.done():
            return
        first.set_result(None)
        try:
            say(form.text(message))
        except (
            RobolinkError,
            OSError,
        ) as error:  # the command's own error, no callback's: no such field, a closed pipe
            done.set_exception(error)
        if once and not done.done():
            done.set_result(None)

    node.create_subscription(msg_type, name, on_message, _matching_qos(node.context, name))
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    executor.spin_until_future_complete(first, timeout_sec=PATIENCE)
    if not first.done():
        tell(_why_silent(node.context, name, msg_type.__ros_type__))
    executor.spin_until_future_complete(done)
    done.result()


def _why_silent(context: Context, name: str, type_name: str) -> str:
    """Say why nothing of a type comes on a topic."""
    offered = sorted({each.type_name for each in context.graph.endpoints(EndpointKind.PUBLISHER, name=name)})
    if not offered:
        return _nobody(context, name)
    if type_name not in offered:
        return f"nothing will come: {name} is published as {' and '.join(offered)}, not as {type_name}"
    return f"waiting: {name} has a publisher, and it has sent nothing yet"


def _nobody(context: Context, name: str) -> str:
    topics = sorted({each.name for each in context.graph.endpoints(EndpointKind.PUBLISHER)})
    where = f"domain {context.get_domain_id()}"
    return f"waiting for a publisher of {name}: nobody publishes it on {where} yet{nearest(name, topics)}"


def _publisher(context: Context, name: str) -> EndpointToken | None:
    found = context.graph.endpoints(EndpointKind.PUBLISHER, name=name)
    return found[0] if found else None


def _first_publisher(context: Context, name: str) -> EndpointToken:
    """Wait for a publisher; say so when that takes long."""
    told = False
    while (found := _publisher(context, name)) is None:
        if not context.ok():
            raise KeyboardInterrupt
        # Never without a limit: on Windows Ctrl-C does not end a wait.
        known = context.graph.wait_for(lambda: bool(_publisher(context, name)) or not context.ok(), PATIENCE)
        if not known and not told:
            tell(_nobody(context, name))
            told = True
    return found


def _matching_qos(context: Context, name: str) -> QoSProfile:
    """Ask for what the publishers offer: what they kept, if they keep something."""
    offered = [each.qos for each in context.graph.endpoints(EndpointKind.PUBLISHER, name=name)]
    latched = bool(offered) and all(each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in offered)
    reliable = all(each.reliability is not ReliabilityPolicy.BEST_EFFORT for each in offered)
    return QoSProfile(
        depth=max([10, *(each.depth for each in offered)]) if latched else 10,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
    )
