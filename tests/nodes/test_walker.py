"""The node walker: walks as a course's exercise has them, routes, and the services and topics of the node."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Parameter
from robolink.control.stop_lock import QOS
from robolink.exceptions import InvalidParameterValueException
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.std_msgs.msg import Bool
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.testing import System
from tests.support.nodefiles import load_node_file
from tests.support.systems import ask, log, said

walker = load_node_file("walker")


# The walk


def test_the_course_s_walk_ends_where_it_should() -> None:
    walk = walker.Walk()
    walk.walk_straight(10)
    walk.turn_and_walk(90, 5)
    walk.turn_and_walk(0, 5)
    assert walk.position == pytest.approx((4.5, 1.5))
    assert (walk.steps, len(walk.history)) == (20, 21)
    assert walk.history[10] == pytest.approx((3.0, 0.0))


@given(st.floats(-720.0, 720.0), st.integers(1, 50), st.floats(0.01, 2.0))
def test_a_square_of_steps_is_perfect(first: float, steps: int, length: float) -> None:
    walk = walker.Walk()
    for corner in range(4):
        walk.turn_and_walk(first + 90 * corner, steps, length)
    assert walk.distance_from_start() < 1e-9
    farthest = max(math.hypot(*place) for place in walk.history)
    assert farthest == pytest.approx(steps * length * math.sqrt(2.0))


def test_steps_by_a_velocity_are_as_long_as_legs_make_them() -> None:
    walk = walker.Walk()
    walk.step_by_velocity(Twist(linear=Vector3(x=0.2)), 0.5)
    assert walk.position == pytest.approx((0.1, 0.0))
    walk.step_by_velocity(Twist(linear=Vector3(y=-9.0)), 0.5)
    assert walk.position == pytest.approx((0.1, -0.3))
    assert walk.heading == pytest.approx(0.0)
    walk.step_by_velocity(Twist(angular=Vector3(z=math.pi)), 0.5)
    walk.step_by_velocity(Twist(linear=Vector3(x=-0.2)), 0.5)
    assert walk.position == pytest.approx((0.1, -0.4))
    assert (walk.heading, walk.steps) == (pytest.approx(90.0), 4)


def test_what_a_walk_remembers_has_an_end() -> None:
    walk = walker.Walk()
    walk.walk_straight(walker.STORED + 5)
    assert (walk.steps, len(walk.history)) == (walker.STORED + 5, walker.STORED)


# Routes


def test_a_route_is_legs() -> None:
    assert walker.parse_route("0x10 90x5,0x5") == [(0, 10), (90, 5), (0, 5)]
    assert walker.parse_route("-45.5 1e2x3") == [(-45.5, 1), (100, 3)]


@pytest.mark.parametrize(
    "text", ["", "x", "90x", "90x0", "90x-1", "north x5", "nanx1", "0x999999999", "1x2x3", "0x1.5"]
)
def test_what_is_no_route_is_refused(text: str) -> None:
    with pytest.raises(walker.RouteError):
        walker.parse_route(text)


@given(st.text(alphabet="0123456789x,.-+ einfa", max_size=20))
def test_any_text_is_a_route_or_an_error_of_robolink(text: str) -> None:
    try:
        legs = walker.parse_route(text)
    except walker.RouteError:
        return
    assert all(math.isfinite(leg.direction) and leg.steps >= 1 for leg in legs)


# The node


def test_it_walks_its_route_when_it_is_asked_to(system: System) -> None:
    poses, steps = system.messages("walk_pose"), system.messages("steps")
    paths, transforms = system.messages("walk_path"), system.messages("/tf")
    system.start(walker.Walker)
    system.run(2.0)
    assert [each.data for each in steps] == [0]
    assert ask(system, Trigger, "start_walk") == (True, f"walking {walker.ROUTE}: 20 steps")
    assert ask(system, Trigger, "start_walk") == (False, "already walking: 20 steps to go")
    system.run(15.0)
    assert [each.data for each in steps] == list(range(21))
    places = [(each.pose.position.x, each.pose.position.y) for each in poses]
    assert places[10] == pytest.approx((3.0, 0.0))
    assert places[-1] == pytest.approx((4.5, 1.5))
    assert poses[12].pose.orientation.z == pytest.approx(math.sqrt(0.5))
    assert [(each.pose.position.x, each.pose.position.y) for each in paths[-1].poses] == places
    last = transforms[-1].transforms[0]
    assert (last.header.frame_id, last.child_frame_id) == ("odom", "walker")
    assert (last.transform.translation.x, last.transform.translation.y) == places[-1]
    assert "walked the route: 20 steps so far, at (4.50, 1.50), 4.74 m from the start" in log(system)


def test_it_says_where_it_waits_to_be_asked(system: System) -> None:
    system.start(walker.Walker, namespace="bumi")
    assert "standing; robolink service call /bumi/start_walk has it walk" in log(system)


def test_it_takes_a_step_each_half_second_from_the_start_on(system: System) -> None:
    steps = system.messages("steps")
    node = system.start(walker.Walker, parameters={"autostart": True})
    system.run(2.2)
    assert len(steps) == 1 + 4
    node.set_parameters([Parameter("step_duration", value=0.1)])
    system.run(1.05)
    assert len(steps) == 1 + 4 + 10


def test_it_stops_when_it_is_asked_to_and_walks_anew(system: System) -> None:
    node = system.start(walker.Walker, parameters={"route": "0x4"})
    assert ask(system, Trigger, "stop_walk") == (False, "standing already")
    ask(system, Trigger, "start_walk")
    system.run(1.2)
    assert ask(system, Trigger, "stop_walk") == (True, "stopped with 2 steps to go")
    system.run(3.0)
    assert node.walk.position == pytest.approx((0.6, 0.0))
    assert ask(system, Trigger, "start_walk")[0]
    system.run(5.0)
    assert node.walk.position == pytest.approx((1.8, 0.0))


def test_who_comes_later_sees_where_it_is(system: System) -> None:
    system.start(walker.Walker, parameters={"route": "90x3", "autostart": True})
    system.run(5.0)
    steps, paths = system.messages("steps"), system.messages("walk_path")
    system.run(0.1)
    assert [each.data for each in steps] == [3]
    assert len(paths[0].poses) == 4


def test_it_walks_by_velocity_until_no_more_comes(system: System) -> None:
    node = system.start(walker.Walker)
    cmd_vel = system.node.create_publisher(Twist, "cmd_vel", 10)
    cmd_vel.publish(Twist(linear=Vector3(x=0.4)))
    system.run(5.0)
    assert 1 <= node.walk.steps <= 2
    assert node.walk.position == pytest.approx((0.2 * node.walk.steps, 0.0))
    cmd_vel.publish(Twist(linear=Vector3(x=0.4)))
    system.run(0.1)
    assert ask(system, Trigger, "stop_walk") == (True, "stopped with 0 steps to go")
    taken = node.walk.steps
    system.run(2.0)
    assert node.walk.steps == taken


@pytest.mark.parametrize("twist", [Twist(linear=Vector3(x=math.nan)), Twist(angular=Vector3(z=math.inf))])
def test_nonsense_on_cmd_vel_is_ignored(system: System, twist: Any) -> None:
    node = system.start(walker.Walker)
    cmd_vel = system.node.create_publisher(Twist, "cmd_vel", 10)
    for _ in range(3):
        cmd_vel.publish(twist)
    system.run(2.0)
    assert node.walk.steps == 0
    assert said(system, "ignored a cmd_vel") == 1


def test_on_a_route_cmd_vel_does_not_count(system: System) -> None:
    node = system.start(walker.Walker, parameters={"route": "0x4", "autostart": True})
    cmd_vel = system.node.create_publisher(Twist, "cmd_vel", 10)
    system.node.create_timer(0.2, lambda: cmd_vel.publish(Twist(linear=Vector3(y=0.5))) if node.ahead else None)
    system.run(4.0)
    assert node.walk.position == pytest.approx((1.2, 0.0))
    assert said(system, "cmd_vel is ignored on a route") == 1


@pytest.mark.slow
def test_it_stands_while_stop_holds_and_walks_on_when_it_is_released(system: System) -> None:
    node = system.start(walker.Walker, parameters={"route": "0x6", "autostart": True})
    lock = system.node.create_publisher(Bool, "/e_stop", QOS)
    system.run(1.2)
    lock.publish(Bool(data=True))
    system.run(10.0)
    assert (node.walk.steps, node.to_go()) == (2, "4 steps")
    lock.publish(Bool(data=False))
    system.run(2.1)
    assert (node.walk.steps, node.to_go()) == (6, "0 steps")
    assert (said(system, "STOP holds"), said(system, "STOP is released")) == (1, 1)


def test_a_velocity_moves_it_only_once_stop_is_released(system: System) -> None:
    node = system.start(walker.Walker)
    lock = system.node.create_publisher(Bool, "/e_stop", QOS)
    cmd_vel = system.node.create_publisher(Twist, "cmd_vel", 10)
    system.node.create_timer(0.02, lambda: cmd_vel.publish(Twist(linear=Vector3(x=0.4))))
    system.run(1.2)
    lock.publish(Bool(data=True))
    system.run(0.1)
    taken = node.walk.steps
    system.run(10.0)
    assert node.walk.steps == taken > 0
    lock.publish(Bool(data=False))
    system.run(2.0)
    assert node.walk.steps > taken


def test_a_wrong_route_is_refused_and_the_old_one_stays(system: System) -> None:
    with pytest.raises(InvalidParameterValueException, match="'90y5': expected DIRECTIONxSTEPS"):
        system.start(walker.Walker, parameters={"route": "90y5"})
    node = system.start(walker.Walker)
    result = node.set_parameters([Parameter("route", value="up")])[0]
    assert (result.successful, node.get_parameter("route").value) == (False, walker.ROUTE)
    assert "expected DIRECTIONxSTEPS" in result.reason
