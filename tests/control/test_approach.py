"""The law by which a robot comes to a pose: from anywhere, within its limits."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.control import approach
from robolink.control.approach import Limits
from robolink.geometry.plane import Pose, Speeds

DT = 0.02


def driven(
    start: Pose, goal: Pose, limits: Limits, seconds: float = 120.0
) -> tuple[approach.Left, list[Pose], list[Speeds]]:
    """Drive by the law, each command a step late: what is left in the end, the poses and the commands."""
    poses, commands, arrived = [start], [Speeds(), Speeds()], False
    while len(poses) < seconds / DT:
        left = approach.left_to(goal, poses[-1])
        arrived = approach.has_arrived(left, limits, arrived)
        if arrived and approach.is_reached(left, limits, approach.SETTLED):
            break
        commands.append(approach.decide(left, commands[-1], limits, math.inf, arrived, DT))
        v, w = commands[-2]
        x, y, theta = poses[-1]
        middle = theta + w * DT / 2
        poses.append(Pose(x + v * DT * math.cos(middle), y + v * DT * math.sin(middle), theta + w * DT))
    return left, poses, commands


angles = st.floats(-math.pi, math.pi)


@given(st.floats(0.0, 5.0), angles, angles, angles, st.sampled_from([0.0, 0.4, 1.0]))
def test_it_comes_to_any_pose_within_the_tolerances_and_the_limits(
    distance: float, bearing: float, start: float, end: float, swing: float
) -> None:
    limits = Limits(swing=swing)
    goal = Pose(distance * math.cos(bearing), distance * math.sin(bearing), end)
    left, poses, commands = driven(Pose(0.0, 0.0, start), goal, limits)
    assert left.distance <= limits.position_tolerance
    assert abs(left.turn) <= limits.heading_tolerance
    assert all(0.0 <= v <= limits.speed and abs(w) <= limits.turn_speed for v, w in commands)
    changes = [(b.v - a.v, b.w - a.w) for a, b in itertools.pairwise(commands)]
    assert max((abs(v) for v, _ in changes), default=0.0) <= limits.acceleration * DT + 1e-9
    assert max((abs(w) for _, w in changes), default=0.0) <= limits.turn_acceleration * DT + 1e-9
    aside = (math.cos(bearing) * pose.y - math.sin(bearing) * pose.x for pose in poses)
    assert max(map(abs, aside)) <= swing + 0.15  # the arcs on which it turns to its direction are beside the line too


def test_it_turns_on_the_spot_first_where_the_goal_is_behind() -> None:
    _, poses, _ = driven(Pose(0.0, 0.0, 0.0), Pose(-2.0, 0.0, math.pi), Limits())
    before = [pose for pose in poses if abs(pose.theta) < 2.0]
    assert max(math.hypot(*pose[:2]) for pose in before) == 0.0


def test_it_swings_out_to_arrive_with_the_goals_heading() -> None:
    _, poses, _ = driven(Pose(0.0, 0.0, 0.0), Pose(3.0, 0.0, math.pi / 2), Limits())
    assert min(pose.y for pose in poses) < -0.1
    near = [pose for pose in poses if math.dist(pose[:2], (3.0, 0.0)) < 0.1]
    assert near[0].theta > 0.5, "it comes with most of the turn behind it"


@pytest.mark.parametrize(("room", "speed"), [(0.0, 0.0), (0.01, 0.11), (0.2, 0.4), (math.inf, 0.4)])
def test_it_drives_so_slowly_that_it_can_stop_before_what_is_ahead(room: float, speed: float) -> None:
    decided = approach.decide(approach.Left(3.0, 0.0, 0.0), Speeds(0.4, 0.0), Limits(), room, False, DT)
    assert decided == pytest.approx((speed, 0.0), abs=0.005)
