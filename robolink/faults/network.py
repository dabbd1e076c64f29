"""In-memory network with fault injection: messages come late, twice or not at all."""

from __future__ import annotations

import functools
import random
from collections.abc import Callable, Sequence
from hashlib import blake2b
from typing import NamedTuple, Protocol

import msgspec

from robolink.faults.delivery import Link, LinkFault, Window, window
from robolink.faults.description import (
    ClockFault,
    Crash,
    FaultReport,
    MessageFault,
    Partition,
    Unmet,
    Why,
    exact,
    fits_any,
    has_pattern,
    listed,
    matcher,
)
from robolink.text.names import near
from robolink.transport.memory import Bus
from robolink.wire import parse_key


def uniform(seed: int, *names: str) -> Callable[[], float]:
    """Return a function that draws from [0, 1), its numbers determined by the seed and the names alone.

    Only `random` of Python's Mersenne Twister is used, which is the same in every version and on every machine.
    """
    text = "\0".join((str(seed), *names))
    return random.Random(int.from_bytes(blake2b(text.encode(), digest_size=16).digest(), "big")).random


class Scheduler(Protocol):
    """Protocol of a scheduler on a time base: VirtualTime."""

    @property
    def _now(self) -> int:
        """Monotonic time in ns, as an attribute for what reads it for each message."""

    def steady(self) -> int:
        """Return the monotonic time in ns."""

    def at(self, time_ns: int, act: Callable[[], object]) -> object:
        """Call `act()` at a time in ns."""


class Session(Protocol):
    """Protocol of a program's session, which receives through the faults of the network."""

    def reroute(self) -> None:
        """Route what is received through the current faults."""


class Name(NamedTuple):
    """Name of a topic or of a service."""

    text: str
    of_service: bool


class _LinkKey(NamedTuple):
    """Two programs, and the topic or service that connects them."""

    sender: str
    receiver: str
    name: Name


class _Rule(NamedTuple):
    """A fault of messages, ready to be matched with links."""

    fault: MessageFault
    identity: str
    when: Window
    report: FaultReport

    @property
    def is_idle(self) -> bool:
        """True if it changes nothing: a test may ask for a loss of 0."""
        fault = self.fault
        return not (fault.loss or fault.duplication or fault.latency or fault.jitter)

    @property
    def names(self) -> tuple[str, ...]:
        """All names in it."""
        fault = self.fault
        return tuple(name for each in (fault.topic, fault.service, fault.from_, fault.to) for name in listed(each))

    def may_meet(self, name: Name) -> bool:
        fault, service = self.fault, listed(self.fault.service)
        if name.of_service:
            return not fault.topic and matcher(service)(name.text)
        return not service and matcher(listed(fault.topic))(name.text)

    def concerns(self, sender: set[str], receiver: set[str]) -> bool:
        sources, targets = listed(self.fault.from_), listed(self.fault.to)
        return (not sources or fits_any(sources, sender)) and (not targets or fits_any(targets, receiver))


class _PartitionRule(NamedTuple):
    """A partition, ready to be matched with links."""

    groups: tuple[tuple[str, ...], ...]
    when: Window
    report: FaultReport

    @property
    def names(self) -> tuple[str, ...]:
        """All names in it."""
        return tuple(name for group in self.groups for name in group)

    def parts(self, one: set[str], other: set[str]) -> bool:
        first, second = self._group(one), self._group(other)
        return first is not None and second is not None and first != second

    def _group(self, names: set[str]) -> int | None:
        return next((number for number, group in enumerate(self.groups) if fits_any(group, names)), None)


class FaultyNetwork:
    """Shared state of a system's sessions: the bus, the faults on it, and the names of the programs.

    A fault is between programs, that is between processes: what a program sends to itself never travels. The seed and
    the names in a fault decide all that it draws, for each sender, receiver and topic apart.

    Args:
        bus: Bus that carries the messages.
        time: Scheduler on the time of the run.
        seed: Seed of all random numbers.
    """

    def __init__(self, bus: Bus, time: Scheduler, *, seed: int = 0) -> None:
        self.bus, self.time, self.seed = bus, time, seed
        self.start = time.steady()
        self.programs: dict[str, set[str]] = {}
        """Names by which faults may call a program: its own and those of its nodes."""
        self.senders: dict[bytes, str] = {}
        """Program of each endpoint, by the 16 bytes that accompany its messages."""
        self._rules: list[_Rule] = []
        self._partition_rules: list[_PartitionRule] = []
        self._cleared: list[Unmet] = []
        self._sessions: list[Session] = []
        self._names: set[Name] = set()
        self._links: dict[_LinkKey, Link | None] = {}
        self._earlier: dict[_LinkKey, Link] = {}
        self._faults: dict[tuple[str, _LinkKey], LinkFault] = {}

    def add(self, fault: MessageFault | Partition, shown: str = "") -> FaultReport:
        """Add a `fault`, its times those of the run; return the report of its effects, in which `shown` is its name."""
        report = FaultReport(shown or spelled(fault))
        if isinstance(fault, MessageFault):
            identity = _identity(fault)
            same = sum(each.identity.partition("#")[0] == identity for each in self._rules)
            when = window(fault.after, fault.until, self.start)
            self._rules.append(_Rule(fault, f"{identity}#{same}", when, report))
        else:
            groups = tuple(map(listed, fault.between))
            self._partition_rules.append(_PartitionRule(groups, window(fault.after, fault.until, self.start), report))
        self.reroute()
        return report

    def clear(self) -> None:
        """Remove all faults, and note which had no effect. A message under way still arrives."""
        self._cleared = [each for each in self.unmet() if each.why is not Why.TOO_EARLY]
        self._rules.clear()
        self._partition_rules.clear()
        self._faults.clear()
        self.reroute()

    @property
    def reports(self) -> list[FaultReport]:
        """Effects of each fault so far."""
        return [*(each.report for each in self._rules), *(each.report for each in self._partition_rules)]

    def join(self, session: Session, program: str, node: str = "") -> None:
        """Register `session`, a session of `program`, or one more name of the program: that of a `node`."""
        if session not in self._sessions:
            self._sessions.append(session)
        names = self.programs.setdefault(program, {program})
        if node and node not in names:
            names.add(node)
            if self._rules or self._partition_rules:
                self.reroute()

    def leave(self, session: Session) -> None:
        """Unregister `session`, which was closed."""
        if session in self._sessions:
            self._sessions.remove(session)

    def reroute(self) -> None:
        """Route all that is received through the current faults."""
        self._earlier.update({key: link for key, link in self._links.items() if link is not None})
        self._links.clear()
        for session in self._sessions:
            session.reroute()

    def name(self, key: str, *, of_service: bool) -> Name:
        """Return the topic's or service's (`of_service`) name in `key`, and remember it for `unmet`."""
        name = Name(parse_key(key).name, of_service)
        self._names.add(name)
        return name

    def may_meet(self, name: Name) -> bool:
        """True if any fault may concern what is sent under `name`."""
        return bool(self._partition_rules) or any(each.may_meet(name) for each in self._rules)

    def link(self, sender: bytes, receiver: str, name: Name) -> Link | None:
        """Return the link of `name` from the endpoint `sender` to the program `receiver`; None if it has no fault."""
        return self._link(_LinkKey(self.senders.get(sender, ""), receiver, name))

    def link_back(self, sender: str, receiver: bytes, name: Name) -> Link | None:
        """Return the link of `name` from the program `sender` back to the endpoint `receiver`, its caller."""
        return self._link(_LinkKey(sender, self.senders.get(receiver, ""), name))

    def _link(self, key: _LinkKey) -> Link | None:
        if key not in self._links:
            self._links[key] = self._new_link(key) if key.sender != key.receiver else None
        return self._links[key]

    def _new_link(self, key: _LinkKey) -> Link | None:
        ends = [self.programs.get(each, set()) for each in (key.sender, key.receiver)]
        faults = [
            self._link_fault(each, key) for each in self._rules if each.may_meet(key.name) and each.concerns(*ends)
        ]
        partitions = [(each.when, each.report) for each in self._partition_rules if each.parts(*ends)]
        return Link(faults, partitions, self._earlier.get(key)) if faults or partitions else None

    def _link_fault(self, rule: _Rule, key: _LinkKey) -> LinkFault:
        """Return a fault's draws between two programs; they go on where they were if there were any before."""
        known = rule.identity, key
        if known not in self._faults:
            sender, receiver, (name, of_service) = key
            about = rule.identity, sender, receiver, name, "service" if of_service else "topic"
            fault = msgspec.structs.replace(rule.fault, duplication=0.0) if of_service else rule.fault
            draws = functools.partial(uniform, self.seed, *about)
            self._faults[known] = LinkFault(fault, rule.when, draws, rule.report)
        return self._faults[known]

    def unmet(self) -> list[Unmet]:
        """Return the faults that had no effect so far, or that name what was never there, each with the reason."""
        added: list[_Rule | _PartitionRule] = [*self._rules, *self._partition_rules]
        return [*self._cleared, *filter(None, map(self._unmet, added))]

    def _unmet(self, added: _Rule | _PartitionRule) -> Unmet | None:
        rule, report = added if isinstance(added, _Rule) else None, added.report
        wrong = self.wrong_node(added.names) if rule is None else self._wrong_name(rule.fault)
        if (rule is not None and rule.is_idle) or (report.met and not wrong):
            return None
        said = f"{report.fault} {'met something, but' if report.met else 'met nothing:'} "
        if added.when[0] >= self.time.steady():
            return Unmet(said + (wrong or "the run ended before"), Why.TOO_EARLY)
        if wrong:
            return Unmet(said + wrong, Why.WRONG_NAME)
        vain = Unmet(said + "nothing went that way (what stays within a process never travels)", Why.IN_VAIN)
        return vain._replace(why=Why.WILD) if has_pattern(added.names) else vain

    def _wrong_name(self, fault: MessageFault) -> str:
        for kind, expected in (("topic", fault.topic), ("service", fault.service)):
            known = sorted(each.text for each in self._names if each.of_service is (kind == "service"))
            if missing := _missing(expected, known):
                return f"no {kind} '{missing}' was received by any node{near('/' + missing.lstrip('/'), known)}"
        return self.wrong_node((*listed(fault.from_), *listed(fault.to)))

    def wrong_node(self, names: str | Sequence[str]) -> str:
        """Return which of `names` no node has had so far, with the nearest; '' if each had one, or has wildcards."""
        known = sorted({name for each in self.programs.values() for name in each})
        missing = _missing(names, known)
        return f"no node was ever named '{missing}'{near(missing.lstrip('/'), known)}" if missing else ""


def _missing(expected: str | Sequence[str], known: Sequence[str]) -> str:
    """Return the first exact name that is none of the known ones; '' if there is none."""
    return next((each for each in exact(expected) if not any(map(matcher((each,)), known))), "")


def _identity(fault: MessageFault) -> str:
    """Return the names in a fault: with the same names its draws stay the same, whatever else it has."""
    return "|".join(" ".join(listed(each)) for each in (fault.topic, fault.service, fault.from_, fault.to))


def spelled(fault: MessageFault | Partition | Crash | ClockFault) -> str:
    """Return a fault as its file would spell it, without defaults."""
    plain = msgspec.to_builtins(fault)
    usual = {each.encode_name: each.default for each in msgspec.structs.fields(fault)}
    given = {key: value for key, value in plain.items() if value not in (usual[key], [], None)}
    return "{" + ", ".join(f"{key}: {_plainly(value)}" for key, value in given.items()) + "}"


def _plainly(value: object) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(map(_plainly, value)) + "]"
    return f"{value:g}" if isinstance(value, float) else str(value).lower() if isinstance(value, bool) else str(value)
