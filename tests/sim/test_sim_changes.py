"""Robots that come into a running world, leave it, or are put elsewhere."""

from __future__ import annotations

import math
from pathlib import Path

import msgspec
import pytest

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.sim import Pose, World, WorldError, load_world
from robolink.sim.description import Drive, RobotDescription, Shape
from robolink.sim.sensors import Lidar

TEXT = """
walls: [{polyline: [[0, 0], [8, 0], [8, 5], [0, 5]], closed: true}]
obstacles: [{box: [1, 1], pose: [6, 3]}, {circle: 0.3, pose: [6, 1], mass: 2}]
robots:
  - {name: a, pose: [1, 1], sensors: [{lidar: scan, noise: 0.01}], odom: {noise: {v: 0.05}}}
  - {name: b, pose: [3, 1]}
"""
NEW = RobotDescription("c", Pose(2.0, 3.0, 1.0), sensors=(Lidar("scan", beams=4),))


def world() -> World:
    return World(load_world("changes.yaml", text=TEXT))


def run(world: World, seconds: float, v: float = 0.2) -> None:
    for _ in range(round(seconds * 100)):
        for robot in world.robots.values():
            robot.command(v, 0.0)
        world.step()


def test_a_robot_that_comes_drives_and_sees_and_is_seen() -> None:
    made = world()
    run(made, 1.0)
    robots = made.robots
    robot = made.spawn(NEW)
    assert robots["c"] is robot
    assert list(robots) == ["a", "b", "c"]
    run(made, 1.0)
    assert robot.pose.x > 2.05
    run(made, 0.1)
    assert [reading.robot.name for reading in made.readings()] == ["a", "c"]
    before = made.robots["a"].pose
    made.robots["c"].teleport(Pose(before.x + 1.0, before.y))
    assert made.robots["a"].scan().ranges[180] == pytest.approx(1 - 0.17, abs=0.05)


def test_a_robot_that_leaves_is_gone() -> None:
    made = world()
    made.robots["a"].teleport(Pose(2.5, 1.0))
    run(made, 1.0)
    assert made.robots["a"].scan().ranges[180] < 0.4
    assert made.robots["a"].touching == 0
    made.delete("b")
    assert list(made.robots) == ["a"]
    run(made, 1.0)
    assert made.robots["a"].scan().ranges[180] > 2.0
    made.spawn(msgspec.structs.replace(NEW, name="b"))
    assert list(made.robots) == ["a", "b"]


def test_whoever_touches_a_robot_that_leaves_touches_it_no_more() -> None:
    made = world()
    made.robots["a"].teleport(Pose(3.0 - 0.36, 1.0))
    for _ in range(100):
        made.robots["a"].command(0.3, 0.0)
        made.step()
    assert made.robots["a"].touching == 1
    made.delete("b")
    assert made.robots["a"].touching == 0
    run(made, 1.0)
    assert made.robots["a"].touching == 0


def test_what_the_others_live_does_not_depend_on_who_comes_and_goes() -> None:
    alone, together = world(), world()
    found = []
    for made in (alone, together):
        run(made, 1.0)
        if made is together:
            made.spawn(msgspec.structs.replace(NEW, pose=Pose(7.0, 4.5)))
            run(made, 0.5)
            made.delete("c")
        else:
            run(made, 0.5)
        run(made, 0.5)
        robot = made.robots["a"]
        found.append((robot.pose, robot.odometry, robot.scan().ranges[:90].tobytes()))
    assert found[0] == found[1]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"name": "a"}, "there is a robot named 'a' already"),
        ({"pose": Pose(1.1, 1.0)}, r"robot 'c' can't stand at \[1.1, 1, 0\]: inside of another robot or an obstacle"),
        ({"pose": Pose(8.0, 3.0)}, "inside of a wall"),
        ({"pose": Pose(6.1, 3.1)}, "inside of an obstacle"),
        ({"pose": Pose(6.0, 1.0)}, "inside of another robot or an obstacle"),
        ({"pose": Pose(math.nan, 1.0)}, r"can't stand at \[nan, 1, 0\]: expected finite numbers, at most 100000 m"),
        ({"pose": Pose(1e9, 1.0)}, "expected finite numbers"),
        ({"name": "not a name"}, "is not a name"),
        ({"shape": Shape()}, "expected"),
        ({"drive": Drive(v_max=50.0)}, "v_max.*could pass through walls"),
        ({"sensors": (Lidar("scan", rate=7.0),)}, "7 Hz"),
        ({"mass": 1e5}, r"robot 'c': obstacles\[1\].mass: 2 kg, which robot 'c' of 100000 kg would push through walls"),
        (
            {"mass": 0.02},
            r"robot 'c': mass: 0.02 kg, which robot '[ab]' of 3 kg would push through walls: at least 0.03",
        ),
    ],
)
def test_a_robot_that_cannot_be_there_is_refused_and_nothing_changes(change: dict[str, object], message: str) -> None:
    made = world()
    with pytest.raises(WorldError, match=message) as caught:
        made.spawn(msgspec.structs.replace(NEW, **change))
    assert isinstance(caught.value, (RobolinkError, ValueError))
    assert list(made.robots) == ["a", "b"]
    before = len(made._space.bodies), len(made._space.shapes)
    made.spawn(NEW)
    made.delete("c")
    assert (len(made._space.bodies), len(made._space.shapes)) == before


def test_deleting_what_is_not_there_names_the_nearest() -> None:
    with pytest.raises(NotFoundError, match="no robot named 'robot_b'"):
        world().delete("robot_b")
    with pytest.raises(LookupError, match="did you mean 'a'"):
        world().delete("A")


def test_a_robot_that_is_put_elsewhere_stands_there_and_believes_to_be_where_it_was() -> None:
    made = world()
    run(made, 1.0)
    robot = made.robots["b"]
    believed = robot.odometry
    robot.teleport(Pose(3.0, 4.0, 1.5))
    assert robot.pose == Pose(3.0, 4.0, 1.5)
    assert robot.twist == (0.0, 0.0, 0.0)
    assert robot.odometry == believed
    made.step()
    assert math.dist((robot.pose.x, robot.pose.y), (3.0, 4.0)) < 1e-3
    run(made, 1.0)
    assert math.dist((robot.odometry.x, robot.odometry.y), (believed.x, believed.y)) == pytest.approx(
        math.dist((robot.pose.x, robot.pose.y), (3.0, 4.0)), abs=1e-9
    )


@pytest.mark.parametrize("pose", [Pose(1.1, 1.0), Pose(0.05, 2.0), Pose(6.0, 3.0), Pose(math.inf, 0.0)])
def test_a_robot_is_not_put_inside_of_something(pose: Pose) -> None:
    made = world()
    run(made, 1.0)
    robot = made.robots["b"]
    before, speed = robot.pose, robot.twist
    with pytest.raises(WorldError, match="robot 'b' can't stand at"):
        robot.teleport(pose)
    assert (robot.pose, robot.twist) == (before, speed)
    run(made, 0.5)
    assert robot.pose.x == pytest.approx(before.x + 0.1, abs=0.01)


@pytest.mark.parametrize("heading", [0.0, 0.3])
def test_a_robot_is_not_put_into_the_middle_of_a_maps_walls(tmp_path: Path, heading: float) -> None:
    wide, high = 60, 50  # cells of 0.1 m, among them a pillar of 2 m x 2 m
    rows = [bytes(0 if 20 <= x < 40 and 20 <= y < 40 else 254 for x in range(wide)) for y in range(high)]
    (tmp_path / "m.pgm").write_bytes(b"P5 %d %d 255\n" % (wide, high) + b"".join(rows))
    rest = "negate: 0, occupied_thresh: 0.65, free_thresh: 0.25"
    (tmp_path / "m.yaml").write_text(f"{{image: m.pgm, resolution: 0.1, origin: [0, 0, {heading}], {rest}}}")
    text = "map: {yaml: m.yaml}\nrobots: [{name: b, pose: [-2, -2]}]"
    made = World(load_world(str(tmp_path / "w.yaml"), text=text))
    cos, sin = math.cos(heading), math.sin(heading)
    middle = Pose(3 * cos - 2 * sin, 3 * sin + 2 * cos)
    for place in (
        lambda: made.robots["b"].teleport(middle),
        lambda: made.spawn(msgspec.structs.replace(NEW, pose=middle)),
    ):
        with pytest.raises(WorldError, match="inside of the map's walls"):
            place()
    assert list(made.robots) == ["b"]
    made.robots["b"].teleport(Pose(cos - sin, sin + cos))
    made.robots["b"].teleport(Pose(9.0, 2.0))


def test_a_robot_may_be_put_where_it_touches_and_where_it_was() -> None:
    robot = world().robots["b"]
    robot.teleport(Pose(0.17, 2.0))
    robot.teleport(robot.pose)
    assert robot.pose == Pose(0.17, 2.0, 0.0)


def test_two_robots_of_one_name_do_not_make_a_world() -> None:
    description = world().description
    twice = msgspec.structs.replace(description, robots=(description.robots[0],) * 2)
    with pytest.raises(WorldError, match="there is a robot named 'a' already"):
        World(twice)


def test_many_robots_may_come_and_go() -> None:
    made = World(load_world("open.yaml", text="robots: []"))
    for number in range(40):
        made.spawn(RobotDescription(f"r{number}", Pose(number * 1.0, 0.0)))
        run(made, 0.02)
    for number in range(0, 40, 3):
        made.delete(f"r{number}")
        run(made, 0.02)
    run(made, 1.0)
    assert len({round(robot.pose.y, 6) for robot in made.robots.values()}) == 1
    assert all(robot.twist.v == pytest.approx(0.2) for robot in made.robots.values())
