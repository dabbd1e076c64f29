"""Base of the nodes that pass on messages of any type: as bytes, with their source's type and quality of service."""

from __future__ import annotations

from typing import Any, NamedTuple

from robolink.counterparts.program import UsageError
from robolink.exceptions import RobolinkError
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.parameters.descriptors import described
from robolink.publisher import Publisher
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.subscription import Subscription
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
        self._told = ""
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
        self._listen(found, wanted=not self.lazy or self.sink.get_subscription_count() > 0)

    def end(self) -> None:
        """Neither listen nor publish, until the next look."""
        if self._heard is not None:
            self.destroy_subscription(self._heard)
        if self.sink is not None:
            self.destroy_publisher(self.sink)
        self._heard = self.sink = None

    def _listen(self, source: Source, *, wanted: bool) -> None:
        topic = self.resolve_topic_name(self.input_topic)
        if self._heard is not None and (not wanted or self._heard.topic != topic):
            self.destroy_subscription(self._heard)
            self._heard = None
        if self._heard is None and wanted:
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
        if text != self._told:
            self.get_logger().warning(text)
        self._told = text


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
