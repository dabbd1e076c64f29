"""Publish the messages of a topic on one of several others, which services select.

robolink run topic_tools demux cmd_vel left/cmd_vel right/cmd_vel
"""

from __future__ import annotations

from typing import Any

from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.topic_tools.choice import NONE, Choice, Kinds
from robolink.counterparts.topic_tools.topic_tool import TopicTool
from robolink.interfaces.topic_tools_interfaces.srv import DemuxAdd, DemuxDelete, DemuxList, DemuxSelect
from robolink.parameters.descriptors import described


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


def parameters(words: list[str]) -> dict[str, Any]:
    """Return the parameters of a command line. Raises UsageError."""
    if len(words) == 1:
        raise UsageError("1 argument: expected demux INTOPIC OUTTOPIC [OUTTOPIC]...")
    return {"input_topic": words[0], "output_topics": words[1:]} if words else {}


def main(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""
    spin_program(lambda words: Demux(parameters=parameters(words)), args)


if __name__ == "__main__":
    main()
