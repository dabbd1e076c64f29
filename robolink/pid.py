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
    """Gains, limits or a filter time that no controller can have."""


class Gains(NamedTuple):
    """Proportional, integral (1/s) and derivative (s) gain, as factors of their own: the parallel form."""

    kp: float
    ki: float = 0.0
    kd: float = 0.0


class Pid:
    """Steers a measurement to a setpoint.

    `limits` are the least and the greatest output, `filter_time` is in seconds (0: no filter). With `angle` setpoint
    and measurement are radians, and the way from one to the other is the short one round the circle. Raises
    PidError, a ValueError, for gains that are not finite, a filter time below 0, or limits in the wrong order.
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
        """How many updates were ignored, since a value was not finite or no time had passed."""
        self.reset()

    @property
    def gains(self) -> Gains:
        """The gains that hold now."""
        return self._gains

    def reset(self, output: float = 0.0) -> None:
        """Begin anew, with nothing measured yet; at an error of 0 the output begins at `output`, within the limits."""
        self.integral = self._limited(output if math.isfinite(output) else 0.0)
        """What the integral adds to the output: in its unit, with ki in it."""
        self.output = self.integral
        self._error = self._rate = 0.0
        self._measured: float | None = None

    def update(self, setpoint: float, measurement: float, dt: float) -> float:
        """Give the output for a measurement that comes `dt` seconds after the last one.

        What is not finite, or does not lie after the last one (`dt` of 0 or less), is ignored: the output stays as it
        was, and `ignored` counts. Without a measurement before it there is no derivative yet.
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
        """Go on with other gains, without a bump: were nothing else to change, the output would stay the same.

        The integral takes over what the other parts lose or win, as far as the limits let it. Raises PidError.
        """
        old = self._gains
        given = {name: value for name, value in (("kp", kp), ("ki", ki), ("kd", kd)) if value is not None}
        new = _checked(old._replace(**given))
        handed_over = (old.kp - new.kp) * self._error - (old.kd - new.kd) * self._rate
        self._gains = new
        if math.isfinite(handed_over):
            self.integral = self._limited(self.integral + handed_over)

    def _integrated(self, growth: float, rest: float) -> float:
        """Give the integral after a step: it does not push the output, with the `rest` of it, beyond a limit."""
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
