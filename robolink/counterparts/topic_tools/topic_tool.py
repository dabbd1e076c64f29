"""Nodes that pass on messages as bytes: relay, drop, delay and throttle, and their base class."""

from __future__ import annotations

from collections import deque
from typing import Any, NamedTuple

from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.counterparts.program import UsageError, spin_program
from robolink.exceptions import RobolinkError
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.parameters.descriptors import described
from robolink.publisher import Publisher
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.subscription import Subscription
from robolink.timer import Timer
from robolink.type_lookup import installed_type, type_of
from robolink.wire import EndpointKind

LOOK = 0.1
"""Time between two looks at who publishes, in seconds."""
DEPTH = 10


class Source(NamedTuple):
    """The type and the quality of service of a topic's publishers."""

    message_class: type[Any]
    reliability: ReliabilityPolicy
    durability: DurabilityPolicy

    @property
    def qos(self) -> QoSProfile:
        """Profile that all publishers of the topic match."""
        return QoSProfile(depth=DEPTH, reliability=self.reliability, durability=self.durability)


class TopicTool(Node):
    """A node that hears `input_topic`, of any type, and publishes on `output_topic` what `on_message` passes on.

    Args:
        name: Name of the node.
        parameters: Values of parameters that the command line gives.
        options: Those of `Node`.
    """

    input_topic = output_topic = ""

    def __init__(self, name: str, parameters: dict[str, Any] | None = None, **options: Any) -> None:
        given = [Parameter(each, value=value) for each, value in (parameters or {}).items()]
        super().__init__(name, parameter_overrides=given, **options)
        self.source: Source | None = None
        self.sink: Publisher[Any] | None = None
        self._heard: Subscription[Any] | None = None
        self._reported = ""
        try:
            self.set_up()
            words = "listen only while somebody listens to the output"
            self.lazy = self.declare_parameter("lazy", False, described(words)).value
        except RobolinkError:
            self.destroy_node()
            raise
        self.create_timer(LOOK, self.look)
        self.look()

    def set_up(self) -> None:
        """Declare parameters and set the topics; raises a RobolinkError for what cannot be."""
        raise NotImplementedError

    def declare_topics(self, suffix: str) -> None:
        """Declare the input topic and the output topic, which is the same with a suffix by default."""
        self.input_topic = self.needed("input_topic", "topic to listen to", "")
        words = described("topic to publish on")
        self.output_topic = self.declare_parameter("output_topic", f"{self.input_topic}{suffix}", words).value
        if self.resolve_topic_name(self.input_topic) == self.resolve_topic_name(self.output_topic):
            raise UsageError(f"input and output are one topic, {self.input_topic}: its messages would go in a circle")

    def needed(self, name: str, words: str, default: Any) -> Any:
        """Return the value of a parameter that has to be given: another one than `default`, which tells its type."""
        any_type = ParameterDescriptor(description=words, dynamic_typing=not isinstance(default, str))
        value = self.declare_parameter(name, default, any_type).value
        if value in (default, None):
            raise UsageError(f"the parameter {name} is needed: {words}")
        if isinstance(default, float) and isinstance(value, (int, float)):
            return float(value)
        if not isinstance(value, type(default)):
            raise UsageError(f"{name}: expected {type(default).__name__}, got {value!r}")
        return value

    def on_message(self, payload: bytes) -> None:
        """Publish the bytes of a message, later, or not at all; by default at once."""
        self.pass_on(payload)

    def pass_on(self, payload: bytes) -> None:
        """Publish the bytes of a message, if there is anything to publish on."""
        if self.sink is not None:
            self.sink.publish(payload)

    def output_class(self, source: Source) -> type[Any]:
        """Return the class of the output, that of the input by default."""
        return source.message_class

    def look(self) -> None:
        """Publish as the source does, and listen, if there is a source."""
        try:
            found = self._find_source() if self.input_topic else None
        except RobolinkError as error:  # a type that nobody tells
            self._tell(str(error))
            return
        if found != self.source or found is None:
            self.end()
        self.source = found
        if found is None:
            return
        if self.sink is not None and self.sink.topic != self.resolve_topic_name(self.output_topic):
            self.end()
        if self.sink is None:
            self.sink = self.create_publisher(self.output_class(found), self.output_topic, found.qos)
        self._listen(found, has_listeners=not self.lazy or self.sink.get_subscription_count() > 0)

    def end(self) -> None:
        """Neither listen nor publish, until the next look."""
        if self._heard is not None:
            self.destroy_subscription(self._heard)
        if self.sink is not None:
            self.destroy_publisher(self.sink)
        self._heard = self.sink = None

    def _listen(self, source: Source, *, has_listeners: bool) -> None:
        topic = self.resolve_topic_name(self.input_topic)
        if self._heard is not None and (not has_listeners or self._heard.topic != topic):
            self.destroy_subscription(self._heard)
            self._heard = None
        if self._heard is None and has_listeners:
            self._heard = self.create_subscription(source.message_class, topic, self._on_bytes, source.qos, raw=True)

    def _on_bytes(self, payload: bytes) -> None:
        self.on_message(payload)

    def _find_source(self) -> Source | None:
        topic = self.resolve_topic_name(self.input_topic)
        ends = self.context.graph.endpoints(EndpointKind.PUBLISHER, name=topic)
        if not ends:
            return None
        profiles = [each.qos_profile for each in self.get_publishers_info_by_topic(topic)]
        reliable = all(each.reliability is ReliabilityPolicy.RELIABLE for each in profiles)
        latched = all(each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in profiles)
        return Source(
            installed_type(ends[0]) or type_of(self.context, ends[0]),
            ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
            DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        )

    def _tell(self, text: str) -> None:
        """Warn of something, once."""
        if text != self._reported:
            self.get_logger().warning(text)
        self._reported = text


def numbered(words: list[str], usage: str, *kinds: tuple[str, type[Any]], optional: str = "") -> dict[str, Any]:
    """Return parameters from arguments in an order; none if there are none, since parameters serve as well.

    Args:
        words: The program's own arguments.
        usage: What they should be, for errors.
        kinds: Parameter and type of each argument.
        optional: Parameter of a last argument that may be missing.

    Raises:
        UsageError: for other arguments.
    """
    if not words:
        return {}
    if len(words) not in (len(kinds), len(kinds) + bool(optional)):
        raise UsageError(f"{len(words)} arguments: expected {usage}")
    found: dict[str, Any] = {}
    for word, (name, kind) in zip(words, kinds, strict=False):
        try:
            found[name] = kind(word)
        except ValueError:
            raise UsageError(f"{name}: expected a number, got '{word}'; {usage}") from None
    if len(words) > len(kinds):
        found[optional] = words[-1]
    return found


RELAY = "relay INTOPIC [OUTTOPIC]"


class Relay(TopicTool):
    """A node that passes on all messages. `options` are those of `TopicTool`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("relay", **options)

    def set_up(self) -> None:
        """Declare the topics."""
        self.declare_topics("_relay")


def run_relay(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""

    def make(words: list[str]) -> Relay:
        return Relay(parameters=numbered(words, RELAY, ("input_topic", str), optional="output_topic"))

    spin_program(make, args)


DROP = "drop INTOPIC X Y [OUTTOPIC]"


class Drop(TopicTool):
    """A node that drops some messages. `options` are those of `TopicTool`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("drop", **options)

    def set_up(self) -> None:
        """Declare the topics and the numbers."""
        self.declare_topics("_drop")
        self._dropped = self.needed("X", "messages of every Y that are dropped", -1)
        self._of = self.needed("Y", "messages of which X are dropped", -1)
        if not 0 <= self._dropped <= self._of or self._of < 1:
            raise UsageError(f"expected 0 <= X <= Y and Y at least 1, got {self._dropped} and {self._of}")
        self._count = 0

    def on_message(self, payload: bytes) -> None:
        """Pass on a message, or drop it."""
        if self._count >= self._dropped:
            self.pass_on(payload)
        self._count = (self._count + 1) % self._of


def run_drop(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""

    def make(words: list[str]) -> Drop:
        return Drop(parameters=numbered(words, DROP, *KINDS, optional="output_topic"))

    spin_program(make, args)


KINDS: tuple[tuple[str, type[Any]], ...] = (("input_topic", str), ("X", int), ("Y", int))


DELAY = "delay INTOPIC SECONDS [OUTTOPIC]"
MOST_WAITING = 100_000
"""Largest number of messages that wait; the oldest is dropped for one more."""


class Delay(TopicTool):
    """A node that passes on messages later. `options` are those of `TopicTool`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("delay", **options)

    def set_up(self) -> None:
        """Declare the topics and the delay."""
        self.declare_topics("_delay")
        self._delay = self.needed("delay", "seconds by which messages are delayed", -1.0)
        if not 0.0 <= self._delay < 1e6:
            raise UsageError(f"delay: expected seconds from 0 on, got {self._delay:g}")
        self._waiting: deque[tuple[int, bytes]] = deque(maxlen=MOST_WAITING)
        self._timer: Timer | None = None

    def on_message(self, payload: bytes) -> None:
        """Keep a message until its time."""
        self._waiting.append((self.get_clock().now().nanoseconds + round(self._delay * 1e9), payload))
        if self._timer is None:
            self._wake_in(self._delay)

    def _wake_in(self, seconds: float) -> None:
        self._timer = self.create_timer(max(seconds, 0.0), self._on_timer)

    def _on_timer(self) -> None:
        """Pass on what is due, and wake again for the next one."""
        if self._timer is not None:
            self.destroy_timer(self._timer)
            self._timer = None
        now = self.get_clock().now().nanoseconds
        while self._waiting and self._waiting[0][0] <= now:
            self.pass_on(self._waiting.popleft()[1])
        if self._waiting:
            self._wake_in((self._waiting[0][0] - now) / 1e9)


def run_delay(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""

    def make(words: list[str]) -> Delay:
        kinds: tuple[tuple[str, type[Any]], ...] = (("input_topic", str), ("delay", float))
        return Delay(parameters=numbered(words, DELAY, *kinds, optional="output_topic"))

    spin_program(make, args)


MESSAGES = "throttle messages INTOPIC MESSAGES_PER_SECOND [OUTTOPIC]"
BYTES = "throttle bytes INTOPIC BYTES_PER_SECOND WINDOW [OUTTOPIC]"


class Throttle(TopicTool):
    """A node that passes on some messages. `options` are those of `TopicTool`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("throttle", **options)

    def set_up(self) -> None:
        """Declare the topics and the limits."""
        self.declare_topics("_throttle")
        kind = self.needed("throttle_type", "messages or bytes", "")
        words = "use this machine's clock, also where time is simulated"
        wall = self.declare_parameter("use_wall_clock", False, described(words)).value
        system = Clock(clock_type=ClockType.SYSTEM_TIME, time_base=self.context.time)
        self._clock_used = system if wall else self.get_clock()
        self._period = self._limit = 0.0
        if kind == "messages":
            self._period = 1e9 / self._positive("msgs_per_sec", "messages per second")
        elif kind == "bytes":
            self._limit = self._positive("bytes_per_sec", "bytes per second")
            self._window = self._positive("window", "seconds of which the bytes are counted")
        else:
            raise UsageError(f"throttle_type: expected messages or bytes, got '{kind}'")
        self._last = self._now()
        self._sent: deque[tuple[int, int]] = deque()

    def _positive(self, name: str, words: str) -> float:
        value = float(self.needed(name, words, 0.0))
        if not 0.0 < value < 1e18:
            raise UsageError(f"{name}: expected a number above 0, got {value:g}")
        return value

    def _now(self) -> int:
        return self._clock_used.now().nanoseconds

    def on_message(self, payload: bytes) -> None:
        """Pass on a message if there is room for it."""
        if self._is_time() if self._period else self._is_room(len(payload)):
            self.pass_on(payload)

    def _is_time(self) -> bool:
        now = self._now()
        if self._last > now:
            self.get_logger().warning("Detected jump back in time, resetting throttle period to now for.")
            self._last = now
        if now - self._last < self._period:
            return False
        self._last = now
        return True

    def _is_room(self, size: int) -> bool:
        now = self._now()
        while self._sent and self._sent[0][0] < now - self._window * 1e9:
            self._sent.popleft()
        if sum(each for _, each in self._sent) >= self._limit:
            return False
        self._sent.append((now, size))
        return True


def throttle_parameters(words: list[str]) -> dict[str, Any]:
    """Return the parameters of a command line. Raises UsageError."""
    if not words:
        return {}
    kind, *rest = words
    first = ("input_topic", str)
    if kind == "messages" and rest:
        given = numbered(rest, MESSAGES, first, ("msgs_per_sec", float), optional="output_topic")
    elif kind == "bytes" and rest:
        kinds = (first, ("bytes_per_sec", int), ("window", float))
        given = numbered(rest, BYTES, *kinds, optional="output_topic")
    else:
        raise UsageError(f"expected {MESSAGES}, or {BYTES}")
    return {"throttle_type": kind, **given}


def run_throttle(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""
    spin_program(lambda words: Throttle(parameters=throttle_parameters(words)), args)
