"""Nodes that choose among topics by services: mux one of several inputs, demux one of several outputs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.topic_tools.topic_tool import TopicTool
from robolink.exceptions import InvalidTopicNameException
from robolink.interfaces.topic_tools_interfaces.srv import (
    DemuxAdd,
    DemuxDelete,
    DemuxList,
    DemuxSelect,
    MuxAdd,
    MuxDelete,
    MuxList,
    MuxSelect,
)
from robolink.node import Node
from robolink.parameters.descriptors import described

NONE = "__none"
"""Name of no topic."""


class Kinds(NamedTuple):
    """Service classes of a choice."""

    add: type[Any]
    delete: type[Any]
    list: type[Any]
    select: type[Any]


class Choice:
    """The topics of a node, one of which is selected, and the services that change them.

    Args:
        node: Node that offers the services.
        kinds: Service classes.
        topics: Topics at the beginning.
        selected: The selected one; `NONE` for none.
        on_select: Called with a topic that has been selected.
        other: Topic at the node's other end: with it as a choice too, its messages would go in a circle.
    """

    def __init__(
        self,
        node: Node,
        kinds: Kinds,
        topics: list[str],
        selected: str,
        on_select: Callable[[str], None],
        *,
        other: str,
    ) -> None:
        self._other = node.resolve_topic_name(other)
        self.node, self.topics, self.selected, self._on_select = node, topics, selected, on_select
        self.name = node.get_name()
        for service in Kinds._fields:
            node.create_service(getattr(kinds, service), f"~/{service}", getattr(self, service))

    def _find(self, topic: str) -> str | None:
        """Return the topic of this name, which may be spelled in another way."""
        if not topic:
            return None
        try:
            full = self.node.resolve_topic_name(topic)
        except InvalidTopicNameException:
            return None
        return next((each for each in self.topics if self.node.resolve_topic_name(each) == full), None)

    def add(self, request: Any, response: Any) -> Any:
        """Add a topic."""
        topic, wrong = request.topic, self._fault(request.topic)
        self._say(f"trying to add {topic} to {self.name}")
        if topic == NONE:
            self._warn(f"failed to add topic {topic} to {self.name}, because it's reserved for special use")
        elif wrong:
            self._warn(f"failed to add topic {topic!r} to {self.name}: {wrong}")
        elif topic in self.topics:
            self._warn(f"tried to add a topic that {self.name} was already listening to: [{topic}]")
        else:
            self.topics.append(topic)
            self._say(f"added {topic} to {self.name}")
            response.success = True
        return response

    def delete(self, request: Any, response: Any) -> Any:
        """Remove a topic that is not selected."""
        found = self._find(request.topic)
        if found is None:
            self._warn(f"tried to delete non-subscribed topic {request.topic} from {self.name}")
        elif found == self._find(self.selected):
            self._warn(f"tried to delete currently selected topic {request.topic} from {self.name}")
        else:
            self.topics.remove(found)
            self._say(f"deleted topic {request.topic} from {self.name}")
            response.success = True
        return response

    def list(self, request: Any, response: Any) -> Any:
        """List the topics."""
        response.topics = self.topics
        return response

    def select(self, request: Any, response: Any) -> Any:
        """Select a topic, or none."""
        response.prev_topic = self.selected if self._find(self.selected) else ""
        if request.topic == NONE:
            self._say(f"{self.name} selected to no input.")
        elif self._find(request.topic) is None:
            self._warn(f"{request.topic} is none of the topics of {self.name}: add it first")
            return response
        else:
            self._say(f"{self.name} selected input: [{request.topic}]")
        self.selected, response.success = request.topic, True
        self._on_select(self.selected)
        return response

    def _fault(self, topic: str) -> str:
        """Return the reason why a text is not a topic to choose; '' if it may be one."""
        try:
            full = self.node.resolve_topic_name(topic)
        except InvalidTopicNameException as error:
            return str(error).partition("\n")[0]
        return "its messages would go in a circle" if full == self._other else ""

    def _say(self, text: str) -> None:
        self.node.get_logger().info(text)

    def _warn(self, text: str) -> None:
        self.node.get_logger().warning(text)


class Mux(TopicTool):
    """A node that passes on the messages of the selected topic. `options` are those of `TopicTool`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("mux", **options)

    def set_up(self) -> None:
        """Declare the topics, and offer the services."""
        topics = list(self.needed("input_topics", "topics to choose from", list[str]()))
        words = described("topic to publish on")
        self.output_topic = self.declare_parameter("output_topic", "~/selected", words).value
        words = described(f"topic that is selected at first; {NONE} for none")
        first = self.declare_parameter("initial_topic", "", words).value or topics[0]
        self.choice = Choice(
            self, Kinds(MuxAdd, MuxDelete, MuxList, MuxSelect), topics, first, self.on_select, other=self.output_topic
        )
        self.on_select(first)

    def on_select(self, topic: str) -> None:
        """Listen to another topic."""
        self.input_topic = "" if topic == NONE else topic
        if hasattr(self, "lazy"):
            self.look()


def mux_parameters(words: list[str]) -> dict[str, Any]:
    """Return the parameters of a command line. Raises UsageError."""
    if len(words) == 1:
        raise UsageError("1 argument: expected mux OUTTOPIC INTOPIC [INTOPIC]...")
    return {"output_topic": words[0], "input_topics": words[1:]} if words else {}


def run_mux(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""
    spin_program(lambda words: Mux(parameters=mux_parameters(words)), args)


class Demux(TopicTool):
    """A node that passes on messages to the selected topic. `options` are those of `TopicTool`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("demux", **options)

    def set_up(self) -> None:
        """Declare the topics, and offer the services."""
        self._input = self.declare_parameter("input_topic", "~/input", described("topic to listen to")).value
        topics = list(self.needed("output_topics", "topics to choose from", list[str]()))
        words = described(f"topic that is selected at first; {NONE} for none")
        first = self.declare_parameter("initial_topic", "", words).value or topics[0]
        self.choice = Choice(
            self, Kinds(DemuxAdd, DemuxDelete, DemuxList, DemuxSelect), topics, first, self.on_select, other=self._input
        )
        self.on_select(first)

    def on_select(self, topic: str) -> None:
        """Publish on another topic."""
        self.input_topic, self.output_topic = ("", "") if topic == NONE else (self._input, topic)
        if hasattr(self, "lazy"):
            self.look()


def demux_parameters(words: list[str]) -> dict[str, Any]:
    """Return the parameters of a command line. Raises UsageError."""
    if len(words) == 1:
        raise UsageError("1 argument: expected demux INTOPIC OUTTOPIC [OUTTOPIC]...")
    return {"input_topic": words[0], "output_topics": words[1:]} if words else {}


def run_demux(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""
    spin_program(lambda words: Demux(parameters=demux_parameters(words)), args)
