"""What a test has go wrong in a system on purpose, in plain words: messages, connections, programs and clocks."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from robolink.faults.description import ClockFault, Crash, MessageFault, Partition

if TYPE_CHECKING:
    from robolink.faults import FaultReport
    from robolink.faults.injector import Fault

Names: TypeAlias = str | Sequence[str]
"""One name or several; `*` stands for any letters of one token of a name, `**` for any number of tokens."""


class Injector(Protocol):
    """What makes faults happen."""

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
    (`expect`, `messages`) is what was published: faults strike later, on the way to each node.
    """

    def __init__(self, injector: Injector) -> None:
        self._injector = injector

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
        return self._injector.add(MessageFault(**way, loss=share, burst=burst))

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
        return self._injector.add(MessageFault(**way, latency=seconds, jitter=jitter, reorder=reorder))

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
        return self._injector.add(MessageFault(**way, duplication=share))

    def partition(self, *groups: Names, during: float | None = None) -> FaultReport | None:
        """Part nodes: those of different groups do not reach each other.

        Of one group alone, all other nodes are the second.
        """
        between = [_given(each) for each in groups]
        if len(between) == 1:
            between.append("**")
        return self._injector.add(Partition(between=[*between], **self._times(during)))

    def crash(self, node: str, *, after: float = 0.0, restart_after: float | None = None) -> None:
        """Kill a node's program `after` so many seconds, and start it again `restart_after` so many more."""
        self._injector.add(Crash(node=node, at=self._injector.now() + after, restart_after=restart_after))

    def skew(self, node: Names, seconds: float = 0.0, *, drift: float = 0.0) -> None:
        """Give nodes that start from now on a clock that is ahead by so many seconds, and gains `drift` per second."""
        self._injector.add(ClockFault(node=_given(node), offset=seconds, drift=drift))

    def read(self, path: str | PathLike[str]) -> None:
        """Have all that a file of faults says, as `robolink simulate --faults` does; its times begin with the system.

        Raises DocumentError with `file:line:column`.
        """
        self._injector.read(path)

    def clear(self) -> None:
        """Have messages come again as they should. What is on its way still arrives when it would have."""
        self._injector.clear()

    def _way(self, name: Names, service: bool, sender: Names, receiver: Names, during: float | None) -> dict[str, Any]:
        kind = "service" if service else "topic"
        return {kind: _given(name), "from_": _given(sender), "to": _given(receiver), **self._times(during)}

    def _times(self, during: float | None) -> dict[str, Any]:
        now = self._injector.now()
        return {"after": now, "until": None if during is None else now + during}


def _given(names: Names) -> str | list[str]:
    return names if isinstance(names, str) else list(names)
