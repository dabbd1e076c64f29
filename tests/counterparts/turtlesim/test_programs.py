"""The programs that drive turtles: turtle_teleop_key, draw_square and mimic."""

from __future__ import annotations

import itertools
import math

import pytest

from robolink.counterparts.turtlesim.draw_square import DrawSquare
from robolink.counterparts.turtlesim.mimic import Mimic
from robolink.counterparts.turtlesim.turtle_teleop_key import HEADINGS, TurtleTeleop
from robolink.counterparts.turtlesim.turtlesim_node import TurtleSim
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.turtlesim.srv import Spawn
from robolink.testing import System
from tests.support.systems import Typed, log, made_with

UP, DOWN, RIGHT, LEFT = ("\x1b[A", "\x1b[B", "\x1b[C", "\x1b[D")


def test_arrows_drive(system: System) -> None:
    keyboard, heard = Typed(), system.messages("turtle1/cmd_vel")
    system.start(made_with(TurtleTeleop, keyboard=keyboard), parameters={"scale_linear": 1.5})
    keyboard.text = f"{UP}{DOWN}x{LEFT}{RIGHT}"
    system.run(1.0)
    assert [(each.linear.x, each.angular.z) for each in heard] == [(1.5, 0.0), (-1.5, 0.0), (0.0, 2.0), (0.0, -2.0)]


@pytest.mark.parametrize(("key", "heading"), HEADINGS.items())
def test_letters_turn_to_headings(system: System, key: str, heading: float) -> None:
    keyboard = Typed()
    system.start(TurtleSim)
    system.start(made_with(TurtleTeleop, keyboard=keyboard))
    system.run(0.5)
    keyboard.text = key
    system.expect_log("Rotation goal completed successfully", within=4.0)
    system.run(0.1)
    assert math.remainder(system.expect("turtle1/pose").theta - heading, math.tau) == pytest.approx(0.0, abs=0.02)


def test_f_cancels_and_the_next_letter_aborts(system: System) -> None:
    keyboard = Typed()
    system.start(TurtleSim)
    system.start(made_with(TurtleTeleop, keyboard=keyboard))
    system.run(0.5)
    for keys, told in (("cf", "Rotation goal canceled"), ("d", ""), ("v", "Aborting previous goal"), ("f", "canceled")):
        keyboard.text = keys
        system.run(0.3)
        if told:
            system.expect_log(told, within=0.1)


def test_q_ends_it_and_gives_the_terminal_back(system: System) -> None:
    keyboard = Typed()
    node = system.start(made_with(TurtleTeleop, keyboard=keyboard))
    keyboard.text = "q"
    system.run(0.1)
    assert node.done.done()
    system.stop(node)
    assert keyboard.closed


def test_nothing_serves_the_action_and_nothing_happens(system: System) -> None:
    keyboard = Typed()
    system.start(made_with(TurtleTeleop, keyboard=keyboard))
    keyboard.text = "gf"
    system.run(1.0)
    assert log(system) == []


@pytest.mark.slow
def test_a_square_is_drawn(system: System) -> None:
    system.start(TurtleSim)
    square = system.start(DrawSquare)
    poses = system.messages("turtle1/pose")
    system.run(60.0)
    assert not system.failures
    lines = log(system)
    assert lines[2] == "Resetting turtlesim."
    assert "New goal [7.544445 5.544445, 0.000000]" in lines
    assert sum(each == "Reached goal" for each in lines) > 8
    corners = [each.rpartition(",")[0] for each in lines if each.startswith("New goal")][1::2]
    places = [tuple(map(float, each.removeprefix("New goal [").split())) for each in corners[:5]]
    sides = [math.dist(a, b) for a, b in itertools.pairwise(places)]
    assert sides == pytest.approx([1.95] * 4, abs=0.08)
    assert math.dist(places[0], places[4]) < 0.2
    assert square.get_name() == "draw_square"
    assert {round(each.linear_velocity, 3) for each in poses} == {0.0, 1.0}


def test_a_turtle_mimics_another(system: System) -> None:
    system.start(TurtleSim)
    system.call(Spawn, "spawn", Spawn.Request(x=2.0, y=2.0, name="turtle2"))
    system.start(Mimic, remappings={"input/pose": "turtle1/pose", "output/cmd_vel": "turtle2/cmd_vel"}, name="mimic")
    system.run(0.5)
    system.publish("turtle1/cmd_vel", Twist(linear=Vector3(x=2.0), angular=Vector3(z=-1.8)))
    system.run(3.0)
    first, second = (system.expect(f"turtle{count}/pose") for count in (1, 2))
    assert second.theta == pytest.approx(first.theta, abs=0.1)
    assert second.theta < -1.6


def test_all_are_found_by_their_names(system: System) -> None:
    system.start("turtlesim turtlesim_node")
    system.start("turtlesim draw_square")
    system.start("turtlesim mimic", remappings={"input/pose": "turtle1/pose", "output/cmd_vel": "turtle2/cmd_vel"})
    system.expect("turtle2/cmd_vel", lambda twist: twist.linear.x == 1.0, within=5.0)
    assert not system.failures
