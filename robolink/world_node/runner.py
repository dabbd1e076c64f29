"""Runner of a simulation by the clock: at a multiple of real time, as fast as possible, by single steps, or paused."""

from __future__ import annotations

from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.node import Node
from robolink.task import Future
from robolink.world_node.diagnostics import Rate
from robolink.world_node.pace import Pace, RateMeter
from robolink.world_node.simulation import Simulation


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
        self._asked_for: Future[bool] | None = None
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
        self._asked_for = Future()
        self._set_off(0.0, steps)
        return self._asked_for

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
        if not (self.running or self._asked_for):
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
        waiting, self._asked_for = self._asked_for, None
        if waiting is not None:
            waiting.set_result(made)
