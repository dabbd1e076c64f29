"""The PID controller: the textbook's formula, limits that hold, no windup, no kick, no bump, and odd values."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import robolink
from robolink.control.pid import Pid, PidError
from robolink.exceptions import RobolinkError

gain = st.floats(-100.0, 100.0)
value = st.floats(-1e3, 1e3)
step = st.floats(1e-3, 10.0)
anything = st.floats()
samples = st.lists(st.tuples(value, value, step), max_size=30)


def test_it_is_one_of_robolinks_names() -> None:
    assert robolink.Pid is Pid


# The formula


@given(gain, gain, gain, samples)
def test_without_limits_it_is_the_textbooks(kp: float, ki: float, kd: float, samples: list[Any]) -> None:
    pid, integral, before = Pid(kp, ki, kd), 0.0, None
    for setpoint, measurement, dt in samples:
        error = setpoint - measurement
        integral += error * dt
        rate = 0.0 if before is None else (measurement - before) / dt
        before = measurement
        expected = kp * error + ki * integral - kd * rate
        size = abs(kp * error) + 100.0 * abs(kd * rate) + abs(ki) * sum((abs(a) + abs(b)) * c for a, b, c in samples)
        assert pid.update(setpoint, measurement, dt) == pytest.approx(expected, rel=1e-9, abs=1e-9 * (1.0 + size))


def test_proportional_control_of_a_first_order_plant_leaves_the_error_that_it_must() -> None:
    assert response(Pid(4.0), 20.0, 0.01)[-1] == pytest.approx(4.0 / 5.0, abs=1e-6)


@pytest.mark.parametrize("dt", [0.001, 0.01])
def test_the_step_response_is_the_closed_form(dt: float) -> None:
    """A plant y' = u - y under u = kp e + ki integral(e), with kp + 1 = 2 and ki = 1, has a double pole at -1."""
    found = response(Pid(1.0, 1.0), 5.0, dt)
    for at in range(0, len(found), 100):
        t = (at + 1) * dt
        assert found[at] == pytest.approx(1.0 - math.exp(-t), abs=2.0 * dt)


def test_the_derivative_of_a_ramp_comes_through_the_filter_with_its_time_constant() -> None:
    pid, dt, tau = Pid(0.0, kd=1.0, filter_time=0.5), 1e-4, 0.5
    outputs = [pid.update(0.0, 3.0 * k * dt, dt) for k in range(20_000)]
    for at in (2_000, 5_000, 10_000, 19_999):
        assert outputs[at] == pytest.approx(-3.0 * (1.0 - math.exp(-at * dt / tau)), abs=1e-3)


def test_an_uneven_rate_makes_no_difference_to_the_integral() -> None:
    even, uneven = Pid(0.0, 2.0), Pid(0.0, 2.0)
    for dt in (0.1,) * 10:
        even.update(1.0, 0.0, dt)
    for dt in (0.05, 0.5, 0.25, 0.2):
        uneven.update(1.0, 0.0, dt)
    assert even.output == pytest.approx(uneven.output) == pytest.approx(2.0)


def test_a_step_of_the_setpoint_does_not_kick() -> None:
    pid = Pid(1.0, kd=10.0)
    pid.update(0.0, 0.0, 0.01)
    assert pid.update(1.0, 0.0, 0.01) == 1.0


def test_the_filter_damps_noise() -> None:
    def swing(pid: Pid) -> float:
        outputs = [pid.update(0.0, 0.01 * (-1) ** k, 0.01) for k in range(100)]
        return max(outputs[50:]) - min(outputs[50:])

    assert swing(Pid(0.0, kd=1.0, filter_time=0.1)) < 0.1 * swing(Pid(0.0, kd=1.0))


def test_angles_go_the_short_way_round() -> None:
    pid = Pid(1.0, kd=0.1, angle=True)
    assert pid.update(math.radians(170), math.radians(-170), 0.1) == pytest.approx(math.radians(-20))
    turned = pid.update(math.radians(170), math.radians(170), 0.1)  # by -20 degrees
    assert turned == pytest.approx(0.1 * math.radians(20) / 0.1)
    assert Pid(1.0, angle=True).update(5 * math.tau, 0.0, 0.1) == pytest.approx(0.0, abs=1e-9)


# Limits


@given(gain, gain, gain, st.floats(0.0, 10.0), value, step, st.lists(st.tuples(anything, anything, anything)))
def test_nothing_brings_it_beyond_its_limits(
    kp: float, ki: float, kd: float, filter_time: float, low: float, width: float, samples: list[Any]
) -> None:
    pid = Pid(kp, ki, kd, limits=(low, low + width), filter_time=filter_time)
    for setpoint, measurement, dt in samples:
        output = pid.update(setpoint, measurement, dt)
        assert low <= output <= low + width
        assert low <= pid.integral <= low + width


def test_what_has_been_held_back_does_not_have_to_be_unwound() -> None:
    pid = Pid(1.0, 10.0, limits=(-1.0, 1.0))
    for _ in range(1000):
        pid.update(5.0, 0.0, 0.1)
    assert pid.output == 1.0
    assert pid.update(0.0, 0.5, 0.1) < 0.0


def test_a_limited_plant_overshoots_less_than_with_windup() -> None:
    """The same loop with an integral that knows nothing of the limits overshoots by more than half."""
    limits, dt = (-1.2, 1.2), 0.01
    with_windup = Windup(8.0, 12.0, limits)
    assert max(response(with_windup, 10.0, dt)) > 1.08
    assert max(response(Pid(8.0, 12.0, limits=limits), 10.0, dt)) < 1.02


def test_the_integral_reaches_a_limit_exactly() -> None:
    pid = Pid(0.0, 1.0, limits=(0.0, 1.0))
    assert [pid.update(1.0, 0.0, 0.4) for _ in range(4)] == pytest.approx([0.4, 0.8, 1.0, 1.0])
    assert pid.update(-1.0, 0.0, 0.4) == pytest.approx(0.6)


def test_limits_need_not_hold_zero() -> None:
    assert Pid(1.0, limits=(2.0, 3.0)).output == 2.0
    assert Pid(1.0, limits=(2.0, 3.0)).update(0.0, 0.0, 0.1) == 2.0


# Gains


@given(value, value, value, gain, gain, gain)
def test_a_change_of_gains_makes_no_bump(
    first: float, second: float, setpoint: float, kp: float, ki: float, kd: float
) -> None:
    pid, dt = Pid(1.0, 0.5, 0.2, filter_time=0.3), 1e-9  # so short that nothing else changes
    pid.update(setpoint, first, 0.1)
    before = pid.update(setpoint, second, 0.1)
    pid.change(kp, ki, kd)
    pid.filter_time = 1e9  # which keeps the derivative as it is
    size = 1.0 + (abs(first) + abs(second) + abs(setpoint)) * (abs(kp) + 100.0 * abs(kd) + abs(ki) + 10.0)
    assert pid.update(setpoint, second, dt) == pytest.approx(before, abs=1e-6 * size)
    assert pid.gains == (kp, ki, kd)


def test_a_gain_that_is_not_named_stays() -> None:
    pid = Pid(1.0, 2.0, 3.0)
    pid.change(ki=0.0)
    assert pid.gains == (1.0, 0.0, 3.0)
    with pytest.raises(PidError, match="kd: expected a finite gain, got nan"):
        pid.change(kp=5.0, kd=math.nan)
    assert pid.gains == (1.0, 0.0, 3.0)


def test_reset_begins_anew() -> None:
    pid = Pid(1.0, 2.0, 3.0, limits=(-5.0, 5.0))
    first = [pid.update(1.0, 0.3 * k, 0.1) for k in range(5)]
    pid.reset()
    assert pid.output == 0.0
    assert [pid.update(1.0, 0.3 * k, 0.1) for k in range(5)] == first
    pid.reset(output=2.0)
    assert pid.update(0.0, 0.0, 0.1) == 2.0
    pid.reset(output=9.0)
    assert pid.output == 5.0


# Odd values


@given(st.lists(st.tuples(anything, anything, anything)))
def test_what_is_no_measurement_is_ignored_and_counted(samples: list[Any]) -> None:
    pid, usual = (Pid(1.0, 0.5, 0.1, limits=(-2.0, 2.0)) for _ in range(2))
    good = [each for each in samples if all(map(math.isfinite, each)) and each[2] > 0.0]
    for each in samples:
        before = pid.output
        if pid.update(*each) != before:
            assert each in good
    for each in good:
        usual.update(*each)
    assert pid.output == usual.output
    assert pid.ignored == usual.ignored + len(samples) - len(good)


@pytest.mark.parametrize(
    "odd",
    [
        (math.nan, 0.0, 0.1),
        (0.0, math.inf, 0.1),
        (0.0, 0.0, 0.0),
        (0.0, 0.0, -1.0),
        (0.0, 0.0, math.nan),
        (1e308, -1e308, 0.1),
    ],
)
def test_the_output_stays_where_a_value_is_ignored(odd: tuple[float, float, float]) -> None:
    pid = Pid(1.0, 1.0, 1.0)
    output = pid.update(1.0, 0.0, 0.1)
    assert pid.update(*odd) == output
    assert pid.ignored == 1


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"kp": math.nan}, "kp: expected a finite gain, got nan"),
        ({"ki": math.inf}, "ki: expected a finite gain, got inf"),
        ({"limits": (1.0, -1.0)}, "limits: expected the least and then the greatest output, got 1.0 and -1.0"),
        ({"limits": (math.nan, 1.0)}, "limits: .* got nan"),
        ({"filter_time": -0.1}, "filter_time: expected 0 or more seconds, got -0.1"),
        ({"filter_time": math.inf}, "filter_time"),
    ],
)
def test_what_no_controller_can_have_is_refused(options: dict[str, Any], words: str) -> None:
    with pytest.raises(PidError, match=words) as caught:
        Pid(**{"kp": 1.0} | options)
    assert isinstance(caught.value, (RobolinkError, ValueError))


class Windup:
    """A PI controller as it should not be: the output is limited, and the integral grows on."""

    def __init__(self, kp: float, ki: float, limits: tuple[float, float]) -> None:
        self.kp, self.ki, self.limits, self.integral = kp, ki, limits, 0.0

    def update(self, setpoint: float, measurement: float, dt: float) -> float:
        self.integral += self.ki * (setpoint - measurement) * dt
        low, high = self.limits
        return min(high, max(low, self.kp * (setpoint - measurement) + self.integral))


def response(controller: Pid | Windup, seconds: float, dt: float) -> list[float]:
    """How the plant y' = u - y answers a step of the setpoint from 0 to 1, exactly from sample to sample."""
    y, found = 0.0, list[float]()
    for _ in range(round(seconds / dt)):
        u = controller.update(1.0, y, dt)
        y = u + (y - u) * math.exp(-dt)
        found.append(y)
    return found
