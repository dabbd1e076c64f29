"""Reader of faults files, with the checks that types alone cannot express, and their JSON schema for editors."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from typing import Any, NamedTuple

from robolink.documents.json_schema import schema_of
from robolink.documents.mistakes import Step
from robolink.documents.yamlfile import Document, read
from robolink.exceptions import nearest
from robolink.faults.description import FaultsDescription, MessageFault, Names, is_pattern, listed, matcher, mistake_in

_EFFECTS = ("loss", "duplication", "latency", "jitter")


class _Problem(NamedTuple):
    """A mistake in the file, and the steps that lead there."""

    steps: list[Step]
    message: str


def read_faults(path: str | os.PathLike[str], *, text: str | None = None) -> Document[FaultsDescription]:
    """Read a faults file.

    Args:
        path: Path of the file, also its name in errors.
        text: Text to read in place of the file's.

    Raises:
        DocumentError: with `file:line:column`, for invalid YAML, an unknown key, a value of the wrong type or out of
            its range, an invalid name, or a fault without effect or that cannot be.
        TypeError: if `path` is not one, but the faults themselves.
    """
    given: Any = path  # a list of faults is what people try first
    if not isinstance(given, (str, os.PathLike)):
        kind = type(given).__name__
        raise TypeError(f"faults are the path of a file, got a {kind}: write them into one, or call `system.faults`")
    document = read(path, FaultsDescription, text=text)
    for steps, message in _problems(document.value):
        raise document.error(steps, message)
    return document


def check_nodes(document: Document[FaultsDescription], known: Collection[str]) -> None:
    """Raise an error if a fault names a node that the system lacks. A pattern may match none: nodes may come later.

    Args:
        document: The faults file.
        known: Names of the system's nodes.

    Raises:
        DocumentError: with `file:line:column` and the nearest name.
    """
    for steps, pattern in _nodes(document.value):
        if not is_pattern(pattern) and not any(map(matcher((pattern,)), known)):
            near = nearest(pattern.lstrip("/"), [each.lstrip("/") for each in known])
            raise document.error(steps, f"no node named '{pattern}'{near}")


def mistakes_of(fault: MessageFault) -> Iterator[tuple[str, str]]:
    """Yield, as (key, mistake), what types cannot express of a fault of messages."""
    if fault.topic and fault.service:
        yield "service", "a fault is on topics or on services: make two of it"
    if not any(getattr(fault, each) for each in _EFFECTS):
        yield "", f"this does nothing: give {', '.join(_EFFECTS[:-1])} or {_EFFECTS[-1]}"
    if fault.duplication and fault.service:
        yield "duplication", "a call is never doubled, only late or lost"
    if fault.reorder and not fault.jitter:
        yield "reorder", "without jitter nothing overtakes"
    if fault.burst is not None:
        yield from _mistakes_of_burst(fault.loss, fault.burst)
    yield from _mistakes_of_window(fault.after, fault.until)


def _mistakes_of_burst(loss: float, burst: float) -> Iterator[tuple[str, str]]:
    if not loss:
        yield "burst", "without loss there are no bursts of it"
    elif loss > burst / (1.0 + burst):
        hint = "all is lost anyway" if loss == 1.0 else f"give at least {loss / (1.0 - loss):.3g}"
        yield "burst", f"a loss of {loss:g} leaves no room between bursts of {burst:g}: {hint}"


def _mistakes_of_window(after: float, until: float | None) -> Iterator[tuple[str, str]]:
    if until is not None and not until > after:
        yield "until", f"expected a time later than {after:g} s, when it begins, got {until:g}"


def _problems(faults: FaultsDescription) -> Iterator[_Problem]:
    for index, fault in enumerate(faults.messages):
        for key, message in mistakes_of(fault):
            yield _Problem(["messages", index, key] if key else ["messages", index], message)
    for steps, name in (*_topics(faults), *_nodes(faults)):
        if mistake := mistake_in(name):
            yield _Problem(steps, mistake)
    yield from _problems_of_partitions(faults)
    yield from _problems_of_crashes(faults)
    yield from _problems_of_clocks(faults)


def _problems_of_crashes(faults: FaultsDescription) -> Iterator[_Problem]:
    for index, crash in enumerate(faults.crashes):
        if is_pattern(crash.node):
            yield _Problem(["crashes", index, "node"], f"one node crashes: '{crash.node}' may be several")


def _problems_of_clocks(faults: FaultsDescription) -> Iterator[_Problem]:
    for index, clock in enumerate(faults.clocks):
        if not clock.offset and not clock.drift:
            yield _Problem(["clocks", index], "this clock is right: give offset or drift")
    named: set[str] = set()
    for index, clock in enumerate(faults.clocks):
        for steps, name in _placed(clock.node, ["clocks", index, "node"]):
            if not is_pattern(name) and name.lstrip("/") in named:
                yield _Problem(steps, f"the clock of '{name}' is wrong already: say in one place all that it is")
            named.add(name.lstrip("/"))


def _problems_of_partitions(faults: FaultsDescription) -> Iterator[_Problem]:
    for index, partition in enumerate(faults.partitions):
        place: list[Step] = ["partitions", index]
        if len(partition.between) < 2 or not all(partition.between):
            yield _Problem([*place, "between"], "expected two groups of nodes or more, such as [[world], [follower]]")
        names = [each.lstrip("/") for group in partition.between for each in listed(group)]
        if twice := next((each for each in names if names.count(each) > 1), None):
            yield _Problem([*place, "between"], f"'{twice}' is named twice")
        for key, message in _mistakes_of_window(partition.after, partition.until):
            yield _Problem([*place, key], message)


def _topics(faults: FaultsDescription) -> Iterator[tuple[list[Step], str]]:
    for index, fault in enumerate(faults.messages):
        yield from _placed(fault.topic, ["messages", index, "topic"])
        yield from _placed(fault.service, ["messages", index, "service"])


def _nodes(faults: FaultsDescription) -> Iterator[tuple[list[Step], str]]:
    """Yield each name of a node, with its place in the file."""
    for index, fault in enumerate(faults.messages):
        yield from _placed(fault.from_, ["messages", index, "from"])
        yield from _placed(fault.to, ["messages", index, "to"])
    for index, partition in enumerate(faults.partitions):
        for number, group in enumerate(partition.between):
            yield from _placed(group, ["partitions", index, "between", number])
    for index, crash in enumerate(faults.crashes):
        yield from _placed(crash.node, ["crashes", index, "node"])
    for index, clock in enumerate(faults.clocks):
        yield from _placed(clock.node, ["clocks", index, "node"])


def _placed(names: Names, steps: list[Step]) -> Iterator[tuple[list[Step], str]]:
    if isinstance(names, str):
        yield steps, names
    else:
        yield from (([*steps, number], each) for number, each in enumerate(names))


MEANINGS = {
    "FaultsDescription.description": "What the faults are like, in one line.",
    "FaultsDescription.seed": "Seed of their random numbers, unless the run itself is given one.",
    "FaultsDescription.messages": "Losses, delays and duplications of messages.",
    "FaultsDescription.partitions": "Partitions of the network.",
    "FaultsDescription.crashes": "Crashes of nodes.",
    "FaultsDescription.clocks": "Wrong clocks of nodes.",
    "MessageFault.topic": "Topics, as name or pattern; all by default.",
    "MessageFault.service": "Services, as name or pattern.",
    "MessageFault.from": "Nodes that send; all by default.",
    "MessageFault.to": "Nodes that receive; all by default.",
    "MessageFault.loss": "Probability of a loss, 0 to 1.",
    "MessageFault.burst": "Messages that are lost in a row, on average.",
    "MessageFault.duplication": "Probability that a message comes twice, 0 to 1.",
    "MessageFault.latency": "Delay in seconds.",
    "MessageFault.jitter": "Seconds by which the delay varies, up and down.",
    "MessageFault.reorder": "True: messages may overtake each other.",
    "Partition.between": "Groups of nodes that do not reach each other.",
    "Crash.node": "Node whose process is killed.",
    "Crash.at": "When, in seconds of the run.",
    "Crash.restart_after": "Seconds until it is started again; without it the launch file's rules apply.",
    "ClockFault.node": "Nodes whose clock is wrong.",
    "ClockFault.offset": "Seconds that the clock is ahead; negative: behind.",
    "ClockFault.drift": "Seconds that the clock gains in each second.",
    "after": "When it begins, in seconds of the run.",
    "until": "When it ends, in seconds of the run; its end by default.",
}
"""Descriptions of keys, which editors show: by Struct and key, or by a key that means the same in several."""


def faults_schema() -> dict[str, Any]:
    """Return the schema as plain data."""
    return schema_of(FaultsDescription, "Faults of robolink simulate", MEANINGS)
