"""What a test is told when something did not come true: what was expected, what there was instead, and how to replay.

ExpectationError (AssertionError)      something did not come, or came that must not
└─ NodeFailure                         a program of the system failed
OnlyInMemoryError (NotImplementedError) processes cannot do what programs in memory can
ClosedError (RuntimeError)             something was asked of a system that is over
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from robolink.exceptions import RobolinkError
from robolink.names import near
from robolink.testing.timeline import Moment, table

MOST_NAMES = 12
"""Topics that are listed when there is none of a name."""


class ExpectationError(RobolinkError, AssertionError):
    """What a test expected of a system did not come true; the text says what was there instead."""


class NodeFailure(ExpectationError):  # noqa: N818 - it is what has happened, and an AssertionError
    """A program of the system failed: a callback of it raised, or it ended with an exit code."""


class OnlyInMemoryError(RobolinkError, NotImplementedError):
    """Something was asked of processes that only programs in memory can do; pytest skips the test with the reason."""


class ClosedError(RobolinkError, RuntimeError):
    """Something was asked of a system that is over."""


class Ends(NamedTuple):
    """Who has to do with a topic or service: names of nodes."""

    given: tuple[str, ...]
    """Who publishes or serves it."""
    taken: tuple[str, ...]
    """Who subscribes to it or calls it."""
    types: tuple[str, ...]


class Told(NamedTuple):
    """The parts of what a test is told."""

    headline: str
    begin_ns: int
    moments: Sequence[Moment] = ()
    unheard: Sequence[str] = ()
    faults: Sequence[str] = ()
    real_time: Sequence[str] = ()
    replay: str = ""

    def __str__(self) -> str:
        parts = [self.headline]
        if self.moments:
            parts.append("what came last:\n" + table(self.moments, self.begin_ns))
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
    """Say why what was expected of a topic did not come: `known` are the topics there are, with their types."""
    wanted = condition or "the condition"
    if tried == 1:
        return f"the only message on {name} did not fulfil {wanted} {when}"
    if tried:
        return f"none of the {tried} messages on {name} fulfilled {wanted} {when}"
    if ends.given:
        return f"nothing came on {name} {when}, which {_and(ends.given)} may publish"
    if ends.taken:
        listen = "listens" if len(ends.taken) == 1 else "listen"
        return f"nobody publishes {name} [{', '.join(ends.types)}], to which {_and(ends.taken)} {listen} {when}"
    return no_such("topic", name, known, when)


def too_early(name: str, earlier: int) -> str:
    """Say that messages came before they were expected; '' of none."""
    does = "does" if earlier == 1 else "do"
    return f"; {earlier} came before and {does} not count: begin messages('{name}') before" if earlier else ""


def no_such(kind: str, name: str, known: Iterable[tuple[str, str]], when: str) -> str:
    """Say that there is no topic or service of a name, and what there is, with types."""
    there = dict(known)
    listed = [f"{each} [{there[each]}]" for each in sorted(there)]
    more = f" and {len(listed) - MOST_NAMES} more" if len(listed) > MOST_NAMES else ""
    instead = f"there are: {', '.join(listed[:MOST_NAMES])}{more}" if listed else "there is none at all"
    return f"there is no {kind} {name}{near(name, there)} {when}; {instead}"


def seconds(value: float) -> str:
    """Spell seconds for people."""
    return f"{value:.3f}".rstrip("0").rstrip(".") + " s"


def span(begin: float, end: float) -> str:
    """Say from when to when something was waited for."""
    return f"within {seconds(end - begin)} (from {seconds(begin)} to {seconds(end)})"


def named(condition: Callable[..., object] | None) -> str:
    """Give the name of a condition, for people; '' for a lambda."""
    name = getattr(condition, "__name__", "")
    return "" if name == "<lambda>" else name


def _and(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
