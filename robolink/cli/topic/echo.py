"""Output of messages for `robolink topic echo`."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.shared import graph, messages
from robolink.cli.shared.graph import matching_qos
from robolink.cli.shared.messages import message_type
from robolink.cli.shared.output import clear, say, tell
from robolink.cli.shared.session import node_of, opened
from robolink.cli.topic.arrivals import Leniently
from robolink.cli.topic.options import QoSFlags
from robolink.context import Context
from robolink.event_handler import QoSMessageLostInfo, SubscriptionEventCallbacks
from robolink.exceptions import RobolinkError
from robolink.executors import SingleThreadedExecutor
from robolink.message import type_hash
from robolink.subscription import MessageInfo
from robolink.system import clocks
from robolink.task import Future
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.node import Node

PATIENCE = graph.PATIENCE


class NothingCameError(RobolinkError, TimeoutError):
    """--timeout passed before a message came."""


class Format(NamedTuple):
    """Format in which messages are shown."""

    field: str = ""
    style: messages.Style = messages.Style()
    json: bool = False
    csv: bool = False
    raw: bool = False
    info: bool = False
    clear: bool = False
    image: bool = False

    def text(self, message: Any, info: MessageInfo) -> str:
        """Return a message as text. `info` comes first if it is wanted, in ros2's order."""
        value = messages.field_of(message, self.field) if self.field else message
        reported = {name: each for name, each in info.items() if name != "publisher_gid"}
        if self.image:
            from robolink.cli.shared.picture import drawn

            return drawn(value)
        if self.json:
            return messages.as_json({"info": reported, "message": value} if self.info else value)
        if self.csv:
            before = [str(each) for each in reported.values()] if self.info else []
            return ",".join([*before, messages.as_csv(value, self.style)])
        shown = repr(value) if self.raw else messages.as_yaml(value, self.style)
        before = [messages.as_yaml(dict(sorted(reported.items())))] if self.info else []
        return "\n---\n".join([*before, shown, ""]).removesuffix("\n")


class Request(NamedTuple):
    """Options of `topic echo`: what to listen to, and until when."""

    type_name: str = ""
    once: bool = False
    timeout: float | None = None
    filter: str = ""
    lost: bool = True
    """True to report lost messages."""
    node_name: str = ""
    qos: QoSFlags = QoSFlags()


def run(topic: str, request: Request, form: Format) -> None:
    """Show what is published on a topic; one message if `once`, else until Ctrl-C or the timeout."""
    begin = clocks.monotonic()
    with opened() as context:
        node = node_of(context, request.node_name)
        name = node.resolve_topic_name(topic)
        reported = request.type_name == "" and _wait_for_topic(context, name, request.timeout)
        msg_type = message_type(context, name, request.type_name)
        passes = _passes(msg_type, form, request.filter)
        left = None if request.timeout is None else max(request.timeout - (clocks.monotonic() - begin), 0.0)
        if not _Echo(node, name, msg_type, request, form, passes).run(left, reported) and request.timeout is not None:
            raise NothingCameError(f"no message on {name} within {request.timeout:g} s")


def _passes(msg_type: type[Any], form: Format, text: str) -> Callable[[Any], bool]:
    """Return the filter of messages. Raises EncodeError for a wrong field, FilterError for a wrong expression."""
    kind = messages.check_path(msg_type, form.field) if form.field else None
    if not text:
        return lambda _: True
    from robolink.cli.topic.arrivals import compile_filter

    passes = Leniently(compile_filter(text, kind or msg_type))
    if kind is None:
        return passes
    return lambda message: passes(messages.field_of(message, form.field))


class _Echo:
    """One run of `topic echo`, which ends when the future `done` is done."""

    def __init__(
        self,
        node: Node,
        name: str,
        msg_type: type[Any],
        request: Request,
        form: Format,
        passes: Callable[[Any], bool],
    ) -> None:
        self.node, self.name, self.msg_type = node, name, msg_type
        self.request, self.form, self.passes = request, form, passes
        self.first, self.done = Future[None](), Future[None]()
        self.shown = 0
        self.qos = request.qos.over("sensor_data") if request.qos.given else matching_qos(node.context, name)

    def run(self, timeout: float | None, reported: bool) -> int:
        """Show messages until the end, and return how many were shown."""
        end = None if timeout is None else clocks.monotonic() + timeout
        # Why nothing comes is told here, in this command's words.
        events = SubscriptionEventCallbacks(message_lost=self.on_lost, use_default_callbacks=False)
        self.node.create_subscription(
            self.msg_type, self.name, self.on_message, self.qos, event_callbacks=events, raw=self.form.raw
        )
        with SingleThreadedExecutor(context=self.node.context) as executor:
            executor.add_node(self.node)
            if not reported:
                patience = PATIENCE if timeout is None else min(PATIENCE, timeout)
                executor.spin_until_future_complete(self.first, timeout_sec=patience)
                if not self.first.done() and patience == PATIENCE:
                    tell(graph.why_silent(self.node.context, self.name, self.listening()))
            left = None if end is None else max(end - clocks.monotonic(), 0.0)
            executor.spin_until_future_complete(self.done, timeout_sec=left)
        if self.done.done():
            self.done.result()
        return self.shown

    def listening(self) -> graph.Listening:
        """Return the type and QoS that are listened with."""
        return graph.Listening(self.msg_type.__ros_type__, type_hash(self.msg_type), self.qos)

    def on_message(self, message: Any, info: MessageInfo) -> None:
        """Show a message. Errors, such as a missing field or a closed pipe, end the command, not only the callback."""
        if self.done.done():
            return
        if not self.first.done():
            self.first.set_result(None)
        try:
            if self.form.raw or self.passes(message):
                text = self.form.text(message, info)
                if self.form.clear and not (self.form.json or self.form.csv):
                    clear()
                say(text, colours=self.form.image)
                self.shown += 1
        except (RobolinkError, OSError) as error:
            self.done.set_exception(error)
        if self.request.once and self.shown and not self.done.done():
            self.done.set_result(None)

    def on_lost(self, info: QoSMessageLostInfo) -> None:
        """Report messages that were lost."""
        if self.request.lost:
            change, total = info.total_count_change, info.total_count
            tell(f"A message was lost!!!\n\ttotal count change:{change}\n\ttotal count: {total}")


def _wait_for_topic(context: Context, name: str, timeout: float | None) -> bool:
    """Wait until the topic has an endpoint; return True if the reason for the wait was printed."""
    begin, reported = clocks.monotonic(), False

    def known() -> bool:
        return bool(context.graph.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION, name=name))

    while not known():
        spent = clocks.monotonic() - begin
        if timeout is not None and spent >= timeout:
            raise NothingCameError(f"nobody publishes {name}: its type is not known, and {timeout:g} s have passed")
        if not context.ok():
            raise KeyboardInterrupt
        left = PATIENCE if timeout is None else min(PATIENCE, timeout - spent)
        # Never without a limit: on Windows Ctrl-C does not end a wait.
        if not context.graph.wait_for(lambda: known() or not context.ok(), left) and not reported and left == PATIENCE:
            tell(graph.why_silent(context, name))
            reported = True
    return reported
