"""The node square: its plan, and squares in simulated rooms that end where they began."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Parameter
from robolink.exceptions import InvalidParameterValueException
from robolink.geometry.plane import Pose, Speeds
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.testing import System
from tests.support.commands import Command
from tests.support.domains import free_domain
from tests.support.nodefiles import load_node_file
from tests.support.systems import PATIENCE, add_world, log, said

square = load_node_file("square")

START = Pose(1.0, 2.0, 0.3)


@given(st.floats(0.1, 10.0), st.sampled_from([1, -1]))
def test_the_plan_goes_round_and_ends_at_the_start(side: float, to_left: int) -> None:
    ways = list(square.square(START, side, to_left))
    assert [way.is_turn for way in ways] == [False, True] * 4
    end = ways[-1].goal
    assert end[:2] == pytest.approx(START[:2])
    assert math.remainder(end.theta - START.theta, math.tau) == pytest.approx(0.0, abs=1e-9)
    corners = [START, *(way.goal for way in ways if not way.is_turn)]
    for here, there in itertools.pairwise(corners):
        assert math.dist(here[:2], there[:2]) == pytest.approx(side)
        bearing = math.atan2(there.y - here.y, there.x - here.x)
        assert math.remainder(there.theta - bearing, math.tau) == pytest.approx(0.0, abs=1e-9)
    area = sum(a.x * b.y - b.x * a.y for a, b in itertools.pairwise(corners)) / 2
    assert area == pytest.approx(to_left * side * side)


lengths, speeds = st.floats(0.01, 5.0), st.floats(0.1, 3.0)


@given(lengths, speeds, speeds, st.sampled_from([0.005, 0.02, 0.05]), st.booleans())
def test_a_way_is_driven_as_a_trapezoid_and_ends(length: float, most: float, a: float, dt: float, back: bool) -> None:
    left, speed, speeds = -length if back else length, 0.0, [0.0]
    while abs(left) > square.ENOUGH:
        speed = square.eased(left, speed, most, a, dt)
        left -= speed * dt
        speeds.append(abs(speed))
        assert len(speeds) * dt < 10.0 + length / most + 4 * most / a
    assert abs(left) <= square.ENOUGH
    top = speeds.index(max(speeds))
    assert max(speeds) <= most
    assert speeds[: top + 1] == sorted(speeds[: top + 1])
    assert max(b - a for a, b in itertools.pairwise(speeds)) <= a * dt + 1e-9
    assert speeds[-1] <= 2 * square.SETTLING * square.ENOUGH


@pytest.mark.parametrize(("aside", "v", "w"), [(0.1, 0.3, 1), (-0.1, 0.3, -1), (0.1, -0.3, -1), (0.0, 0.3, 0)])
def test_it_turns_back_to_its_line(aside: float, v: float, w: float) -> None:
    way = square.Way(START, is_turn=False)
    left = square.Left(math.copysign(1.0, v), aside, 0.0)
    decided = square.decide(way, left, Speeds(v, 0.0), square.Limits(), 0.02)
    assert math.copysign(1.0, decided.v) == math.copysign(1.0, v)
    assert (decided.w > 0) - (decided.w < 0) == w


ROOM = """
world: {{size: [6, 6], dt: {dt}}}
robots: [{{name: robot, pose: [3, 3, {theta}], drive: {{v_max: 2, a_max: 3}}, odom: {{rate: {rate}}}}}]
"""

SQUARES = {
    "usual": ({}, {}),
    "slow and small, to the right": ({"theta": 1.0}, {"side": 0.3, "speed": 0.1, "direction": "right"}),
    "long steps": ({"theta": 2.0, "dt": 0.05, "rate": 20}, {"speed": 0.5}),
    "short steps": ({"theta": -3.0, "dt": 0.002}, {"side": 0.5, "speed": 0.5, "direction": "right"}),
    "fast": ({}, {"side": 2.0, "speed": 2.0, "acceleration": 2.0, "turn_speed": 6.0, "turn_acceleration": 10.0}),
    "little odometry": ({"rate": 10}, {"side": 2.0, "speed": 1.0, "turn_speed": 3.0}),
    "twice": ({"dt": 0.02}, {"turns": 2, "side": 0.5, "speed": 1.0, "turn_speed": 4.0}),
}


@pytest.mark.slow
@pytest.mark.parametrize(("room", "parameters"), SQUARES.values(), ids=SQUARES)
def test_it_ends_within_a_centimetre_of_its_start(
    system: System, room: dict[str, Any], parameters: dict[str, Any], tmp_path: Path
) -> None:
    path = tmp_path / "room.yaml"
    path.write_text(ROOM.format(**{"dt": 0.01, "rate": 50, "theta": 0.0} | room))
    add_world(system, path)
    start, heard = system.robot().pose, system.messages("odom")
    node = system.start(square.Square, parameters=parameters)
    assert system.result(node.done, PATIENCE) == 0
    system.run(1.0)
    assert math.hypot(system.robot().pose.x - start.x, system.robot().pose.y - start.y) < 0.01
    assert abs(math.remainder(system.robot().pose.theta - start.theta, math.tau)) < 0.01
    assert abs(system.robot().twist.v) + abs(system.robot().twist.w) < 1e-6
    assert said(system, "square done, 0.") == parameters.get("turns", 1)
    side = parameters.get("side", 1.0)
    farthest = max(math.dist((each.pose.pose.position.x, each.pose.pose.position.y), (3.0, 3.0)) for each in heard)
    assert farthest == pytest.approx(side * math.sqrt(2.0), abs=0.01)


@pytest.mark.slow
def test_it_gives_up_before_a_wall(system: System, tmp_path: Path) -> None:
    path = tmp_path / "room.yaml"
    path.write_text(ROOM.format(dt=0.01, rate=50, theta=0) + "walls: [{polyline: [[3.7, 2], [3.7, 4]]}]\n")
    add_world(system, path)
    node = system.start(square.Square)
    assert system.result(node.done, PATIENCE) == 1
    assert system.time < 30.0
    assert said(system, "gave up at (3.5") == 1


@pytest.mark.slow
def test_it_waits_for_odometry_and_ignores_what_is_none(system: System) -> None:
    node = system.start(square.Square)
    nonsense = Odometry()
    nonsense.pose.pose.position.x = math.nan
    nonsense.header.stamp.sec = -1
    system.node.create_publisher(Odometry, "odom", 10).publish(nonsense)
    system.run(11.0)
    assert said(system, "no odometry so far on /odom") == 2
    assert node.start is None
    add_world(system, "empty_room")
    assert system.result(node.done, PATIENCE) == 0


@pytest.mark.slow
def test_another_shape_is_that_of_the_next_square(system: System, tmp_path: Path) -> None:
    path = tmp_path / "room.yaml"
    path.write_text(ROOM.format(dt=0.01, rate=50, theta=0.0))
    add_world(system, path)
    heard = system.messages("odom")
    node = system.start(square.Square, parameters={"side": 0.5, "speed": 0.5})
    system.run(3.0)
    asked = {"side": 0.3, "turns": 2, "direction": "right", "turn_speed": 2.0}
    results = node.set_parameters([Parameter(name, value=value) for name, value in asked.items()])
    assert all(each.successful for each in results)
    assert system.result(node.done, PATIENCE) == 0
    said = [line for line in log(system) if line.startswith("driving")]
    assert said == [
        "driving a square with sides of 0.5 m",
        "driving a square with sides of 0.3 m, 2 of 2",
    ]
    places = [each.pose.pose.position for each in heard]
    assert max(each.y for each in places) == pytest.approx(3.5, abs=0.01), "to the left as it was begun"
    assert min(each.y for each in places) == pytest.approx(2.7, abs=0.01), "then a smaller one to the right"
    assert math.hypot(system.robot().pose.x - 3.0, system.robot().pose.y - 3.0) < 0.01


def test_what_cannot_be_is_refused_with_the_reason(system: System) -> None:
    with pytest.raises(InvalidParameterValueException, match="expected 'left' or 'right'"):
        system.start(square.Square, parameters={"direction": "up"})
    node = system.start(square.Square)
    asked = {"side": 0.0, "turns": 0, "direction": "up", "speed": 0.0}
    results = node.set_parameters([Parameter(name, value=value) for name, value in asked.items()])
    assert [each.successful for each in results] == [False] * 4
    assert results[2].reason == "direction: expected 'left' or 'right', got 'up'"


@pytest.mark.slow
def test_who_ends_it_on_the_way_stops_the_robot_and_who_is_done_is_silent(system: System) -> None:
    add_world(system, "empty_room")
    node, heard = system.start(square.Square), system.messages("cmd_vel")
    system.run(2.0)
    assert heard[-1].linear.x > 0.2
    told = len(heard)
    system.stop(node)
    system.run(0.1)
    assert heard[told:] == [Twist()]
    node = system.start(square.Square, parameters={"side": 0.3})
    system.result(node.done, PATIENCE)
    system.run(0.1)
    told = len(heard)
    assert heard[-1] == Twist()
    system.stop(node)
    system.run(0.1)
    assert heard[told:] == []


@pytest.mark.processes
def test_robolink_run_square_returns_when_it_is_done() -> None:
    room = ("-p", "world:=empty_room", "-p", "rtf:=10.0")
    small = ("-p", "side:=0.3", "-p", "speed:=0.5", "-p", "turn_speed:=3.0", "-p", "direction:=right")
    with free_domain() as domain, Command(domain, "run", "world", *room, merged=True) as world:
        world.wait_for("world 'empty_room'")
        with Command(domain, "run", "square", *small, merged=True) as command:
            command.wait_for("square done, ")
            assert command.end() == 0
