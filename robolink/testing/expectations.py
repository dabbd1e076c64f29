"""Errors and texts for a test whose expectation failed: what was expected, what came instead, and how to replay.

ExpectationError (AssertionError)      something did not come, or came that must not
└─ NodeFailure                         a program of the system failed
OnlyInMemoryError (NotImplementedError) processes cannot do what programs in memory can
ClosedError (RuntimeError)             something was asked of a system that is over
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from robolink.exceptions import RobolinkError
from robolink.message.one_line import WIDTH, short
from robolink.system.terminal import shown
from robolink.text.names import near

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
    for heard in list(topic.retained)[-most:]:
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


MOST_NAMES = 12
"""Upper bound of the topics that are listed when there is none of a name."""


class ExpectationError(RobolinkError, AssertionError):
    """An expectation of a test did not come true; the text has what came instead."""


class NodeFailure(ExpectationError):  # noqa: N818 - it is what has happened, and an AssertionError
    """A program of the system failed: a callback of it raised, or it ended with an exit code."""


class OnlyInMemoryError(RobolinkError, NotImplementedError):
    """Something was asked of processes that only programs in memory can do; pytest skips the test with the reason."""


class ClosedError(RobolinkError, RuntimeError):
    """Something was asked of a system that is over."""


class Ends(NamedTuple):
    """The nodes at both ends of a topic, by full name."""

    publishers: tuple[str, ...]
    """Nodes that publish it."""
    subscribers: tuple[str, ...]
    """Nodes that subscribe to it."""
    types: tuple[str, ...]


class FailureText(NamedTuple):
    """The parts of a failure's text; `str` joins them."""

    headline: str
    begin_ns: int
    events: Sequence[Event] = ()
    unheard: Sequence[str] = ()
    faults: Sequence[str] = ()
    real_time: Sequence[str] = ()
    replay: str = ""

    def __str__(self) -> str:
        parts = [self.headline]
        if self.events:
            parts.append("what came last:\n" + table(self.events, self.begin_ns))
        parts += self.unheard
        if self.faults:
            parts.append("faults: " + "; ".join(self.faults))
        if self.real_time:
            parts.append(f"real time was used, which is virtual here: {'; '.join(self.real_time)}")
        if self.replay:
            parts.append(f"replay: {self.replay}")
        return "\n".join(parts)


def nothing_came(
    name: str, ends: Ends, known: Iterable[tuple[str, str]], tried: int, when: str, condition: str = ""
) -> str:
    """Return why no message came on a topic: `known` are the existing topics with their types."""
    criterion = condition or "the condition"
    if tried == 1:
        return f"the only message on {name} did not fulfil {criterion} {when}"
    if tried:
        return f"none of the {tried} messages on {name} fulfilled {criterion} {when}"
    if ends.publishers:
        return f"nothing came on {name} {when}, which {_and(ends.publishers)} may publish"
    if ends.subscribers:
        listen = "listens" if len(ends.subscribers) == 1 else "listen"
        return f"nobody publishes {name} [{', '.join(ends.types)}], to which {_and(ends.subscribers)} {listen} {when}"
    return no_such("topic", name, known, when)


def too_early(name: str, earlier: int) -> str:
    """Return a note that messages came before they were expected; '' for none."""
    does = "does" if earlier == 1 else "do"
    return f"; {earlier} came before and {does} not count: begin messages('{name}') before" if earlier else ""


def no_such(kind: str, name: str, known: Iterable[tuple[str, str]], when: str) -> str:
    """Return that there is no topic or service of a name, and which there are, with types."""
    there = dict(known)
    listed = [f"{each} [{there[each]}]" for each in sorted(there)]
    more = f" and {len(listed) - MOST_NAMES} more" if len(listed) > MOST_NAMES else ""
    instead = f"there are: {', '.join(listed[:MOST_NAMES])}{more}" if listed else "there is none at all"
    return f"there is no {kind} {name}{near(name, there)} {when}; {instead}"


def seconds(value: float) -> str:
    """Format seconds for people."""
    return f"{value:.3f}".rstrip("0").rstrip(".") + " s"


def span(begin: float, end: float) -> str:
    """Format the interval of a wait."""
    return f"within {seconds(end - begin)} (from {seconds(begin)} to {seconds(end)})"


def named(condition: Callable[..., object] | None) -> str:
    """Return the name of a condition for people; '' for a lambda."""
    name = getattr(condition, "__name__", "")
    return "" if name == "<lambda>" else name


def _and(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
