"""What a system says of itself when something did not come true."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

from robolink.testing.expectations import Ends, ExpectationError, Told, nothing_came
from robolink.testing.recorder import Recorder, Topic
from robolink.testing.timeline import MOST_LOGS, MOST_OF_ONE, MOST_OF_OTHERS, Moment, logs_of, messages_of
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.graph import Graph
    from robolink.message import Message
    from robolink.node import Node
    from robolink.testing.stage import Stage

EVERYBODYS_TOPICS = ("/parameter_events", "/rosout")
EVERYBODYS_SERVICES = ("rcl_interfaces/", "type_description_interfaces/")
"""How the types begin of services that every node has."""


class Reporting:
    """The part of a system that knows what was last published, by whom, and what it is made of."""

    def __init__(self, stage: Stage, replay: str) -> None:
        self._stage, self._replay = stage, replay
        self.recorder = Recorder(stage.session(), stage.domain, stage.now_ns)
        """What was last published on each topic."""
        self._classes: dict[str, type[Message]] = {}

    @property
    def time(self) -> float:
        """Seconds since the beginning of the system."""
        raise NotImplementedError

    @property
    def node(self) -> Node:
        """The test's own node."""
        return self._stage.node

    @property
    def own_name(self) -> str:
        """The name of the test's own node."""
        return self.node.get_fully_qualified_name()

    def nodes_here(self) -> list[Node]:
        """Give the nodes that live in this process, the test's own included."""
        return self._stage.nodes()

    @property
    def graph(self) -> Graph:
        """What everybody announces."""
        return self.node.context.graph

    # What messages are

    def _decoded(self, topic: Topic, payload: bytes, given: type[Message] | None = None) -> Any:
        from robolink.serialization import deserialize_message

        return deserialize_message(payload, self._class_of(topic) if given is None else _checked(given, topic))

    def _class_of(self, topic: Topic) -> type[Message]:
        """Give the class of a topic. Raises TypeLookupError."""
        found = self._classes.get(topic.key)
        if found is None:
            found = self._stage.class_of(topic) or self._looked_up(topic)
            self._classes[topic.key] = found
        return found

    def _looked_up(self, topic: Topic) -> type[Message]:
        from robolink.type_lookup import type_of

        return type_of(self.node.context, topic.token)

    # Who is there

    def _ends(self, name: str) -> Ends:
        """Give who publishes a topic and who subscribes to it, but the test."""
        publishers = self.graph.endpoints(EndpointKind.PUBLISHER, name=name)
        subscriptions = self.graph.endpoints(EndpointKind.SUBSCRIPTION, name=name)
        own = self.own_name
        return Ends(
            tuple(sorted({each.full_node_name for each in publishers} - {own})),
            tuple(sorted({each.full_node_name for each in subscriptions} - {own})),
            tuple(sorted({each.type_name for each in (*publishers, *subscriptions)})),
        )

    def _known_topics(self) -> Iterator[tuple[str, str]]:
        for name, types in self.node.get_topic_names_and_types():
            ends = self._ends(name)
            if (ends.given or ends.taken) and name not in EVERYBODYS_TOPICS:
                yield name, ", ".join(types)

    def _known_services(self) -> Iterator[tuple[str, str]]:
        served = self.graph.endpoints(EndpointKind.SERVICE)
        for each in served:
            if each.full_node_name != self.own_name and not each.type_name.startswith(EVERYBODYS_SERVICES):
                yield each.name, each.type_name

    def _heard_by(self, node: str) -> list[str]:
        """Name the topics that a node subscribes to."""
        all_ends = self.graph.endpoints(EndpointKind.SUBSCRIPTION)
        return sorted({each.name for each in all_ends if each.full_node_name == node} - set(EVERYBODYS_TOPICS))

    # What is told

    def story(self) -> str:
        """Tell what was last published on each topic, what was logged, what failed, and how to replay it."""
        topics = [each.name for each in self.recorder.topics.values() if each.name not in EVERYBODYS_TOPICS]
        return self._told(f"the system after {self.time:.3f} s", topics)

    def _nothing_came(self, name: str, tried: int, when: str, condition: str) -> str:
        return nothing_came(name, self._ends(name), self._known_topics(), tried, when, condition)

    def _told(self, headline: str, topics: Iterable[str], *, all_logs: bool = False) -> str:
        """Put together what a test is told: the first topic is what it is about."""
        stage = self._stage
        moments = [
            each
            for number, name in enumerate(topics)
            for topic in self.recorder.named(name)
            for each in messages_of(self.recorder, topic, self._class_of, MOST_OF_OTHERS if number else MOST_OF_ONE)
        ]
        moments += logs_of(stage.logs, MOST_LOGS, all_logs)
        moments += [Moment(each.time_ns, "failed", each.program, each.why) for each in stage.failures]
        return str(Told(headline, stage.begin_ns, moments, stage.fault_reports(), stage.real_time_use(), self._replay))

    def _since(self, time_ns: int) -> float:
        """Turn the system's nanoseconds into seconds since its beginning."""
        return (time_ns - self._stage.begin_ns) / 1e9


def _checked(given: type[Message], topic: Topic) -> type[Message]:
    from robolink.message import type_hash

    if type_hash(given) != topic.type_hash:
        there = topic.type_name + (" of another definition" if given.__ros_type__ == topic.type_name else "")
        raise ExpectationError(f"{topic.name} has the type {there}, not {given.__ros_type__}")
    return given
