"""Log of a system under test: what was published, by which node, what failed, and how to replay it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from robolink.testing.expectations import (
    BACKGROUND,
    MOST_LOGS,
    MOST_OF_BACKGROUND,
    MOST_OF_ONE,
    MOST_OF_OTHERS,
    Ends,
    Event,
    ExpectationError,
    FailureText,
    logs_of,
    messages_of,
    nothing_came,
    seconds,
    too_early,
)
from robolink.testing.recorder import Recorder, Topic
from robolink.text.names import near
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.message import Message
    from robolink.node import Node
    from robolink.publisher import Publisher
    from robolink.qos import QoSProfile
    from robolink.testing.recorder import TopicQueue
    from robolink.testing.stage import Failure, Stage


class Story:
    """Log of a system, and the texts made of it for a failed test.

    `replay` is the command that repeats the test.
    """

    def __init__(self, stage: Stage, replay: str) -> None:
        self._stage, self._replay = stage, replay
        self._classes: dict[str, type[Message]] = {}
        self._said: dict[str, None] = {}
        self.graph = GraphView(stage.node)
        self.recorder = Recorder(stage.session(), stage.domain, stage.now_ns, self._learn)
        """The last messages of each topic."""

    @property
    def time(self) -> float:
        """Seconds since the beginning of the system."""
        return self._since(self._stage.now_ns())

    def _since(self, time_ns: int) -> float:
        return (time_ns - self._stage.begin_ns) / 1e9

    # Decoding

    def decoded(self, topic: Topic, payload: bytes, given: type[Message] | None = None) -> Any:
        """Return a message of a topic; its class is the publishers' own, unless it is given.

        Raises ExpectationError for a class that is not the topic's, and TypeLookupError when nobody knows the class.
        """
        from robolink.serialization import deserialize_message

        return deserialize_message(payload, self._class_of(topic) if given is None else _checked(given, topic))

    def _learn(self, topic: Topic) -> None:
        """Remember the class of a topic while its publisher is there: later nobody may know it."""
        found = self._stage.class_of(topic)
        if found is not None:
            self._classes[topic.key] = found

    def _class_of(self, topic: Topic) -> type[Message]:
        found = self._classes.get(topic.key)
        if found is None:
            found = self._stage.class_of(topic) or self._looked_up(topic)
            self._classes[topic.key] = found
        return found

    def _looked_up(self, topic: Topic) -> type[Message]:
        from robolink.type_lookup import type_of

        return type_of(self._stage.node.context, topic.token)

    # Texts

    def note_said(self, topic: str) -> None:
        """Note that the test itself has published on a topic."""
        self._said[topic] = None

    def _said_in_vain(self) -> list[str]:
        """Return to which topics the test publishes that nobody subscribes, with the nearest that somebody does."""
        vain = [each for each in self._said if not self._stage.node.count_subscribers(each)]
        heard = [each for each in self.graph.topics() if self.graph.ends(each).subscribers] if vain else []
        return [f"nobody listens to {each}{near(each, heard)}" for each in vain]

    def whole(self) -> str:
        """Return the story: what was last published on each topic, logged, failed, and how to replay it."""
        return self.failure_text(f"the system after {self.time:.3f} s", others=self.topics())

    def topics(self) -> list[str]:
        """Return the names of the system's own topics."""
        return [each.name for each in self.recorder.topics.values() if each.name not in EVERYBODYS_TOPICS]

    def failure_text(
        self, headline: str, topic: str | None = None, *, others: Iterable[str] = (), all_logs: bool = False
    ) -> str:
        """Return the text of a failure: `topic` is what it is about, `others` are related to it."""
        stage = self._stage
        most = {each: MOST_OF_BACKGROUND if each in BACKGROUND else MOST_OF_OTHERS for each in others}
        if topic is not None:
            most[topic] = MOST_OF_ONE
        events = [
            each
            for name, count in most.items()
            for found in self.recorder.named(name)
            for each in messages_of(self.recorder, found, self._class_of, count)
        ]
        events += logs_of(stage.logs, MOST_LOGS, all_logs)
        events += [Event(each.time_ns, "failed", each.program, each.why) for each in stage.failures]
        faults, real_time = stage.fault_reports(), stage.real_time_use()
        return str(FailureText(headline, stage.begin_ns, events, self._said_in_vain(), faults, real_time, self._replay))

    def failures_text(self, failures: Iterable[Failure]) -> str:
        """Return which programs failed, when and why."""
        lines = (f"{each.program} failed at {seconds(self._since(each.time_ns))}: {each.why}" for each in failures)
        return self.failure_text("\n".join(lines))

    def why_nothing_came(self, topic: str, tried: int, when: str, condition: str) -> str:
        """Return why no message came that meets a condition: `tried` is how many were looked at."""
        known = self.graph.topics().items()
        why = nothing_came(topic, self.graph.ends(topic), known, tried, when, condition)
        before = 0 if tried else sum(each.count for each in self.recorder.named(topic))
        return why + too_early(topic, before)


def _checked(given: type[Message], topic: Topic) -> type[Message]:
    from robolink.message import type_hash

    if type_hash(given) != topic.type_hash:
        there = topic.type_name + (" of another definition" if given.__ros_type__ == topic.type_name else "")
        raise ExpectationError(f"{topic.name} has the type {there}, not {given.__ros_type__}")
    return given


EVERYBODYS_TOPICS = ("/parameter_events", "/rosout")
"""Topics that every node has."""
EVERYBODYS_SERVICES = ("rcl_interfaces/", "type_description_interfaces/")
"""Prefixes of the types of services that every node has."""


class GraphView:
    """The graph as one node sees it, without that node and without what every node has."""

    def __init__(self, own: Node) -> None:
        self._own, self._graph = own, own.context.graph
        self.own_name = own.get_fully_qualified_name()

    def nodes(self) -> list[str]:
        """Return the full names of all nodes, sorted."""
        return sorted({each.full_node_name for each in self._graph.nodes()} - {self.own_name})

    def topics(self) -> dict[str, str]:
        """Return the types of all topics by name; several types of one topic are separated by a comma."""
        named = {name: (self.ends(name), types) for name, types in self._own.get_topic_names_and_types()}
        return {
            name: ", ".join(types)
            for name, (ends, types) in named.items()
            if (ends.publishers or ends.subscribers) and name not in EVERYBODYS_TOPICS
        }

    def services(self) -> dict[str, str]:
        """Return the types of all services by name."""
        return {
            each.name: each.type_name
            for each in self._graph.endpoints(EndpointKind.SERVICE)
            if each.full_node_name != self.own_name and not each.type_name.startswith(EVERYBODYS_SERVICES)
        }

    def ends(self, name: str) -> Ends:
        """Return the nodes that publish a topic and those that subscribe to it."""
        publishers = self._graph.endpoints(EndpointKind.PUBLISHER, name=name)
        subscriptions = self._graph.endpoints(EndpointKind.SUBSCRIPTION, name=name)
        return Ends(
            tuple(sorted({each.full_node_name for each in publishers} - {self.own_name})),
            tuple(sorted({each.full_node_name for each in subscriptions} - {self.own_name})),
            tuple(sorted({each.type_name for each in (*publishers, *subscriptions)})),
        )

    def heard_by_publishers_of(self, name: str) -> list[str]:
        """Return the topics to which the publishers of a topic subscribe: the inputs that it is made of."""
        publishers = set(self.ends(name).publishers)
        subscriptions = self._graph.endpoints(EndpointKind.SUBSCRIPTION)
        return sorted({each.name for each in subscriptions if each.full_node_name in publishers} - {*EVERYBODYS_TOPICS})


class Conversation:
    """Publishers of the test's own node, and the lists that fill with messages for the test."""

    def __init__(self, node: Node, story: Story) -> None:
        self._node, self._story = node, story
        self._subscriptions: list[tuple[TopicQueue, list[Any], type[Message] | None]] = []
        self._publishers: dict[tuple[str, type[Message]], Publisher[Any]] = {}

    def publish(self, topic: str, message: Message, qos: QoSProfile | int) -> None:
        """Publish a message. Raises TypeError if `message` is not a message."""
        __tracebackhide__ = True
        if not isinstance(topic, str) or isinstance(message, type) or not hasattr(message, "__ros_fields__"):
            raise TypeError(f"publish takes a topic and a message, got {topic!r} and {message!r}")
        key = (self._node.resolve_topic_name(topic), type(message))
        if key not in self._publishers:
            self._publishers[key] = self._node.create_publisher(type(message), key[0], qos)
        self._publishers[key].publish(message)
        self._story.note_said(key[0])

    def keep(self, topic: str, given: type[Message] | None) -> list[Any]:
        """Return a list that fills at each `hear` with what is published from now on, of the class `given` if any."""
        heard: list[Any] = []
        self._subscriptions.append((self._story.recorder.listen(self._node.resolve_topic_name(topic)), heard, given))
        self.hear()
        return heard

    def hear(self) -> None:
        """Move messages that have arrived into the lists."""
        for queue, heard, given in self._subscriptions:
            heard.extend(self._story.decoded(topic, sample.payload, given) for topic, sample in queue.take())

    @property
    def topics(self) -> list[str]:
        """The topics that are recorded, then those that the test publishes."""
        return [*(queue.name for queue, _, _ in self._subscriptions), *(name for name, _ in self._publishers)]

    def close(self) -> None:
        """Stop recording."""
        self._subscriptions.clear()
