"""The topics that a test itself publishes, and those that it records in lists."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robolink.message import Message
    from robolink.node import Node
    from robolink.publisher import Publisher
    from robolink.qos import QoSProfile
    from robolink.testing.recorder import TopicQueue
    from robolink.testing.story import Story


class Conversation:
    """Publishers of the test's own node, and the lists that fill with messages for the test."""

    def __init__(self, node: Node, story: Story) -> None:
        self._node, self._story = node, story
        self._kept: list[tuple[TopicQueue, list[Any], type[Message] | None]] = []
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
        self._kept.append((self._story.recorder.listen(self._node.resolve_topic_name(topic)), heard, given))
        self.hear()
        return heard

    def hear(self) -> None:
        """Move messages that have arrived into the lists."""
        for queue, heard, given in self._kept:
            heard.extend(self._story.decoded(topic, sample.payload, given) for topic, sample in queue.take())

    @property
    def topics(self) -> list[str]:
        """The topics that are recorded, then those that the test publishes."""
        return [*(queue.name for queue, _, _ in self._kept), *(name for name, _ in self._publishers)]

    def close(self) -> None:
        """Stop recording."""
        self._kept.clear()
