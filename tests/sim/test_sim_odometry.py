"""Systematic errors of odometry: its scale and its drift, alone and beside the noise."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink.exceptions import DocumentError
from robolink.geometry.plane import wrapped
from robolink.sim import Robot, World, load_world
from robolink.sim.driving import fleet

SHARP = "a_max: 500, alpha_max: 1000"


def world(odom: str, kind: str = "diff") -> World:
    drive = f"drive: {{type: {kind}, v_max: 2, {SHARP}}}"
    return World(load_world("open.yaml", text=f"robots: [{{name: r, pose: [0, 0], {drive}, odom: {{{odom}}}}}]"))


def drive(world: World, seconds: float, v: float, w: float = 0.0, sideways: float = 0.0) -> Robot:
    robot = world.robots["r"]
    for _ in range(round(seconds * 100)):
        robot.command(v, w, sideways)
        world.step()
    return robot


def test_a_scale_stretches_the_way_and_the_turn() -> None:
    made = world("scale: {v: 1.02, w: 0.97}")
    robot = drive(made, 10.0, 0.4)
    assert robot.odometry.x == pytest.approx(1.02 * robot.pose.x)
    assert robot.odometry_twist.v == pytest.approx(1.02 * 0.4)
    drive(made, 0.1, 0.0)
    before = robot.odometry.theta
    drive(made, 2.0, 0.0, 1.0)
    assert robot.odometry.theta - before == pytest.approx(0.97 * robot.pose.theta)
    assert robot.odometry_twist.w == pytest.approx(0.97)


def test_a_scale_stretches_the_way_aside_of_an_omni() -> None:
    robot = drive(world("scale: {v: 0.9}", "omni"), 5.0, 0.0, 0.0, 0.4)
    assert robot.odometry.y == pytest.approx(0.9 * robot.pose.y)
    assert robot.odometry.theta == 0.0


def test_drift_bends_the_way_and_going_back_straightens_it() -> None:
    made = world("drift: 0.05")
    robot = drive(made, 10.0, 0.4)
    way = robot.pose.x
    assert robot.odometry.theta == pytest.approx(0.05 * way)
    assert robot.odometry.x == pytest.approx(math.sin(0.05 * way) / 0.05)  # an arc of this curvature
    assert robot.odometry.y == pytest.approx((1 - math.cos(0.05 * way)) / 0.05)
    assert robot.odometry_twist.w == pytest.approx(0.05 * 0.4)
    assert robot.pose.theta == 0.0
    drive(made, 12.0, -0.4)
    assert robot.odometry.theta == pytest.approx(0.05 * robot.pose.x)


def test_a_turn_on_the_spot_drifts_nowhere() -> None:
    robot = drive(world("drift: 0.5"), 2.0, 0.0, 1.0)
    assert robot.odometry == robot.pose


@settings(max_examples=20, deadline=None)
@given(v=st.floats(0.5, 2.0), w=st.floats(0.5, 2.0), drift=st.floats(-1.0, 1.0), noise=st.sampled_from([0.0, 0.1]))
def test_odometry_goes_where_its_own_twist_says(v: float, w: float, drift: float, noise: float) -> None:
    made = world(f"scale: {{v: {v}, w: {w}}}, drift: {drift}, noise: {{v: {noise}, w: {noise}}}")
    robot = drive(made, 0.2, 0.5, 0.5)
    for _ in range(10):
        before, said = robot.odometry, robot.odometry_twist
        made.step()
        after = robot.odometry
        assert wrapped(after.theta - before.theta) == pytest.approx(said.w * 0.01, abs=1e-9)
        assert math.dist((after.x, after.y), (before.x, before.y)) == pytest.approx(said.v * 0.01, rel=1e-3)


def test_errors_of_one_and_zero_are_none_to_the_last_bit() -> None:
    noise = "noise: {v: 0.05, w: 0.1}"
    lives = []
    for odom in (noise, f"{noise}, scale: {{v: 1, w: 1.0}}, drift: 0"):
        made = world(odom)
        lives.append([drive(made, 0.05, 0.3, 0.4).odometry for _ in range(60)])
    assert lives[0] == lives[1]


def test_many_robots_err_as_each_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    kinds = ("", "odom: {drift: 0.1}", "odom: {scale: {v: 0.9}, noise: {w: 0.1}}", "odom: {scale: {w: 1.1}}")
    text = "\n".join(f"- {{name: r{k}, pose: [{3 * k}, {k}], {kinds[k % 4]}}}" for k in range(12))
    lives = []
    for many in (1000, 1):
        monkeypatch.setattr(fleet, "MANY", many)
        made = World(load_world("many.yaml", text=f"robots:\n{text}"))
        for step in range(300):
            for index, robot in enumerate(made.robots.values()):
                robot.command(0.5 * math.sin(0.02 * step + index), math.cos(0.01 * step * index))
            made.step()
        lives.append([(robot.odometry, robot.odometry_twist, robot.pose) for robot in made.robots.values()])
    assert lives[0] == lives[1]


@pytest.mark.parametrize(
    ("odom", "said"),
    [
        ("scale: {v: 0.03}", r"odom\.scale\.v: expected float >= 0\.5, got '0\.03'"),
        ("scale: 1.02", r"odom\.scale: expected mapping, got '1\.02'"),
        ("drift: 57", r"odom\.drift: expected float <= 1\.0, got '57'"),
        ("drift: {v: 1}", r"odom\.drift: expected float, got mapping"),
        ("scales: {v: 1}", "unknown key 'scales'"),
        ("scale: {v: .nan}", r"odom\.scale\.v"),
    ],
)
def test_wrong_errors_are_told_with_their_place(odom: str, said: str) -> None:
    with pytest.raises(DocumentError, match=said):
        world(odom)
