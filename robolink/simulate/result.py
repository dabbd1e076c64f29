"""Result of a simulated run: a Struct for machines, lines for people."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import msgspec

from robolink.faults import FaultReport
from robolink.geometry.plane import Area

SHOWN = 40
"""Most topics listed. Robots: all if there are at most SHOWN // 2, else the first SHOWN // 4."""


class RobotResult(msgspec.Struct, frozen=True):
    """True state of a robot of a simulated world in the end.

    Args:
        name: Name of the robot.
        driven: Length of its way, in metres.
        contacts: Number of contacts.
        x: Position in metres.
        y: Position in metres.
        theta: Heading in radians.
        area: Box in which it stayed, in metres.
    """

    name: str
    driven: float
    contacts: int
    x: float
    y: float
    theta: float
    area: Area


class ProgramResult(msgspec.Struct, frozen=True):
    """Outcome of a program."""

    name: str
    """Name in the launch file."""
    state: str
    """State in the end."""
    crashes: int = 0
    """Number of crashes by faults."""
    restarts: int = 0
    """Number of restarts."""
    error: str = ""
    """Last error, '' for none."""


class SimulationResult(msgspec.Struct, frozen=True, kw_only=True):
    """Result of a run: its seed and length, what happened, and the hash of all that was published."""

    file: str = ""
    """Launch file."""
    seed: int
    """Seed of the run."""
    seconds: float
    """Simulated seconds."""
    real_seconds: float
    """Seconds that the run took."""
    messages: dict[str, int]
    """Number of messages by topic."""
    bytes: dict[str, int]
    """Bytes of payload by topic."""
    robots: list[RobotResult] = []
    """Robots of the simulated worlds."""
    programs: list[ProgramResult] = []
    """Programs of the launch file."""
    faults: list[FaultReport] = []
    """Faults of the run, with their counts."""
    real_time: list[str] = []
    """Uses of real time by nodes, a line each: they cannot be repeated."""
    errors: int = 0
    """Number of lines that were logged as errors."""
    warnings: list[str] = []
    """Warnings about the run, a line each."""
    interrupted: bool = False
    """True if Ctrl-C ended it before its time."""
    failures: list[str] = []
    """Reasons why the run counts as failed; none if it does not."""
    hash: str
    """Hash of all that was published."""

    @property
    def real_time_factor(self) -> float:
        """Simulated seconds by real second."""
        return self.seconds / self.real_seconds if self.real_seconds > 0 else math.inf

    @property
    def contacts(self) -> int:
        """Number of contacts of all robots."""
        return sum(each.contacts for each in self.robots)

    def as_json(self) -> str:
        """Return it as one line of JSON."""
        plain = {**msgspec.to_builtins(self), "real_time_factor": round(self.real_time_factor, 1)}
        return msgspec.json.encode(plain).decode()

    def lines(self) -> Iterator[str]:
        """Yield it as lines for people."""
        pace = f"{self.real_time_factor:.0f} times as fast as life"
        yield f"{self.file}: {self.seconds:g} s in {self.real_seconds:.1f} s, {pace}; seed {self.seed}"
        yield from _of_robots(self.robots)
        yield from _of_messages(self.messages, sum(self.bytes.values()))
        yield from (line for each in self.programs for line in _of_program(each))
        yield from (f"fault {each}" for each in self.faults)
        yield from (f"real time: {each}" for each in self.real_time)
        yield from (f"warning: {each}" for each in self.warnings)
        yield from (f"failed: {each}" for each in self.failures)
        yield f"hash {self.hash}"


def failed_by(result: SimulationResult, kinds: Iterable[str]) -> SimulationResult:
    """Return a result that counts as failed for more reasons.

    Args:
        result: Result of a run.
        kinds: What else is a failure: ``contact`` of a robot, ``error`` (one that is logged), ``real-time``.

    Returns:
        The result with a failure more for each such event.
    """
    said = {
        "contact": [f"{each.name} had {_counted(each.contacts, 'contact')}" for each in result.robots if each.contacts],
        "error": [f"{_counted(result.errors, 'error')} logged"] if result.errors else [],
        "real-time": [f"real time: {each}" for each in result.real_time],
    }
    more = [each for kind in kinds for each in said[kind]]
    return msgspec.structs.replace(result, failures=[*result.failures, *more])


def _of_robots(robots: Sequence[RobotResult]) -> Iterator[str]:
    shown = robots[: SHOWN // 4] if len(robots) > SHOWN // 2 else robots
    yield from map(_of_robot, shown)
    if others := robots[len(shown) :]:
        driven, contacts = sum(each.driven for each in others), sum(each.contacts for each in others)
        yield f"{len(others)} more robots: drove {driven:.2f} m, {_counted(contacts, 'contact')}"


def _of_robot(robot: RobotResult) -> str:
    where = f"({robot.x:.2f}, {robot.y:.2f}), heading {math.degrees(robot.theta):.0f} degrees"
    drove = f"drove {robot.driven:.2f} m within {robot.area.width:.2f} x {robot.area.height:.2f} m"
    return f"{robot.name}: {drove}, {_counted(robot.contacts, 'contact')}, ends at {where}"


def _of_messages(messages: dict[str, int], size: int) -> Iterator[str]:
    sent = {name: count for name, count in messages.items() if count}
    yield f"{_counted(sum(sent.values()), 'message')} on {_counted(len(sent), 'topic')}, {size / 1e6:.1f} MB"
    shown = list(sent.items())[:SHOWN]
    widest = max((len(name) for name, _ in shown), default=0)
    yield from (f"  {name:<{widest}} {count:>9}" for name, count in shown)
    if others := len(sent) - len(shown):
        yield f"  ... and {_counted(others, 'more topic')}: --json has all"


def _of_program(program: ProgramResult) -> Iterator[str]:
    if program.crashes or program.restarts:
        crashed = f", crashed {_counted(program.crashes, 'time')} by faults" if program.crashes else ""
        again = f", started again {_counted(program.restarts, 'time')}" if program.restarts else ""
        yield f"{program.name}: {program.state}{crashed}{again}"


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"
