"""What a test has go wrong in a system on purpose, in plain words: messages, connections, programs and clocks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, TypeVar

import msgspec

from robolink.faults.description import ClockFault, Crash, MessageFault, Partition
from robolink.faults.file import mistakes_of
from robolink.faults.patterns import listed, mistake_in
from robolink.testing.stage import Named

if TYPE_CHECKING:
    from robolink.faults import FaultReport
    from robolink.faults.injector import Fault

F = TypeVar("F", MessageFault, Partition, Crash, ClockFault)

Names: TypeAlias = str | Named | Sequence[str | Named]
"""One name or several, or nodes; `*` stands for any letters of one token of a name, `**` for any number of tokens."""


class Striking(Protocol):
    """Has faults strike the programs of a system."""

    def now(self) -> float:
        """Give the seconds of the run."""

    def add(self, fault: Fault) -> FaultReport | None:
        """Have a fault from now on; give what tells what it does to messages."""

    def read(self, path: str | PathLike[str]) -> None:
        """Have all that a file of faults says."""

    def clear(self) -> None:
        """Have no faults of messages and connections any more."""


class Faults:
    """Faults that a test adds: each holds from now on, or `during` so many seconds, or until `clear`.

    They lie between programs: what a program says to itself never travels. `sender` and `receiver` are nodes, any when
    not given. With `service`, the name is that of a service, whose requests and answers are meant. What a test looks at
    (`expect`, `messages`) is what was published: faults strike later, on the way to each node. A value that cannot be
    raises ValueError.
    """

    def __init__(self, striking: Striking) -> None:
        self._striking = striking

    def lose(
        self,
        topic: Names,
        share: float,
        *,
        burst: float | None = None,
        sender: Names = (),
        receiver: Names = (),
        service: bool = False,
        during: float | None = None,
    ) -> FaultReport | None:
        """Lose this share of the messages of a topic; with `burst`, in runs of so many on average."""
        way = self._way(topic, service, sender, receiver, during)
        return self._striking.add(_checked(MessageFault(**way, loss=share, burst=burst)))

    def delay(
        self,
        topic: Names,
        seconds: float,
        *,
        jitter: float = 0.0,
        reorder: bool = False,
        sender: Names = (),
        receiver: Names = (),
        service: bool = False,
        during: float | None = None,
    ) -> FaultReport | None:
        """Have messages of a topic come later by so many seconds, more or less by up to `jitter`.

        They keep their order unless `reorder`.
        """
        way = self._way(topic, service, sender, receiver, during)
        return self._striking.add(_checked(MessageFault(**way, latency=seconds, jitter=jitter, reorder=reorder)))

    def duplicate(
        self,
        topic: Names,
        share: float,
        *,
        sender: Names = (),
        receiver: Names = (),
        service: bool = False,
        during: float | None = None,
    ) -> FaultReport | None:
        """Have this share of the messages of a topic come twice."""
        way = self._way(topic, service, sender, receiver, during)
        return self._striking.add(_checked(MessageFault(**way, duplication=share)))

    def partition(self, *groups: Names, during: float | None = None) -> FaultReport | None:
        """Part nodes: those of different groups do not reach each other.

        Of one group alone, all other nodes are the second.
        """
        between = [_given(each) for each in groups]
        if not between:
            raise ValueError("partition: expected a group of nodes or several, got none")
        if len(between) == 1:
            between.append("**")
        names = [each.lstrip("/") for group in between for each in listed(group)]
        if twice := next((each for each in names if names.count(each) > 1), None):
            raise ValueError(f"partition: '{twice}' is named twice, so that nobody is parted from it")
        return self._striking.add(_checked(Partition(between=[*between], **self._times(during))))

    def crash(self, node: str | Named, *, after: float = 0.0, restart_after: float | None = None) -> None:
        """Kill a node's program `after` so many seconds, and start it again `restart_after` so many more."""
        if not after >= 0:
            raise ValueError(f"after: expected seconds, 0 or more, got {after!r}")
        at = self._striking.now() + after
        self._striking.add(_checked(Crash(node=_name_of(node), at=at, restart_after=restart_after)))

    def skew(self, node: Names, seconds: float = 0.0, *, drift: float = 0.0) -> None:
        """Give nodes that start from now on a clock that is ahead by so many seconds, and gains `drift` per second."""
        self._striking.add(_checked(ClockFault(node=_given(node), offset=seconds, drift=drift)))

    def read(self, path: str | PathLike[str]) -> None:
        """Have all that a file of faults says, as `robolink simulate --faults` does; its times begin with the system.

        Raises DocumentError with `file:line:column`.
        """
        self._striking.read(path)

    def clear(self) -> None:
        """Have messages come again as they should. What is on its way still arrives when it would have."""
        self._striking.clear()

    def _way(self, name: Names, service: bool, sender: Names, receiver: Names, during: float | None) -> dict[str, Any]:
        kind = "service" if service else "topic"
        return {kind: _given(name), "from_": _given(sender), "to": _given(receiver), **self._times(during)}

    def _times(self, during: float | None) -> dict[str, Any]:
        if during is not None and not during > 0:
            raise ValueError(f"during: expected seconds, more than 0, got {during!r}")
        now = self._striking.now()
        return {"after": now, "until": None if during is None else now + during}


def _given(names: Names) -> str | list[str]:
    if isinstance(names, (list, tuple)):
        return [_name_of(each) for each in names]
    return _name_of(names)


def _name_of(given: Any) -> str:
    if isinstance(given, Named) and not isinstance(given, type):
        return given.get_fully_qualified_name()
    if isinstance(given, str):
        return given
    raise TypeError(f"expected a name or several, got {given!r}")


def _checked(fault: F) -> F:
    """Give a fault, since it can be: as strict as a file of faults, but one of no effect is none. Raises ValueError."""
    __tracebackhide__ = True
    told: dict[str, Any] = msgspec.to_builtins(fault)
    try:
        msgspec.convert(told, type(fault))
    except msgspec.ValidationError as error:
        what, _, key = str(error).replace("`", "").partition(" - at $.")
        expected = what.partition(", got")[0].replace("Expected", "expected")
        raise ValueError(f"{key}: {expected}, got {told.get(key)!r}") from None
    for key, mistake in mistakes_of(fault) if isinstance(fault, MessageFault) else ():
        if key:
            raise ValueError(f"{key}: {mistake}")
    for mistake in filter(None, map(mistake_in, _names_in(told))):
        raise ValueError(mistake)
    return fault


def _names_in(told: Any) -> Iterable[str]:
    if isinstance(told, str):
        yield told
    elif isinstance(told, (list, dict)):
        for each in told.values() if isinstance(told, dict) else told:
            yield from _names_in(each)
