"""Runner of a simulation at its pace, and what it says about itself."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from typing import NamedTuple

from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from robolink.interfaces.std_msgs.msg import Header
from robolink.node import Node
from robolink.sim import Robot, World
from robolink.task import Future
from robolink.world_node.messages import time_message
from robolink.world_node.simulation import Simulation

TURN = 0.01
"""Most simulated time of one turn, in seconds: at `rtf` 0 all other callbacks would starve."""

OFTENEST, RAREST = 0.001, 1.0
"""Shortest and longest period of looks at the clock, in seconds."""

BACKLOG = 0.5
"""Longest delay that the simulation still catches up, in seconds; the rest is given up."""

WINDOW = 3
"""Length of the window in which the real-time factor is measured, in seconds, with a mark in each."""


class Pace:
    """Pacer: counts the steps of `dt` nanoseconds that are due by the clock, without drift; with `rtf` 0 always a turn.

    `period` is the seconds between two looks at the clock. Of `left` steps all are made, and then none is due.
    """

    def __init__(self, start: int, dt: int, rtf: float, left: int | None = None) -> None:
        self.start, self.dt, self.rtf, self.left = start, dt, rtf, left
        self.turn = max(1, round(TURN * 1e9 / dt))
        self.period = min(max(OFTENEST, self.turn * dt / rtf / 1e9), RAREST) if rtf else 1e-6
        self.behind = False
        """True if more steps are due than `due` has returned: call it again after other callbacks."""
        self._done = 0

    def due(self, now: int) -> tuple[int, float]:
        """Return the number of steps to make at `now`, and the simulated seconds that are given up as too late."""
        if not self.rtf:
            return self._next_of_left(), 0.0
        late = int((now - self.start) * self.rtf) // self.dt - self._done
        if late <= self.turn:  # as nearly always
            self._done += late
            self.behind = False
            return late, 0.0
        most = max(self.turn, int(BACKLOG * 1e9 * self.rtf) // self.dt)
        given_up = max(0, late - most) * self.dt
        self.start += int(given_up / self.rtf)
        late = min(late, most)
        steps = min(late, self.turn)
        self._done += steps
        self.behind = late > steps
        return steps, given_up / 1e9

    def _next_of_left(self) -> int:
        if self.left is None:
            return self.turn
        steps = min(self.turn, self.left)
        self.left -= steps
        return steps


class RateMeter:
    """Meter of the real-time factor over the last seconds, from a mark a second."""

    def __init__(self) -> None:
        self._marks: deque[tuple[int, int]] = deque(maxlen=WINDOW + 1)

    def restart(self) -> None:
        """Drop all marks: another pace holds from now on."""
        self._marks.clear()

    def mark(self, now: int, simulated: int) -> float | None:
        """Add a mark of the time and the simulated time, in nanoseconds; return the factor, None while not known."""
        self._marks.append((now, simulated))
        then, simulated_then = self._marks[0]
        return (simulated - simulated_then) / (now - then) if now > then else None


BEHIND = 0.9
"""Share of the wanted real-time factor below which a warning says that the world falls behind."""

REPORTED = 5
"""Most robots whose poses are logged."""


class Rate(NamedTuple):
    """The real-time factor: as requested (0 is as fast as possible), and as measured; None while it is not known."""

    requested: float
    measured: float | None
    running: bool = True


def diagnostics(node_name: str, simulation: Simulation, rate: Rate) -> DiagnosticArray:
    """Return the diagnostics of a world: its real-time factor, contacts, refused commands."""
    level, message = judged(rate)
    world = simulation.world
    values = {
        "asked": f"{rate.requested:g}",
        "measured": "" if rate.measured is None else f"{rate.measured:.3g}",
        "steps": str(world.steps),
        "simulation time": f"{world.time_ns / 1e9:.3f}",
        "robots": str(len(world.robots)),
        "refused commands": str(simulation.refused),
        "contacts": str(world.contacts),
    }
    status = DiagnosticStatus(
        level=level,
        name=f"{node_name}: real-time factor",
        message=message,
        hardware_id=simulation.description.world.name,
        values=[KeyValue(key=key, value=value) for key, value in values.items()],
    )
    return DiagnosticArray(header=Header(stamp=time_message(simulation.now)), status=[status])


def judged(rate: Rate) -> tuple[bytes, str]:
    """Return the level of a rate, and a word about it."""
    if not rate.running:
        return DiagnosticStatus.OK, "paused"
    if rate.measured is None:
        return DiagnosticStatus.OK, "just started"
    if rate.measured < BEHIND * rate.requested:
        return (
            DiagnosticStatus.WARN,
            f"falls behind: {rate.measured:.3g} times real time, {rate.requested:g} is asked for",
        )
    return DiagnosticStatus.OK, f"{rate.measured:.3g} times real time"


def listed(names: Sequence[str]) -> str:
    """Return the names of robots as text, a few of them and the last if there are many."""
    if len(names) <= REPORTED + 1:
        return ", ".join(names) or "no robot"
    return f"{len(names)} robots: {', '.join(names[:REPORTED])} ... {names[-1]}"


def report(world: World) -> list[str]:
    """Return lines about the pose and motion of the first robots, and how many of the others touch something."""
    robots = list(world.robots.values())
    lines = [said(each, world.nearest_wall_distance(each.pose.x, each.pose.y)) for each in robots[:REPORTED]]
    if others := robots[REPORTED:]:
        lines.append(f"{len(others)} more robots, {sum(each.touching > 0 for each in others)} of them in contact")
    return lines


def said(robot: Robot, wall: float) -> str:
    """Return the pose and motion of a robot in words; `wall` is the distance to the nearest wall in metres, or inf."""
    pose, twist = robot.pose, robot.twist
    turning = round(math.degrees(twist.w))
    parts = [
        f"{robot.name} at ({pose.x:.2f}, {pose.y:.2f}) heading {round(math.degrees(pose.theta))} deg",
        f"{round(twist.v, 2) + 0.0:.2f} m/s",  # never -0.00
        f"{twist.sideways:.2f} m/s to the left" if abs(twist.sideways) >= 0.005 else "",
        f"turning {'left' if turning > 0 else 'right'} at {abs(turning)} deg/s" if turning else "",
        f"nearest wall {wall:.2f} m" if math.isfinite(wall) else "",
        "in contact" if robot.touching else "",
    ]
    return ", ".join(filter(None, parts))


class Runner:
    """Makes the steps of a simulation when they are due, a few in a turn, so that all other callbacks have theirs.

    `steady` is the clock that it follows, and `rtf` the real-time factor, 0 for as fast as possible: in virtual time,
    which does so by itself, that is 1.
    """

    def __init__(self, node: Node, simulation: Simulation, rtf: float) -> None:
        self.simulation, self.rtf = simulation, rtf
        self.running = True
        self.steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=node.context.time)
        self._node, self._meter = node, RateMeter()
        self._simulated = 0
        self._step_request: Future[bool] | None = None
        self._now = node.context.time.steady
        self._pace = self._new_pace(rtf)
        self._timer = node.create_timer(self._pace.period, self._on_tick, clock=self.steady)
        self._again = node.create_guard_condition(self._on_tick)

    def pause(self) -> None:
        """Pause: make no more steps."""
        self.running = False
        self._timer.cancel()
        self._pace.behind = False
        self._answer(False)

    def resume(self) -> None:
        """Resume at the pace that was set."""
        self.running = True
        self._answer(False)
        self._set_off(self.rtf)

    def set_rate(self, rtf: float) -> None:
        """Set the real-time factor, for now or once it is resumed."""
        self.rtf = rtf
        if self.running:
            self._set_off(rtf)

    def advance(self, steps: int) -> Future[bool]:
        """Make a number of steps while paused; the result is True when they are made, False if stopped before."""
        self._answer(False)
        self._step_request = Future()
        self._set_off(0.0, steps)
        return self._step_request

    def measured(self) -> Rate:
        """Return the real-time factor, measured over the last calls of this, a second apart."""
        measured = self._meter.mark(self._now(), self._simulated)
        return Rate(self.rtf, measured, self.running)

    def _new_pace(self, rtf: float, left: int | None = None) -> Pace:
        self._meter.restart()
        if not rtf and left is None:
            rtf = self._node.context.time.fastest_pace()
        return Pace(self._now(), self.simulation.world.dt_ns, rtf, left)

    def _set_off(self, rtf: float, left: int | None = None) -> None:
        self._pace = self._new_pace(rtf, left)
        self._timer.timer_period_ns = round(self._pace.period * 1e9)
        self._timer.reset()

    def _on_tick(self) -> None:
        """Make the steps that are due, at most one turn of them."""
        pace, simulation = self._pace, self.simulation
        if not (self.running or self._step_request):
            return
        steps, given_up = pace.due(self._now())
        for _ in range(steps):
            simulation.step()
        self._simulated += steps * simulation.world.dt_ns
        if pace.behind:
            self._again.trigger()
        if pace.left == 0:
            self._timer.cancel()
            self._answer(True)
        if given_up > 0.0:
            text = f"the machine is too slow for this pace: {given_up:.3f} s of simulated time are left out"
            self._node.get_logger().warning(text, throttle_duration_sec=5.0)

    def _answer(self, made: bool) -> None:
        """Set the result of `advance`: True if the steps have been made, False if they never will be."""
        waiting, self._step_request = self._step_request, None
        if waiting is not None:
            waiting.set_result(made)
