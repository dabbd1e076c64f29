"""A network in memory on which messages come late, doubled or not at all, as faults say."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

import msgspec

from robolink.faults.description import ClockFault, Crash, MessageFault, Partition
from robolink.faults.fate import Strand, Way, Window, window
from robolink.faults.patterns import exact, fits_any, has_pattern, listed, matcher
from robolink.faults.report import FaultReport, Unmet, Why
from robolink.faults.streams import uniform
from robolink.names import near
from robolink.transport.memory import Bus
from robolink.wire import parse_key

if TYPE_CHECKING:
    from robolink.faults.transport import FaultyTransport


class Timetable(Protocol):
    """A time base at whose times something can be done: VirtualTime."""

    def steady(self) -> int:
        """Nanoseconds that only grow."""

    def at(self, time_ns: int, act: Callable[[], object]) -> object:
        """Call `act()` at that time."""


class Name(NamedTuple):
    """A topic's or a service's."""

    text: str
    of_service: bool


class _Between(NamedTuple):
    """Two programs, and that by which they talk."""

    sender: str
    receiver: str
    name: Name


class _Rule(NamedTuple):
    """A fault of messages, ready to be asked whom it concerns."""

    fault: MessageFault
    identity: str
    when: Window
    report: FaultReport

    @property
    def is_idle(self) -> bool:
        """Whether it does nothing to what it meets: a test may ask for a loss of 0."""
        fault = self.fault
        return not (fault.loss or fault.duplication or fault.latency or fault.jitter)

    @property
    def names(self) -> tuple[str, ...]:
        """All names that it says."""
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


class _Cut(NamedTuple):
    """A partition, likewise."""

    groups: tuple[tuple[str, ...], ...]
    when: Window
    report: FaultReport

    @property
    def names(self) -> tuple[str, ...]:
        """All names that it says."""
        return tuple(name for group in self.groups for name in group)

    def parts(self, one: set[str], other: set[str]) -> bool:
        first, second = self._group(one), self._group(other)
        return first is not None and second is not None and first != second

    def _group(self, names: set[str]) -> int | None:
        return next((number for number, group in enumerate(self.groups) if fits_any(group, names)), None)


class FaultyNetwork:
    """What the sessions of a system share: the bus, the faults on it, and who is who.

    A fault is between programs, that is between processes: what a program says to itself never travels. `seed` and the
    words of a fault that say whom it concerns decide all that it draws, for each sender, receiver and topic apart.
    """

    def __init__(self, bus: Bus, time: Timetable, *, seed: int = 0) -> None:
        self.bus, self.time, self.seed = bus, time, seed
        self.start = time.steady()
        self.programs: dict[str, set[str]] = {}
        """The names by which faults may call a program: its own and those of its nodes."""
        self.senders: dict[bytes, str] = {}
        """The program of each endpoint, by the 16 bytes that stand beside its messages."""
        self._rules: list[_Rule] = []
        self._cuts: list[_Cut] = []
        self._cleared: list[Unmet] = []
        self._sessions: list[FaultyTransport] = []
        self._names: set[Name] = set()
        self._ways: dict[_Between, Way | None] = {}
        self._earlier: dict[_Between, Way] = {}
        self._strands: dict[tuple[str, _Between], Strand] = {}

    def add(self, fault: MessageFault | Partition, shown: str = "") -> FaultReport:
        """Have a fault from now on, its times those of the run; give what tells what it does. `shown` names it."""
        report = FaultReport(shown or spelled(fault))
        if isinstance(fault, MessageFault):
            identity = _identity(fault)
            same = sum(each.identity.partition("#")[0] == identity for each in self._rules)
            when = window(fault.after, fault.until, self.start)
            self._rules.append(_Rule(fault, f"{identity}#{same}", when, report))
        else:
            groups = tuple(map(listed, fault.between))
            self._cuts.append(_Cut(groups, window(fault.after, fault.until, self.start), report))
        self.lead_anew()
        return report

    def clear(self) -> None:
        """Have no faults any more, and know which had met nothing. What is on its way still arrives."""
        self._cleared = [each for each in self.unmet() if each.why is not Why.TOO_EARLY]
        self._rules.clear()
        self._cuts.clear()
        self._strands.clear()
        self.lead_anew()

    @property
    def reports(self) -> list[FaultReport]:
        """What each fault has done so far."""
        return [*(each.report for each in self._rules), *(each.report for each in self._cuts)]

    def join(self, session: FaultyTransport, program: str, node: str = "") -> None:
        """Take in a program's session, or one more name that a program is called by."""
        if session not in self._sessions:
            self._sessions.append(session)
        names = self.programs.setdefault(program, {program})
        if node and node not in names:
            names.add(node)
            if self._rules or self._cuts:
                self.lead_anew()

    def leave(self, session: FaultyTransport) -> None:
        """Forget a session that was closed."""
        if session in self._sessions:
            self._sessions.remove(session)

    def lead_anew(self) -> None:
        """Lead all that is received through the faults that there are now."""
        self._earlier.update({between: way for between, way in self._ways.items() if way is not None})
        self._ways.clear()
        for session in self._sessions:
            session.lead_anew()

    def name(self, key: str, *, of_service: bool) -> Name:
        """Give the topic's or service's name of a key, and remember it for `unmet`."""
        name = Name(parse_key(key).name, of_service)
        self._names.add(name)
        return name

    def may_meet(self, name: Name) -> bool:
        """Whether any fault can be on what is sent by this name."""
        return bool(self._cuts) or any(each.may_meet(name) for each in self._rules)

    def way(self, sender: bytes, receiver: str, name: Name) -> Way | None:
        """Give what lies between an endpoint and a program on a topic or service; None if nothing does."""
        return self._between(_Between(self.senders.get(sender, ""), receiver, name))

    def way_back(self, sender: str, receiver: bytes, name: Name) -> Way | None:
        """Give what lies between a program and an endpoint that has asked it."""
        return self._between(_Between(sender, self.senders.get(receiver, ""), name))

    def _between(self, between: _Between) -> Way | None:
        if between not in self._ways:
            self._ways[between] = self._new_way(between) if between.sender != between.receiver else None
        return self._ways[between]

    def _new_way(self, between: _Between) -> Way | None:
        ends = [self.programs.get(each, set()) for each in (between.sender, between.receiver)]
        strands = [
            self._strand(each, between) for each in self._rules if each.may_meet(between.name) and each.concerns(*ends)
        ]
        cuts = [(each.when, each.report) for each in self._cuts if each.parts(*ends)]
        return Way(strands, cuts, self._earlier.get(between)) if strands or cuts else None

    def _strand(self, rule: _Rule, between: _Between) -> Strand:
        """Give a fault's part between two programs; it goes on drawing where it was if it was there before."""
        known = rule.identity, between
        if known not in self._strands:
            sender, receiver, (name, of_service) = between
            about = rule.identity, sender, receiver, name, "service" if of_service else "topic"
            fault = msgspec.structs.replace(rule.fault, duplication=0.0) if of_service else rule.fault
            draws = functools.partial(uniform, self.seed, *about)
            self._strands[known] = Strand(fault, rule.when, draws, rule.report)
        return self._strands[known]

    def unmet(self) -> list[Unmet]:
        """Say of each fault that has met nothing so far, or that names what was never there, why that may be."""
        added: list[_Rule | _Cut] = [*self._rules, *self._cuts]
        return [*self._cleared, *filter(None, map(self._unmet, added))]

    def _unmet(self, added: _Rule | _Cut) -> Unmet | None:
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
        for kind, wanted in (("topic", fault.topic), ("service", fault.service)):
            known = sorted(each.text for each in self._names if each.of_service is (kind == "service"))
            if missing := _missing(wanted, known):
                return f"no {kind} '{missing}' was received by any node{near('/' + missing.lstrip('/'), known)}"
        return self.wrong_node((*listed(fault.from_), *listed(fault.to)))

    def wrong_node(self, names: str | Sequence[str]) -> str:
        """Say which of these names no node has had so far, with the nearest; '' if each had one, or has wildcards."""
        known = sorted({name for each in self.programs.values() for name in each})
        missing = _missing(names, known)
        return f"no node was ever named '{missing}'{near(missing.lstrip('/'), known)}" if missing else ""


def _missing(wanted: str | Sequence[str], known: Sequence[str]) -> str:
    """Give the first exact name that is none of the known ones; '' if there is none."""
    return next((each for each in exact(wanted) if not any(map(matcher((each,)), known))), "")


def _identity(fault: MessageFault) -> str:
    """Give the words of a fault that say whom it concerns: with them its draws stay, whatever else it is told."""
    return "|".join(" ".join(listed(each)) for each in (fault.topic, fault.service, fault.from_, fault.to))


def spelled(fault: MessageFault | Partition | Crash | ClockFault) -> str:
    """Give a fault as its file would spell it, without what is as it usually is."""
    plain = msgspec.to_builtins(fault)
    usual = {each.encode_name: each.default for each in msgspec.structs.fields(fault)}
    given = {key: value for key, value in plain.items() if value not in (usual[key], [], None)}
    return "{" + ", ".join(f"{key}: {_plainly(value)}" for key, value in given.items()) + "}"


def _plainly(value: object) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(map(_plainly, value)) + "]"
    return f"{value:g}" if isinstance(value, float) else str(value).lower() if isinstance(value, bool) else str(value)
