"""The node of turtlesim in virtual time: its topics, services, parameters, action, picture and lines of the log."""

from __future__ import annotations

import math
from typing import Any

import pytest

from robolink.action import ActionClient
from robolink.counterparts.turtlesim.turtlesim_node import MOST_TURTLES, TurtleSim
from robolink.exceptions import InvalidParameterValueException
from robolink.image import to_array
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import CompressedImage
from robolink.interfaces.std_srvs.srv import Empty
from robolink.interfaces.turtlesim.action import RotateAbsolute
from robolink.interfaces.turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative
from robolink.testing import System
from tests.support.systems import log

CENTRE = 5.544444561004639


@pytest.fixture
def turtlesim(system: System) -> Any:
    """A turtlesim."""
    return system.start(TurtleSim)


def drive(system: System, linear: float, angular: float = 0.0, aside: float = 0.0, turtle: str = "turtle1") -> None:
    twist = Twist(linear=Vector3(x=linear, y=aside), angular=Vector3(z=angular))
    system.publish(f"{turtle}/cmd_vel", twist)


def place(system: System, turtle: str = "turtle1") -> tuple[float, float, float]:
    pose = system.expect(f"{turtle}/pose")
    return pose.x, pose.y, pose.theta


def colour(system: System, turtle: str = "turtle1") -> tuple[int, int, int]:
    found = system.expect(f"{turtle}/color_sensor")
    return found.r, found.g, found.b


def spawn(system: System, name: str = "", x: float = 2.0, y: float = 2.0, theta: float = 0.2) -> str:
    return str(system.call(Spawn, "spawn", Spawn.Request(x=x, y=y, theta=theta, name=name)).name)


# Topics


def test_it_starts_with_one_turtle_in_the_middle(system: System, turtlesim: Any) -> None:
    poses = system.messages("turtle1/pose")
    assert place(system) == (CENTRE, CENTRE, 0.0)
    system.run(8.0)
    assert len(poses) == pytest.approx(8.0 * 62.5, abs=2)
    assert log(system) == [
        "Starting turtlesim with node name /turtlesim",
        "Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]",
    ]


def test_a_turtle_obeys_for_a_second_and_tells_its_speeds(system: System, turtlesim: Any) -> None:
    drive(system, 2.0, 1.8)
    pose = system.expect("turtle1/pose", lambda pose: pose.angular_velocity > 0.0, within=0.1)
    assert (pose.linear_velocity, pose.angular_velocity) == pytest.approx((2.0, 1.8))
    system.run(2.0)
    x, y, theta = place(system)
    assert theta == pytest.approx(1.8, abs=0.05)
    assert (x, y) == pytest.approx((CENTRE + 1.11 * math.sin(theta), CENTRE + 1.11 * (1 - math.cos(theta))), abs=0.05)
    assert system.expect("turtle1/pose").linear_velocity == 0.0


@pytest.mark.parametrize(("holonomic", "moved"), [(False, 0.0), (True, 1.0)])
def test_only_holonomic_turtles_go_aside(system: System, holonomic: bool, moved: float) -> None:
    system.start(TurtleSim, parameters={"holonomic": holonomic})
    drive(system, 0.0, aside=1.0)
    system.run(2.0)
    assert place(system)[1] == pytest.approx(CENTRE + moved, abs=0.05)


def test_at_the_wall_it_says_so_at_each_step(system: System, turtlesim: Any) -> None:
    system.call(TeleportAbsolute, "turtle1/teleport_absolute", TeleportAbsolute.Request(x=11.0, y=10.0))
    drive(system, 2.0)
    system.expect_log("Oh no! I hit the wall! (Clamping from [x=11.12", within=1.0)  # and y is counted from the top
    assert "y=1.088889]" in log(system)[-1]
    system.run(2.0)
    assert 50 < sum(line.startswith("Oh no!") for line in log(system)) < 65
    assert place(system)[0] == pytest.approx(11.088889)


def test_the_colour_is_that_below_the_turtle(system: System, turtlesim: Any) -> None:
    assert colour(system) == (69, 86, 255)
    drive(system, 2.0)
    system.run(2.0)
    assert colour(system) == (179, 184, 255)
    system.call(SetPen, "turtle1/set_pen", SetPen.Request(r=255, width=5))
    drive(system, -1.0)
    system.run(2.0)
    assert colour(system) == (255, 0, 0)
    system.call(SetPen, "turtle1/set_pen", SetPen.Request(off=1))
    system.call(TeleportRelative, "turtle1/teleport_relative", TeleportRelative.Request(linear=1.0, angular=2.0))
    system.run(0.1)
    assert colour(system) == (69, 86, 255)


# Services


def test_turtles_come_and_go(system: System, turtlesim: Any) -> None:
    assert [spawn(system), spawn(system, "tom", 3.5), spawn(system, "turtle3"), spawn(system)] == [
        "turtle2",
        "tom",
        "turtle3",
        "turtle4",
    ]
    assert place(system, "tom") == pytest.approx((3.5, 2.0, 0.2))
    assert "Spawning turtle [tom] at x=[3.500000], y=[2.000000], theta=[0.200000]" in log(system)
    drive(system, 1.0, turtle="tom")
    system.run(0.5)
    assert (place(system, "tom")[0] > 3.8, place(system)) == (True, (CENTRE, CENTRE, 0.0))
    system.call(Kill, "kill", Kill.Request(name="tom"))
    assert not [name for name in (*system.topics, *system.services) if "tom" in name]
    assert spawn(system, "tom") == "tom"


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("turtle1", "A turtle named [turtle1] already exists"),
        ("a b", "No turtle can be named [a b]: its topics would have that in their names"),
        ("\x1b[2J", "No turtle can be named"),
        ("x" * 300, "No turtle can be named"),
        ("{oops}x", "No turtle can be named"),
        ("a//b", "No turtle can be named"),
        ("/", "No turtle can be named"),
    ],
)
def test_who_cannot_be_spawned_is_told_in_the_log(system: System, turtlesim: Any, name: str, told: str) -> None:
    assert spawn(system, name) == ""
    assert log(system)[-1].startswith(told)
    assert list(turtlesim.turtles) == ["turtle1"]


@pytest.mark.slow
def test_nonsense_moves_nobody_out_of_the_window(system: System, turtlesim: Any) -> None:
    nan, most = math.nan, 3.4e38
    assert spawn(system, "", nan, -most, math.inf) == "turtle2"
    for turtle in ("turtle1", "turtle2"):
        drive(system, nan, math.inf, turtle=turtle)
        ahead, there = TeleportRelative.Request(linear=most, angular=nan), TeleportAbsolute.Request(x=-most, y=nan)
        system.call(TeleportRelative, f"{turtle}/teleport_relative", ahead)
        system.call(SetPen, f"{turtle}/set_pen", SetPen.Request(width=255))
        system.call(TeleportAbsolute, f"{turtle}/teleport_absolute", there)
        drive(system, 1e308, -1e308, turtle=turtle)
    rotate(system, nan)
    system.run(1.0)
    for turtle in ("turtle1", "turtle2"):
        x, y, theta = place(system, turtle)
        assert 0.0 <= x <= 11.09
        assert 0.0 <= y <= 11.09
        assert math.isfinite(theta)


def test_there_is_a_limit(system: System, turtlesim: Any) -> None:
    turtlesim.turtles.update({f"x{count}": turtlesim.turtles["turtle1"] for count in range(MOST_TURTLES - 1)})
    assert spawn(system) == ""
    assert log(system)[-1] == "There are 200 turtles already: kill some first"


def test_who_is_not_there_cannot_be_killed(system: System, turtlesim: Any) -> None:
    system.call(Kill, "kill", Kill.Request(name="ninja"))
    assert log(system)[-1] == "Tried to kill turtle [ninja], which does not exist"


def test_clear_takes_the_lines_and_reset_all_but_one_turtle(system: System, turtlesim: Any) -> None:
    spawn(system)
    drive(system, 2.0)
    system.run(1.5)
    system.call(Empty, "clear")
    assert (log(system)[-1], colour(system)) == ("Clearing turtlesim.", (69, 86, 255))
    assert place(system)[0] == pytest.approx(CENTRE + 2.0, abs=0.05)
    system.call(Empty, "reset")
    assert log(system)[-2:] == [
        "Resetting turtlesim.",
        "Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]",
    ]
    assert place(system) == (CENTRE, CENTRE, 0.0)
    assert "/turtle2/pose" not in system.topics
    assert spawn(system) == "turtle2"


# Parameters and the picture


def test_the_background_is_a_parameter(system: System, turtlesim: Any) -> None:
    system.set_parameter("turtlesim", "background_r", 150)
    system.run(0.1)
    assert colour(system) == (150, 86, 255)
    with pytest.raises(InvalidParameterValueException, match="background_r"):
        system.set_parameter("turtlesim", "background_r", 256)


def test_the_picture_comes_when_somebody_looks_and_something_moves(system: System, turtlesim: Any) -> None:
    system.run(1.0)
    pictures: list[CompressedImage] = []
    system.node.create_subscription(CompressedImage, "turtlesim/_picture", pictures.append, 1)
    system.run(0.5)
    assert len(pictures) == 1
    assert to_array(pictures[0], "rgb8").shape == (500, 500, 3)
    drive(system, 2.0)
    system.run(3.0)
    assert len(pictures) == pytest.approx(1 + 31, abs=2)
    last = to_array(pictures[-1], "rgb8")
    assert last[249, 280].tolist() == [179, 184, 255]
    assert last[20, 20].tolist() == [69, 86, 255]
    system.set_parameter("turtlesim", "background_g", 0)
    system.run(0.1)
    assert to_array(pictures[-1], "rgb8")[20, 20].tolist() == [69, 0, 255]


# Action


def rotate(system: System, theta: float, feedback: list[float] | None = None) -> Any:
    """Send a goal; return its handle."""
    client = ActionClient(system.node, RotateAbsolute, "turtle1/rotate_absolute")
    heard: list[float] = [] if feedback is None else feedback
    goal = RotateAbsolute.Goal(theta=theta)
    sent = client.send_goal_async(goal, lambda told: heard.append(told.feedback.remaining))
    handle: Any = system.result(sent)
    assert handle.accepted
    return handle


def ended(system: System, handle: Any) -> Any:
    """Status and turned angle of a goal that has ended."""
    answer: Any = system.result(handle.get_result_async())
    return answer.status, answer.result.delta


def test_a_goal_turns_it_to_a_heading(system: System, turtlesim: Any) -> None:
    feedback: list[float] = []
    status, delta = ended(system, rotate(system, 1.57, feedback))
    assert (status, delta) == (GoalStatus.STATUS_SUCCEEDED, pytest.approx(-1.568, abs=0.02))
    assert feedback[0] == pytest.approx(1.57)
    assert feedback == sorted(feedback, reverse=True)
    assert feedback[-1] < 0.02
    assert len(feedback) == pytest.approx(1.57 / 0.016, abs=3)
    assert log(system)[-1] == "Rotation goal completed successfully"
    assert place(system)[2] == pytest.approx(1.57, abs=0.02)
    assert ended(system, rotate(system, -1.57)) == (GoalStatus.STATUS_SUCCEEDED, pytest.approx(3.12, abs=0.03))


def test_a_goal_can_be_cancelled(system: System, turtlesim: Any) -> None:
    handle = rotate(system, 3.0)
    system.run(1.0)
    assert system.result(handle.cancel_goal_async()).goals_canceling
    assert ended(system, handle) == (GoalStatus.STATUS_CANCELED, pytest.approx(-1.0, abs=0.05))
    assert log(system)[-1] == "Rotation goal canceled"
    theta = place(system)[2]
    system.run(1.0)
    assert place(system)[2] == theta


def test_a_newer_goal_aborts_the_one_before(system: System, turtlesim: Any) -> None:
    first = rotate(system, 3.0)
    system.run(0.5)
    second = rotate(system, 0.0)
    assert ended(system, first)[0] == GoalStatus.STATUS_ABORTED
    assert "Rotation goal received before a previous goal finished. Aborting previous goal" in log(system)
    assert ended(system, second)[0] == GoalStatus.STATUS_SUCCEEDED


def test_a_command_aborts_a_goal(system: System, turtlesim: Any) -> None:
    handle = rotate(system, 3.0)
    system.run(0.5)
    drive(system, 1.0)
    assert ended(system, handle)[0] == GoalStatus.STATUS_ABORTED
    assert log(system)[-1] == "Velocity command received during rotation goal. Aborting goal"
    system.run(0.3)
    assert place(system)[0] > CENTRE


@pytest.mark.parametrize("service", ["reset", "kill"])
def test_a_goal_of_a_turtle_that_goes_ends_nothing_else(system: System, turtlesim: Any, service: str) -> None:
    rotate(system, 3.0)
    system.run(0.5)
    if service == "reset":
        system.call(Empty, "reset")
        assert ended(system, rotate(system, 1.0))[0] == GoalStatus.STATUS_SUCCEEDED
    else:
        system.call(Kill, "kill", Kill.Request(name="turtle1"))
        assert spawn(system) == "turtle2"
    system.run(1.0)
