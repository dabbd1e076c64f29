"""Table of the last events for people: messages, log lines and ends of programs, in order of time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from robolink.exceptions import RobolinkError
from robolink.message.one_line import WIDTH, short
from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.logging import Record
    from robolink.message import Message
    from robolink.testing.recorder import Recorder, Topic

MOST_OF_ONE = 8
"""Upper bound of the messages shown of the topic that a failure is about."""
MOST_OF_OTHERS = 3
"""Upper bound of the messages shown of any other topic."""
MOST_OF_BACKGROUND = 1
"""Upper bound of the messages shown of a topic that is busy in any system, and seldom what a failure is about."""
BACKGROUND = ("/clock", "/diagnostics", "/tf", "/tf_static")
"""Topics that are busy in any system."""
MOST_LOGS = 5
"""Upper bound of the log lines shown, unless all are asked for."""


class Event(NamedTuple):
    """An event at a time in ns, on a topic or of a program, and its sender.

    `number` is the place of a message among all that came; log lines and ends of the same time stand behind them.
    """

    time_ns: int
    what: str
    who: str
    text: str
    number: float = float("inf")


def table(events: Iterable[Event], begin_ns: int) -> str:
    """Format events as a table in order of time; times are in seconds since `begin_ns`."""
    ordered = sorted(events, key=lambda each: (each.time_ns, each.number))
    rows = [(f"{(each.time_ns - begin_ns) / 1e9:.3f} s", each.what, each.who, each.text) for each in ordered]
    widths = [max((len(row[column]) for row in rows), default=0) for column in range(3)]
    return "\n".join(
        f"  {when:>{widths[0]}}  {what:<{widths[1]}}  {who:<{widths[2]}}  {text}".rstrip()
        for when, what, who, text in rows
    )


def messages_of(
    recorder: Recorder, topic: Topic, class_of: Callable[[Topic], type[Message]], most: int
) -> Iterator[Event]:
    """Yield the last messages of a topic."""
    for heard in list(topic.kept)[-most:]:
        sample = recorder.sample(heard)
        text = _shown(sample.payload, topic, class_of)
        yield Event(heard.time_ns, topic.name, recorder.sender(sample), text, heard.number)


def _shown(payload: bytes, topic: Topic, class_of: Callable[[Topic], type[Message]]) -> str:
    from robolink.serialization import deserialize_message

    try:
        return short(deserialize_message(payload, class_of(topic))) or "(zero)"
    except RobolinkError as error:  # a type that is not installed
        return f"{len(payload)} bytes of {topic.type_name}: {shown(str(error), WIDTH)}"


def logs_of(records: Iterable[Record], most: int, everything: bool = False) -> Iterator[Event]:
    """Yield the last warnings and errors that were logged, or all lines; of one with several the last, the cause."""
    chosen = [each for each in records if everything or each.severity.value >= _WARN]
    for each in chosen[-most:]:
        lines = each.message.strip().splitlines() or [""]
        yield Event(each.stamp_ns, each.severity.name, each.name, shown(lines[-1], WIDTH))


_WARN = 30
"""Number of the severity WARN."""
