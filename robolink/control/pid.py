"""A PID controller for a loop that runs at any rate: limited output, no windup, a filtered derivative.

pid = Pid(kp=2.0, ki=0.5, kd=0.1, limits=(-1.0, 1.0), filter_time=0.05)
speed = pid.update(setpoint=0.5, measurement=0.43, dt=0.1)

With e = setpoint - measurement the output is kp e + the integral of ki e - kd d(measurement)/dt, and then limited.
What makes it serve outside of a textbook is as in Åström and Murray, "Feedback Systems", chapter "PID Control"
(sections "Integral Windup" and "Implementation"):

- the derivative is that of the measurement, so that a step of the setpoint does not kick, behind a first-order
  filter with the time constant `filter_time`, so that noise does not;
- windup is kept away by clamping: the integral grows towards a limit only until the output has reached it, is free
  to go the other way, and never lies outside of the limits itself;
- `change` hands over from old gains to new ones without a bump of the output.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from robolink.exceptions import RobolinkError


class PidError(RobolinkError, ValueError):
    """Gains, limits or a filter time that are not valid."""


class Gains(NamedTuple):
    """Gains of the parallel form: `kp` proportional, `ki` integral (1/s) and `kd` derivative (s)."""

    kp: float
    ki: float = 0.0
    kd: float = 0.0


class Pid:
    """PID controller: brings a measurement to a setpoint.

    Args:
        kp: Proportional gain.
        ki: Integral gain, in 1/s.
        kd: Derivative gain, in s.
        limits: The least and the greatest output.
        filter_time: Time constant of the derivative's filter in seconds; 0: no filter.
        angle: True: setpoint and measurement are radians, and the error is the shorter way round the circle.

    Raises:
        PidError: (a ValueError) if a gain is not finite, the filter time below 0, or the limits in the wrong order.
    """

    def __init__(
        self,
        kp: float,
        ki: float = 0.0,
        kd: float = 0.0,
        *,
        limits: tuple[float, float] = (-math.inf, math.inf),
        filter_time: float = 0.0,
        angle: bool = False,
    ) -> None:
        self._gains = _checked(Gains(kp, ki, kd))
        self.low, self.high = limits
        if not self.low < self.high:
            raise PidError(f"limits: expected the least and then the greatest output, got {self.low} and {self.high}")
        if not 0.0 <= filter_time < math.inf:
            raise PidError(f"filter_time: expected 0 or more seconds, got {filter_time}")
        self.filter_time, self.angle = filter_time, angle
        self.ignored = 0
        """Number of updates that were ignored, since a value was not finite or no time had passed."""
        self.reset()

    @property
    def gains(self) -> Gains:
        """The present gains."""
        return self._gains

    def reset(self, output: float = 0.0) -> None:
        """Start again without a measurement; at an error of 0 the output starts at `output`, within the limits."""
        self.integral = self._limited(output if math.isfinite(output) else 0.0)
        """Integral part of the output, in its unit: ki is included."""
        self.output = self.integral
        self._error = self._rate = 0.0
        self._measured: float | None = None

    def update(self, setpoint: float, measurement: float, dt: float) -> float:
        """Return the output for a new measurement.

        A value that is not finite, or a `dt` of 0 or less, is ignored: the output stays as it was, and `ignored`
        counts. The first measurement has no derivative.

        Args:
            setpoint: The wanted value.
            measurement: The measured value, in the same unit.
            dt: Seconds since the last measurement.
        """
        if not (math.isfinite(setpoint) and math.isfinite(measurement) and 0.0 < dt < math.inf):
            return self._ignore()
        error = self._difference(setpoint, measurement)
        moved = 0.0 if self._measured is None else self._difference(measurement, self._measured)
        rate = (self.filter_time * self._rate + moved) / (self.filter_time + dt)
        rest = self._gains.kp * error - self._gains.kd * rate
        integral = self._integrated(self._gains.ki * error * dt, rest)
        if not math.isfinite(rest + integral):
            return self._ignore()
        self._error, self._rate, self._measured, self.integral = error, rate, measurement, integral
        self.output = self._limited(rest + integral)
        return self.output

    def change(self, kp: float | None = None, ki: float | None = None, kd: float | None = None) -> None:
        """Change gains without a bump: if nothing else changes, the output stays the same (bumpless transfer).

        The integral takes over what the other parts lose or gain, as far as the limits allow.

        Args:
            kp: The new proportional gain; None keeps it.
            ki: The new integral gain, in 1/s; None keeps it.
            kd: The new derivative gain, in s; None keeps it.

        Raises:
            PidError: if a gain is not finite.
        """
        old = self._gains
        given = {name: value for name, value in (("kp", kp), ("ki", ki), ("kd", kd)) if value is not None}
        new = _checked(old._replace(**given))
        handed_over = (old.kp - new.kp) * self._error - (old.kd - new.kd) * self._rate
        self._gains = new
        if math.isfinite(handed_over):
            self.integral = self._limited(self.integral + handed_over)

    def _integrated(self, growth: float, rest: float) -> float:
        """Return the integral after a step: it does not push the output, with the `rest` of it, beyond a limit."""
        integral = self.integral + growth
        if growth > 0.0:
            integral = min(integral, max(self.integral, self.high - rest))
        else:
            integral = max(integral, min(self.integral, self.low - rest))
        return self._limited(integral)

    def _difference(self, one: float, other: float) -> float:
        if self.angle:
            return math.remainder(math.remainder(one, math.tau) - math.remainder(other, math.tau), math.tau)
        return one - other

    def _limited(self, value: float) -> float:
        return min(self.high, max(self.low, value))

    def _ignore(self) -> float:
        self.ignored += 1
        return self.output


def _checked(gains: Gains) -> Gains:
    for name, value in gains._asdict().items():
        if not math.isfinite(value):
            raise PidError(f"{name}: expected a finite gain, got {value}")
    return gains
