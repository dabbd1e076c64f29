"""Kinematics of turtles: steps of 16 ms, commands of one second, turns by the shorter way, and walls."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.counterparts.turtlesim.turtle import CENTRE, PERIOD, SIZE, Pen, Step, Turtle, normalized

numbers = st.floats(width=32)
"""Values of a message: also NaN and infinity."""


def run(turtle: Turtle, seconds: float, start: float = 0.0) -> list[Step]:
    return [turtle.step(start + count * PERIOD) for count in range(round(seconds / PERIOD))]


def test_the_window_is_turtlesims() -> None:
    assert (f"{SIZE:f}", f"{CENTRE:f}") == ("11.088889", "5.544445")


def test_a_command_lasts_one_second() -> None:
    turtle = Turtle()
    turtle.drive(2.0, 0.0, now=0.0)
    run(turtle, 3.0)
    assert turtle.x == pytest.approx(CENTRE + 2.0 * 63 * PERIOD)  # steps at 0, 0.016 ... 0.992
    assert (turtle.linear, turtle.y, turtle.theta) == (0.0, CENTRE, 0.0)


def test_it_drives_along_a_circle() -> None:
    turtle, radii = Turtle(), set()
    turtle.drive(2.0, 1.8, now=0.0)
    for count in range(60):
        turtle.step(count * PERIOD)
        radii.add(round(math.dist((turtle.x, turtle.y), (CENTRE, CENTRE + 2.0 / 1.8)), 1))
    assert radii == {1.1}
    assert turtle.theta == pytest.approx(60 * PERIOD * 1.8)


def test_a_holonomic_turtle_goes_to_its_left() -> None:
    turtle = Turtle(theta=math.pi / 2)
    turtle.drive(0.0, 0.0, now=0.0, sideways=1.0)
    turtle.step(0.0)
    assert (turtle.x, turtle.y) == pytest.approx((CENTRE - PERIOD, CENTRE))


def test_walls_hold_it_and_say_where_it_wanted_to_be() -> None:
    turtle = Turtle(x=SIZE - 0.01)
    turtle.drive(2.0, 0.0, now=0.0)
    first, *others = run(turtle, 0.1)
    assert first.hit == pytest.approx((SIZE + 0.022, CENTRE))
    assert turtle.x == SIZE
    assert all(each.hit == pytest.approx((SIZE + 0.032, CENTRE)) for each in others)
    assert all(each.line is None for each in others), "it stands"


@pytest.mark.parametrize(("start", "heading", "seconds"), [(0.0, 1.57, 1.57), (3.0, -3.0, 0.283), (-1.0, 0.0, 1.0)])
def test_a_turn_takes_the_shorter_way(start: float, heading: float, seconds: float) -> None:
    turtle = Turtle(theta=start)
    turtle.turn_to(heading)
    turns = [step.turn for step in run(turtle, 4.0) if step.turn is not None]
    assert len(turns) * PERIOD == pytest.approx(seconds, abs=0.04)
    assert [turn.is_reached for turn in turns] == [False] * (len(turns) - 1) + [True]
    assert turns[-1].delta == pytest.approx(normalized(start - turtle.theta))
    assert abs(normalized(turtle.theta - heading)) < 0.02
    assert (turtle.heading, turtle.angular) == (None, 0.0)


def test_a_command_ends_a_turn() -> None:
    turtle = Turtle()
    turtle.turn_to(3.0)
    turtle.step(0.0)
    turtle.drive(1.0, 0.0, now=0.016)
    assert turtle.step(0.016).turn is None


def test_jumps_come_first_and_in_their_order() -> None:
    turtle = Turtle()
    turtle.jump_to(1.0, 2.0, math.pi / 2)
    turtle.jump_ahead(3.0, -math.pi / 2)
    first, second = turtle.step(0.0).jumps
    assert (first.start, first.end) == ((CENTRE, CENTRE), (1.0, 2.0))
    assert second.end == pytest.approx((4.0, 2.0))
    assert (turtle.x, turtle.y, turtle.theta) == pytest.approx((4.0, 2.0, 0.0))
    assert turtle.step(PERIOD).jumps == []


def test_a_pen_that_is_off_draws_nothing() -> None:
    turtle = Turtle(pen=Pen(is_off=True))
    turtle.jump_to(1.0, 1.0, 0.0)
    turtle.drive(1.0, 0.0, now=0.0)
    assert turtle.step(0.0) == Step([], None, None, None)


@given(numbers, numbers, numbers)
def test_it_can_be_spawned_anywhere(x: float, y: float, theta: float) -> None:
    turtle = Turtle(x, y, theta)
    turtle.step(0.0)
    assert 0.0 <= turtle.x <= SIZE
    assert 0.0 <= turtle.y <= SIZE
    assert math.isfinite(turtle.theta)


@given(st.lists(st.tuples(st.sampled_from(["drive", "jump_to", "jump_ahead", "turn_to"]), numbers, numbers, numbers)))
def test_whatever_comes_it_stays_in_the_window(acts: list[tuple[str, float, float, float]]) -> None:
    turtle = Turtle()
    for at, (name, a, b, c) in enumerate(acts):
        arguments = {"drive": (a, b, at * PERIOD, c), "jump_to": (a, b, c), "jump_ahead": (a, b), "turn_to": (a,)}[name]
        getattr(turtle, name)(*arguments)
        turtle.step(at * PERIOD)
        assert 0.0 <= turtle.x <= SIZE
        assert 0.0 <= turtle.y <= SIZE
        assert math.isfinite(turtle.theta)


@given(st.floats(-1e6, 1e6))
def test_angles_are_between_minus_pi_and_pi(angle: float) -> None:
    assert -math.pi - 1e-9 <= normalized(angle) <= math.pi + 1e-9
    assert math.remainder(normalized(angle) - angle, math.tau) == pytest.approx(0.0, abs=1e-6)
