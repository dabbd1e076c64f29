"""robolink topic pub: messages at a rate, with stamps of the time of sending."""

from __future__ import annotations

import itertools
import pathlib
import re
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.shared.messages import message_type
from robolink.cli.shared.output import say
from robolink.cli.shared.session import node_of, opened
from robolink.cli.topic.options import QoSFlags
from robolink.documents.yamlfile import parse
from robolink.event_handler import PublisherEventCallbacks
from robolink.exceptions import DocumentError, MessageError, RobolinkError, nearest
from robolink.executors import Executor, SingleThreadedExecutor
from robolink.message import decode, encode, from_builtins
from robolink.system import clocks
from robolink.system.files import decoded
from robolink.system.terminal import shown
from robolink.task import Future
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.message import FieldType, Message
    from robolink.node import Node
    from robolink.publisher import Publisher
    from robolink.time import Time


HEADER, TIME = "std_msgs/msg/Header", "builtin_interfaces/msg/Time"

Path = tuple["str | int", ...]


class Stamped:
    """A message, with those of its stamps that are to be the time of sending."""

    def __init__(self, msg_type: type[Any], data: Any) -> None:
        """`data` is the message as plain data. Raises EncodeError that names the field which does not fit."""
        self._paths: list[Path] = []
        made = from_builtins(msg_type, self._without_words(msg_type.__ros_fields__, data, ()))
        self.message = decode(msg_type, encode(made))  # as it will arrive: 3 becomes 3.0 where a float stands
        self._stamps = [_at(self.message, path) for path in self._paths]

    def stamp(self, now: Time) -> None:
        """Set the stamps to `now`."""
        seconds, nanoseconds = divmod(now.nanoseconds, 10**9)
        for each in self._stamps:
            each.sec, each.nanosec = seconds, nanoseconds

    def _without_words(self, fields: dict[str, FieldType], data: Any, path: Path) -> Any:
        """Return the data without `auto` and `now`, and record their places."""
        if not isinstance(data, dict):
            return data
        return {name: self._value(fields.get(name), value, (*path, name)) for name, value in data.items()}

    def _value(self, kind: FieldType | None, value: Any, path: Path) -> Any:
        if kind is None or kind.message is None:
            return value
        if kind.shape == "one":
            return self._nested(kind.message, value, path)
        if not isinstance(value, list):
            return value
        return [self._nested(kind.message, each, (*path, index)) for index, each in enumerate(value)]

    def _nested(self, cls: type[Message], value: Any, path: Path) -> Any:
        if cls.__ros_type__ == HEADER and value == "auto":
            self._paths.append((*path, "stamp"))
            return {}
        if cls.__ros_type__ == TIME and value == "now":
            self._paths.append(path)
            return {}
        return self._without_words(cls.__ros_fields__, value, path)


def _at(message: Any, path: Path) -> Any:
    for step in path:
        message = message[step] if isinstance(step, int) else getattr(message, step)
    return message


LOWEST_RATE = 1e-9
"""Lower bound of the rate, in Hz (a message in about 31 years)."""

FOUND_WITHIN = 0.5
"""Timeout of the look-up of a topic whose type was not named, in seconds."""

INPUT = "<standard input>"
LONGEST_INPUT = 64 * 2**20
"""Upper bound of standard input, or of a file, in bytes: a few pictures, as YAML."""

_RULE = re.compile(r"^(?:---|\.\.\.)(?=\s|$)", re.MULTILINE)
"""Separator of the documents of a YAML stream, which `topic echo` writes after each."""


class PublishError(RobolinkError, ValueError):
    """The rate is not valid, flags do not go together, or the topic has no type."""


class MatchTimeoutError(RobolinkError, TimeoutError):
    """The time of --max-wait-time-secs passed before there were enough subscriptions."""


class Request(NamedTuple):
    """Options of `topic pub`: how often, how long, and for how many subscriptions."""

    rate: float = 1.0
    times: int = 0
    """Number of messages; 0 for no end."""
    wait: int | None = None
    """Number of subscriptions to wait for; by default one if `times` is given."""
    max_wait: float | None = None
    keep_alive: float = 0.1
    """Time that the publisher stays after its last message, so that it arrives, in seconds."""
    print_every: int = 1
    node_name: str = ""
    qos: QoSFlags = QoSFlags()
    sim_time: bool = False


def run(topic: str, type_name: str, values: str | None, request: Request, *, file: str = "") -> None:
    """Publish the messages in `values`, in a YAML file, or on standard input if there is neither, in turn."""
    if not LOWEST_RATE <= request.rate < float("inf"):
        raise PublishError(f"--rate: expected a number of Hz above 0, got {request.rate:g}")
    wait = (1 if request.times else 0) if request.wait is None else request.wait
    if request.max_wait is not None and not wait:
        raise PublishError("--max-wait-time-secs only says something with --wait-matching-subscriptions, -1 or --times")
    if values is not None:
        documents = [("", parse(values, name="<values>"))]
    elif file:
        documents = list(documents_of(read_messages(file), file))
    else:
        documents = list(documents_of(read_input()))
    with opened() as context:
        node = node_of(context, request.node_name, describes=True)
        name = node.resolve_topic_name(topic)
        msg_type = _type_of(context, name, type_name)
        messages = [_stamped(msg_type, each, place) for place, each in documents]
        if request.sim_time:
            _follow_clock(node)
        # The event does nothing but end a turn of the executor: somebody has come.
        events = PublisherEventCallbacks(matched=lambda _: None)
        publisher = node.create_publisher(msg_type, name, request.qos.over("default"), event_callbacks=events)
        with SingleThreadedExecutor(context=context) as executor:
            executor.add_node(node)
            _wait(executor, publisher, wait, request.max_wait)
            say("publisher: beginning loop")
            _loop(node, executor, publisher, messages, request)


def read_input() -> str:
    """Return standard input to its end. Raises DocumentError if it is not text, or too long."""
    return _text(b"" if sys.stdin is None else sys.stdin.buffer.read(LONGEST_INPUT + 1), INPUT)


def read_messages(file: str) -> str:
    """Return the text of a YAML file. Raises DocumentError if it cannot be read, is not text, or too long."""
    try:
        with pathlib.Path(file).open("rb") as stream:
            return _text(stream.read(LONGEST_INPUT + 1), file)
    except OSError as error:
        raise DocumentError(f"cannot be read: {error.strerror or error}", file) from None


def _text(raw: bytes, name: str) -> str:
    if len(raw) > LONGEST_INPUT:
        raise DocumentError(f"more than {LONGEST_INPUT // 2**20} MiB", name)
    try:
        return decoded(raw)
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        raise DocumentError("not UTF-8 text", name, line) from None


def documents_of(text: str, source: str = INPUT) -> Iterator[tuple[str, Any]]:
    """Yield the place and the content of each document of a YAML stream that is not empty; DocumentError for none."""
    parts = [each for each in _RULE.split(text) if each.strip()]
    if not parts:
        raise DocumentError("there is nothing to publish in it", source)
    for number, each in enumerate(parts, start=1):
        place = source if len(parts) == 1 else f"{source}, document {number}"
        yield place, parse(each.removeprefix("\n"), name=place)


def _stamped(msg_type: type[Any], data: Any, place: str) -> Stamped:
    """Return a message. Raises DocumentError with its place, MessageError if it has none."""
    try:
        return Stamped(msg_type, data)
    except MessageError as error:
        if not place:
            raise
        raise DocumentError(str(error), place) from None


def _type_of(context: Context, name: str, given: str) -> type[Any]:
    """Return the type that was named, else the one that the topic has. Raises PublishError for an unknown topic."""
    graph, ends = context.graph, (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
    if given or graph.wait_for(lambda: bool(graph.endpoints(*ends, name=name)), FOUND_WITHIN):
        return message_type(context, name, given)
    near = nearest(name, {each.name for each in graph.endpoints(*ends)})
    raise PublishError(f"nobody uses {shown(name)} yet{near}, so say its type: TOPIC TYPE VALUES")


def _follow_clock(node: Node) -> None:
    from robolink.parameter import Parameter

    node.set_parameters([Parameter("use_sim_time", value=True)])


def _wait(executor: Executor, publisher: Publisher[Any], count: int, longest: float | None) -> None:
    """Spin until there are `count` subscriptions, with a note once a second.

    A new peer may first ask this node for its type, so it has to spin.
    """
    end = None if longest is None else clocks.monotonic() + longest
    while publisher.get_subscription_count() < count:
        if end is not None and clocks.monotonic() >= end:
            found = publisher.get_subscription_count()
            raise MatchTimeoutError(
                f"timed out waiting for subscribers: expected {count}, but there are only {found} of"
                f" {publisher.topic_name} with type {publisher.msg_type.__ros_type__}"
            )
        say(f"Waiting for at least {count} matching subscription(s)...")
        reported = clocks.monotonic()
        until = reported + 1.0 if end is None else min(end, reported + 1.0)
        while publisher.get_subscription_count() < count and clocks.monotonic() < until:
            executor.spin_once(timeout_sec=max(0.0, until - clocks.monotonic()))


def _loop(node: Node, executor: Executor, publisher: Publisher[Any], messages: list[Stamped], request: Request) -> None:
    serial, turn, done = itertools.count(1), itertools.cycle(messages), Future[None]()
    clock = node.get_clock()

    def send() -> None:
        number, each = next(serial), next(turn)
        each.stamp(clock.now())
        if request.print_every and number % request.print_every == 0:
            say(f"publishing #{number}: {each.message!r}\n")
        publisher.publish(each.message)
        if number == request.times:
            done.set_result(None)

    def send_again() -> None:
        if done.done():
            return
        try:
            send()
        except (RobolinkError, OSError) as error:  # the command's own error, no callback's: a closed pipe
            done.set_exception(error)

    send()
    if not done.done():
        node.create_timer(1.0 / request.rate, send_again)
        executor.spin_until_future_complete(done)
        done.result()
    executor.spin_until_future_complete(Future(), timeout_sec=request.keep_alive)
