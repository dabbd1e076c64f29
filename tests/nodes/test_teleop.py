"""The node teleop: what keys ask for, how a robot is driven by them, and the terminal that they come from."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Parameter
from robolink.exceptions import InvalidParameterValueException
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.testing import System
from tests.support.nodefiles import load_node_file
from tests.support.systems import Typed, log, made_with

teleop = load_node_file("teleop")


# Keys


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("wI ", ["w", "i", " "]),
        ("\x1b[A\x1bOBa", ["up", "down", "a"]),
        ("\xe0H\x00M", ["up", "right"]),
        ("\x1b[1;2D\x1b[3~\x1b[15~j", ["left", "j"]),
        ("\x1b", ["escape"]),
        ("", []),
    ],
)
def test_keys_are_what_terminals_send(text: str, expected: list[str]) -> None:
    assert teleop.keys(text) == expected


@given(st.text())
def test_no_typing_is_too_much(text: str) -> None:
    assert len(teleop.keys(text)) <= len(text)


VELOCITIES = {"w": (0.3, 0), "down": (-0.3, 0), "j": (0, 1), "right": (0, -1), "u": (0.3, 1), "k": (0, 0)}


@pytest.mark.parametrize(("key", "expected"), VELOCITIES.items())
def test_a_key_asks_for_a_velocity(key: str, expected: tuple[float, float]) -> None:
    twist = teleop.twist_of(key, teleop.Speeds())
    assert (twist.linear.x, twist.angular.z) == expected


def test_other_keys_ask_for_nothing_and_q_and_z_change_the_speeds() -> None:
    assert [teleop.twist_of(key, teleop.Speeds()) for key in ("", "1", "q", "\x1b")] == [None] * 4
    faster = teleop.changed(teleop.Speeds(0.2, 1.0), "q")
    assert faster == pytest.approx((0.22, 1.1))
    assert teleop.changed(faster, "z") == pytest.approx((0.2, 1.0))


SIDEWAYS = {
    "J": (0.0, 0.3),
    "L": (0.0, -0.3),
    "A": (0.0, 0.3),
    "D": (0.0, -0.3),
    "U": (0.3, 0.3),
    "O": (0.3, -0.3),
    "M": (-0.3, 0.3),
    ">": (-0.3, -0.3),
    "<": (-0.3, 0.0),
    "I": (0.3, 0.0),
}
"""As teleop_twist_keyboard has them for robots that go sideways: shift, and the key for the direction."""


@pytest.mark.parametrize(("key", "expected"), SIDEWAYS.items())
def test_with_shift_a_key_asks_for_a_way_to_the_side(key: str, expected: tuple[float, float]) -> None:
    (read,) = teleop.keys(key)
    assert teleop.twist_of(read, teleop.Speeds()) == Twist(linear=Vector3(x=expected[0], y=expected[1]))


# The node


def test_teleop_drives_while_a_key_is_held_then_stops_once_and_is_silent(system: System) -> None:
    heard, keyboard = system.messages("/cmd_vel"), Typed()
    node = system.start(made_with(teleop.Teleop, keyboard=keyboard), parameters={"speed": 0.2})
    system.run(1.0)
    assert heard == []
    for _ in range(3):
        keyboard.text = "x\x1b[A"
        system.run(0.2)
    driving = len(heard)
    assert set(map(str, heard)) == {str(Twist(linear=Vector3(x=0.2)))}
    system.run(2.0)
    assert heard[driving:-1] == [Twist(linear=Vector3(x=0.2))] * (len(heard) - driving - 1)
    assert heard[-1] == Twist()
    assert 0.25 <= (len(heard) - driving) / teleop.RATE <= 0.35  # 0.2 s after the last key it was counted
    node.destroy_node()
    assert keyboard.closed


def test_teleop_tells_of_another_speed(system: System) -> None:
    keyboard = Typed()
    system.start(made_with(teleop.Teleop, keyboard=keyboard))
    keyboard.text = "q"
    system.run(0.1)
    assert "speed 0.33 m/s, 1.10 rad/s" in log(system)


def test_the_keys_of_the_speeds_set_parameters_within_their_ranges(system: System) -> None:
    keyboard = Typed()
    node = system.start(made_with(teleop.Teleop, keyboard=keyboard), parameters={"speed": 1.0, "turn_speed": 1.0})
    for text, v, w in (("q", 1.1, 1.1), ("r", 1.21, 1.1), ("f", 1.1, 1.1), ("E", 1.1, 1.21), ("cz", 1.0, 1.0)):
        keyboard.text = text
        system.run(0.1)
        assert (node.get_parameter("speed").value, node.get_parameter("turn_speed").value) == pytest.approx((v, w))
    keyboard.text = "r" * 100
    system.run(0.1)
    assert 9.0 < node.get_parameter("speed").value <= 10.0
    assert any("out of range" in line for line in log(system))


def test_speeds_set_from_elsewhere_count_from_the_next_key_on(system: System) -> None:
    heard, keyboard = system.messages("cmd_vel"), Typed()
    node = system.start(made_with(teleop.Teleop, keyboard=keyboard))
    node.set_parameters([Parameter("speed", value=0.7), Parameter("timeout", value=0.2)])
    keyboard.text = "w"
    system.run(1.0)
    assert [each.linear.x for each in heard] == [0.7] * 3 + [0.0]
    with pytest.raises(InvalidParameterValueException, match="not within"):
        system.start(made_with(teleop.Teleop, keyboard=Typed()), parameters={"timeout": 60.0})


def test_another_rate_counts_at_once_and_a_key_lasts_as_long(system: System) -> None:
    heard, keyboard = system.messages("cmd_vel"), Typed()
    node = system.start(made_with(teleop.Teleop, keyboard=keyboard), parameters={"rate": 10.0, "timeout": 1.0})
    keyboard.text = "w"
    system.run(0.51)
    assert len(heard) == 5
    node.set_parameters([Parameter("rate", value=50.0)])
    system.run(2.0)
    assert len(heard) == 5 + 25
    assert [each == Twist() for each in heard[-2:]] == [False, True]


def test_who_ends_it_on_the_way_stops_the_robot(system: System) -> None:
    heard, keyboard = system.messages("cmd_vel"), Typed()
    node = system.start(made_with(teleop.Teleop, keyboard=keyboard))
    keyboard.text = "w"
    system.run(0.2)
    assert heard[-1] != Twist()
    system.stop(node)
    system.run(0.1)
    assert heard[-1] == Twist()
    assert keyboard.closed
