"""Publish the messages of one of several topics, which services select.

robolink run topic_tools mux cmd_vel auto_cmd_vel joy_cmd_vel
"""

from __future__ import annotations

from typing import Any

from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.topic_tools.choice import NONE, Choice, Kinds
from robolink.counterparts.topic_tools.topic_tool import TopicTool
from robolink.interfaces.topic_tools_interfaces.srv import MuxAdd, MuxDelete, MuxList, MuxSelect
from robolink.parameters.descriptors import described


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


def parameters(words: list[str]) -> dict[str, Any]:
    """Return the parameters of a command line. Raises UsageError."""
    if len(words) == 1:
        raise UsageError("1 argument: expected mux OUTTOPIC INTOPIC [INTOPIC]...")
    return {"output_topic": words[0], "input_topics": words[1:]} if words else {}


def main(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""
    spin_program(lambda words: Mux(parameters=parameters(words)), args)


if __name__ == "__main__":
    main()
