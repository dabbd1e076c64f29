"""The rules for parameters: ranges with their steps and edges, and what is listed."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node
from robolink.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
)
from robolink.parameters.rules import is_listed, refusal
from tests.support.parameter_nodes import made


def _refused(value: Any, **descriptor: Any) -> str:
    described = ParameterDescriptor(dynamic_typing=True, **descriptor)
    return refusal(made("x", value), described, is_declared=True, rel_tol=Node.PARAM_REL_TOL)


@given(st.integers(-6, 6), st.integers(-6, 6), st.integers(0, 4), st.integers(-8, 8))
def test_an_integer_range_is_its_steps_and_both_ends(low: int, high: int, step: int, value: int) -> None:
    limits = IntegerRange(from_value=low, to_value=high, step=step)
    low, high = min(low, high), max(low, high)
    allowed = {*range(low, high + 1, step or 1), high}
    assert (_refused(value, integer_range=[limits]) == "") == (value in allowed)


@given(
    st.floats(-1e6, 1e6),
    st.integers(1, 1000),
    st.floats(1e-3, 1e3),
    st.integers(0, 1000),
    st.sampled_from([-1, 1]),
)
def test_a_float_range_takes_every_step_and_both_ends(
    low: float, steps: int, step: float, number: int, sign: int
) -> None:
    high = low + steps * step
    limits = FloatingPointRange(from_value=low, to_value=high, step=sign * step)
    assert _refused(low + number % (steps + 1) * step, floating_point_range=[limits]) == ""
    assert _refused(high, floating_point_range=[limits]) == ""
    beyond = high + max(1.0, abs(high)) * 0.01
    assert "out of range" in _refused(beyond, floating_point_range=[limits])


@given(st.integers(-20, 20), st.integers(1, 40), st.sampled_from([0.1, 0.25, 0.5, 3.0]), st.data())
def test_a_float_between_two_steps_is_refused(low: int, steps: int, step: float, data: st.DataObject) -> None:
    limits = FloatingPointRange(from_value=float(low), to_value=low + steps * step, step=step)
    value = low + (data.draw(st.integers(0, steps - 1)) + 0.5) * step
    assert "off its steps" in _refused(value, floating_point_range=[limits])


@pytest.mark.parametrize(
    ("value", "low", "high", "step", "reason"),
    [
        (0.0, -0.7, 0.7, 0.1, ""),  # -0.7 + 7 * 0.1 is 1.1e-16
        (5.37, -10.0, 10.0, 0.0, ""),
        (5.37, 10.0, -10.0, 0.0, ""),
        (-4.5, -10.0, 0.0, 30.0, "off its steps"),
        (float("nan"), -10.0, 10.0, 0.0, "out of range"),
        (float("inf"), -10.0, 10.0, 0.5, "out of range"),
        (1.0, float("-inf"), float("inf"), 0.5, ""),
        (1e308, -1.7e308, 1.7e308, 1e-300, ""),
        (1.0, 0.0, 10.0, float("inf"), "off its steps"),
        (500.0, 0.0, 1e10, 1e9, "off its steps"),
        (0.0, -1e5, float("inf"), 0.1, ""),
        (0.05, -1e5, float("inf"), 0.1, "off its steps"),
    ],
)
def test_a_float_range_at_its_edges(value: float, low: float, high: float, step: float, reason: str) -> None:
    found = _refused(value, floating_point_range=[FloatingPointRange(from_value=low, to_value=high, step=step)])
    assert found == "" if not reason else reason in found


def test_a_range_binds_values_of_its_own_type_only() -> None:
    ranges = {
        "integer_range": [IntegerRange(from_value=0, to_value=1)],
        "floating_point_range": [FloatingPointRange(from_value=0.0, to_value=1.0)],
    }
    for value in ("five", [5, 5], [5.0], True, None):
        assert _refused(value, **ranges) == ""
    assert _refused(5, **ranges) == "parameter 'x' out of range: 5 is not within 0 to 1"
    assert _refused(5.0, **ranges) == "parameter 'x' out of range: 5.0 is not within 0.0 to 1.0"
    assert "does not fit in 64 bits" in _refused(2**63)


@given(st.lists(st.sampled_from("ab"), min_size=1, max_size=5), st.integers(0, 5), st.integers(0, 5))
def test_a_name_is_listed_under_each_of_its_parents_that_is_near_enough(parts: list[str], cut: int, depth: int) -> None:
    name, parent = ".".join(parts), parts[: cut % len(parts)]
    below = len(parts) - len(parent)
    assert is_listed(name, [".".join(parent)] if parent else [], depth) == (depth == 0 or below <= depth)
    assert is_listed(name, [name], depth)
    assert not is_listed(name, ["c"], depth)
