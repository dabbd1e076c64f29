"""Faults that a test injects by method calls: into messages, connections, programs and clocks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, TypeVar

import msgspec

from robolink import logging
from robolink.faults import FaultReport, Injector, read_faults
from robolink.faults.description import (
    ClockFault,
    Crash,
    MessageFault,
    Partition,
    fits_any,
    is_pattern,
    listed,
    mistake_in,
)
from robolink.faults.file import mistakes_of
from robolink.faults.injector import Fault
from robolink.testing.stage import Named

if TYPE_CHECKING:
    from robolink.host import Host
    from robolink.host.supervision import Supervision

F = TypeVar("F", MessageFault, Partition, Crash, ClockFault)

Names: TypeAlias = str | Named | Sequence[str | Named]
"""One name or several, or nodes; `*` stands for any letters of one token of a name, `**` for any number of tokens."""


class FaultTarget(Protocol):
    """Protocol of what applies faults to the programs of a system."""

    def now(self) -> float:
        """Return the time of the run in seconds."""

    def add(self, fault: Fault) -> FaultReport | None:
        """Apply a fault from now on; return the report of its effects on messages, if it is a fault of messages."""

    def read(self, path: str | PathLike[str]) -> None:
        """Apply all faults of a file."""

    def clear(self) -> None:
        """Remove all faults of messages and connections."""


class Faults:
    """Fault injection for a test: each fault holds from now on, for `during` seconds if given, or until `clear`.

    Faults act between programs: a message inside of one program never travels. What a test observes (`expect`,
    `messages`) is what was published: faults act later, on the way to each node.

    Names of topics, services and nodes may have wildcards: `*` for any letters of one token, `**` for any number of
    tokens; several names are a list. With ``zenoh`` all methods but `clear` raise OnlyInMemoryError.
    """

    def __init__(self, target: FaultTarget) -> None:
        self._target = target

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
        """Lose some of the messages of a topic or service.

        Args:
            topic: Name of the topic (or service), or several.
            share: Probability of loss of each message, from 0 to 1.
            burst: Mean length of a run of lost messages, 1 or more; None loses each message independently.
            sender: Nodes whose messages are concerned; any by default.
            receiver: Nodes on the way to which messages are lost; any by default.
            service: True if `topic` names a service, whose requests and responses are meant.
            during: Duration in seconds; None means until `clear`.

        Returns:
            Counts of what was lost, which follow the run.

        Raises:
            ValueError: if a value is out of range, or a name has a mistake.
        """
        way = self._way(topic, service, sender, receiver, during)
        return self._target.add(_checked(MessageFault(**way, loss=share, burst=burst)))

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
        """Delay the messages of a topic or service.

        Args:
            topic: Name of the topic (or service), or several.
            seconds: Delay in seconds.
            jitter: Largest deviation from the delay in seconds, more or less, drawn for each message.
            reorder: True lets messages overtake each other; by default they keep their order.
            sender: Nodes whose messages are concerned; any by default.
            receiver: Nodes on the way to which messages are delayed; any by default.
            service: True if `topic` names a service, whose requests and responses are meant.
            during: Duration in seconds; None means until `clear`.

        Returns:
            Counts of what was delayed, which follow the run.

        Raises:
            ValueError: if a value is out of range, or a name has a mistake.
        """
        way = self._way(topic, service, sender, receiver, during)
        return self._target.add(_checked(MessageFault(**way, latency=seconds, jitter=jitter, reorder=reorder)))

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
        """Deliver some of the messages of a topic or service twice.

        Args:
            topic: Name of the topic (or service), or several.
            share: Probability that a message comes twice, from 0 to 1.
            sender: Nodes whose messages are concerned; any by default.
            receiver: Nodes on the way to which messages are duplicated; any by default.
            service: True if `topic` names a service, whose requests and responses are meant.
            during: Duration in seconds; None means until `clear`.

        Returns:
            Counts of what was duplicated, which follow the run.

        Raises:
            ValueError: if a value is out of range, or a name has a mistake.
        """
        way = self._way(topic, service, sender, receiver, during)
        return self._target.add(_checked(MessageFault(**way, duplication=share)))

    def partition(self, *groups: Names, during: float | None = None) -> FaultReport | None:
        """Partition the network: nodes of different groups do not reach each other.

        Args:
            groups: Each a node or several. Of one group alone, all other nodes are the second.
            during: Duration in seconds; None means until `clear`.

        Returns:
            Counts of what was lost, which follow the run.

        Raises:
            ValueError: if no group is given, a name is in two groups, or a value is out of range.
        """
        between = [_given(each) for each in groups]
        if not between:
            raise ValueError("partition: expected a group of nodes or several, got none")
        if len(between) == 1:
            between.append("**")
        names = [each.lstrip("/") for group in between for each in listed(group)]
        if twice := next((each for each in names if names.count(each) > 1), None):
            raise ValueError(f"partition: '{twice}' is named twice, so that nobody is parted from it")
        return self._target.add(_checked(Partition(between=[*between], **self._times(during))))

    def crash(self, node: str | Named, *, after: float = 0.0, restart_after: float | None = None) -> None:
        """Kill a node's program, as `kill -9` does.

        Args:
            node: The node, or its name.
            after: Seconds from now until it is killed.
            restart_after: Seconds from then until it is started again; None leaves that to its launch file's rules.

        Raises:
            ValueError: if a value is out of range, or the name has a mistake.
        """
        if not after >= 0:
            raise ValueError(f"after: expected seconds, 0 or more, got {after!r}")
        at = self._target.now() + after
        self._target.add(_checked(Crash(node=_name_of(node), at=at, restart_after=restart_after)))

    def skew(self, node: Names, seconds: float = 0.0, *, drift: float = 0.0) -> None:
        """Set a wrong clock for nodes that start from now on.

        Args:
            node: The nodes, or their names.
            seconds: Offset of their clock in seconds; positive is ahead.
            drift: Error of its rate in seconds gained per second, from -0.1 to 0.1.

        Raises:
            ValueError: if a value is out of range, or a name has a mistake.
        """
        self._target.add(_checked(ClockFault(node=_given(node), offset=seconds, drift=drift)))

    def read(self, path: str | PathLike[str]) -> None:
        """Apply all faults of a file, as `robolink simulate --faults` does.

        Args:
            path: Path of the file. Its times count from the system's beginning.

        Raises:
            DocumentError: if the file has a mistake, with `file:line:column`.
        """
        self._target.read(path)

    def clear(self) -> None:
        """Remove all faults of messages and connections. A message under way still arrives when it would have."""
        self._target.clear()

    def _way(self, name: Names, service: bool, sender: Names, receiver: Names, during: float | None) -> dict[str, Any]:
        kind = "service" if service else "topic"
        return {kind: _given(name), "from_": _given(sender), "to": _given(receiver), **self._times(during)}

    def _times(self, during: float | None) -> dict[str, Any]:
        if during is not None and not during > 0:
            raise ValueError(f"during: expected seconds, more than 0, got {during!r}")
        now = self._target.now()
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
    """Return a fault if it is valid: as strict as a file of faults, but one of no effect is none. Raises ValueError."""
    __tracebackhide__ = True
    values: dict[str, Any] = msgspec.to_builtins(fault)
    try:
        msgspec.convert(values, type(fault))
    except msgspec.ValidationError as error:
        what, _, key = str(error).replace("`", "").partition(" - at $.")
        expected = what.partition(", got")[0].replace("Expected", "expected")
        raise ValueError(f"{key}: {expected}, got {values.get(key)!r}") from None
    for key, mistake in mistakes_of(fault) if isinstance(fault, MessageFault) else ():
        if key:
            raise ValueError(f"{key}: {mistake}")
    for mistake in filter(None, map(mistake_in, _names_in(values))):
        raise ValueError(mistake)
    return fault


def _names_in(values: Any) -> Iterable[str]:
    if isinstance(values, str):
        yield values
    elif isinstance(values, (list, dict)):
        for each in values.values() if isinstance(values, dict) else values:
            yield from _names_in(each)


class Runner(Protocol):
    """Protocol of what runs the programs in this process."""

    host: Host
    expected: set[str]
    """Names of the programs that are to end."""

    def supervision_of(self, program: str) -> Supervision | None:
        """Return the supervision of a program that a launch file started; None of another."""


class ProgramFaults:
    """The faults of a test: an injector applies those of messages and clocks, and crashes programs by this."""

    def __init__(self, stage: Runner, seed: int) -> None:
        self._stage, self._host = stage, stage.host
        self._clocks: list[ClockFault] = []
        self.injector = Injector(self._host.bus, self._host.time, self, seed=seed)

    # Called by tests

    def now(self) -> float:
        """Return the time of the run in seconds."""
        return self._host.now

    def add(self, fault: Fault) -> FaultReport | None:
        """Apply a fault from now on."""
        if isinstance(fault, ClockFault):
            self._clocks.append(fault)
            self._warn_of_running(listed(fault.node))
        return self.injector.add(fault)

    def _warn_of_running(self, nodes: Sequence[str]) -> None:
        names = self.injector.network.programs
        for each in nodes:
            running = (name for name, program in self._host.programs.items() if program.state == "running")
            if not is_pattern(each) and any(fits_any((each,), names.get(name, ())) for name in running):
                warning = f"{each} runs already: its clock is wrong once it is started anew"
                logging.get_logger("robolink.testing").warning(warning)

    def warn_of_right_clock(self, program: str, node: str) -> None:
        """Warn if a clock was to be wrong, but the node's name was not known before it was made with a right one."""
        for each in self._clocks:
            if fits_any(listed(each.node), {node}) and not fits_any(listed(each.node), {program}):
                warning = f"{node} has a right clock: its name was not known before; start it with name='{node}'"
                logging.get_logger("robolink.testing").warning(warning)

    def read(self, path: str | PathLike[str]) -> None:
        """Apply all faults of a file."""
        faults = read_faults(path).value
        self._clocks += faults.clocks
        self.injector.add_all(faults)

    def clear(self) -> None:
        """Remove all faults of messages and connections."""
        self.injector.network.clear()

    # Called by the injector

    def at(self, seconds: float, act: Callable[[], object]) -> None:
        """Call `act()` at a time of the run in seconds."""
        self._host.at(seconds, act)

    def crash(self, name: str, *, is_restarted: bool) -> bool:
        """End a program at once; True if it ran. Its rules count unless the fault starts it again."""
        runs = self._host.program(name).state == "running"
        self._stage.expected.add(name)
        supervision = self._stage.supervision_of(name)
        if supervision is None:
            self._host.crash(name)
        else:
            supervision.crash(name, is_restarted=is_restarted)
        self._stage.expected.discard(name)
        return runs

    def restart(self, name: str) -> None:
        """Start a program anew."""
        supervision = self._stage.supervision_of(name)
        (self._host if supervision is None else supervision).restart(name)
