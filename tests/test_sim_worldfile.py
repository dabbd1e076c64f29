"""World files: what they may say, and what they are told when they are wrong."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from robolink.exceptions import DocumentError
from robolink.sim import Pose, World, WorldDescription, load_world
from robolink.sim.description import Drive, Lidar, Obstacle, Shape
from robolink.sim.worldfile import problems, steps_between

WORLDS = Path(__file__).parent.parent / "configs" / "worlds"


def loaded(text: str) -> WorldDescription:
    return load_world("w.yaml", text=text)


@pytest.mark.parametrize("path", sorted(WORLDS.glob("*.yaml")), ids=lambda path: path.stem)
def test_the_worlds_that_come_along_have_a_robot_with_a_scan(path: Path) -> None:
    world = World(load_world(path))
    (robot,) = world.robots.values()
    assert math.isfinite(robot.scan().ranges.max())
    assert world.nearest_wall_distance(robot.pose.x, robot.pose.y) > 0.3
    assert world.description.world.name == path.stem


def test_all_that_a_world_may_say() -> None:
    world = loaded(
        """
        world: {name: hall, size: [10, 8], dt: 0.02, rtf: 0, seed: 7}
        walls:
          - {polyline: [[0, 0], [10, 0], [10, 8]]}
          - {polyline: [[1, 1], [2, 1], [2, 2]], closed: true}
        obstacles:
          - {box: [0.8, 0.4], pose: [3, 2, 0.5]}
          - {circle: 0.25, pose: [5, 5], mass: 2.0}
        robots:
          - name: r1
            pose: [8, 1, -1.5]
            shape: {box: [0.4, 0.3]}
            mass: 5
            drive: {type: diff, v_max: 0.6, w_max: 2.5, a_max: 1, alpha_max: 4, timeout: 1}
            odom: {rate: 25}
            sensors:
              - {lidar: scan, rate: 5, beams: 181, fov: 180, start: -90, range: [0.1, 8], noise: 0.01, dropout: 0.05,
                 offset: [0.1, 0, 0]}
        """
    )
    (robot,) = world.robots
    assert (world.world.name, world.world.dt, world.world.rtf, world.world.seed) == ("hall", 0.02, 0.0, 7)
    assert [len(wall.segments()) for wall in world.walls] == [2, 3]
    assert world.obstacles[1] == Obstacle(circle=0.25, pose=Pose(5.0, 5.0), mass=2.0)
    assert robot.shape == Shape(box=(0.4, 0.3))
    assert robot.drive == Drive("diff", 0.6, 2.5, 1.0, 4.0, 1.0)
    assert robot.sensors == (Lidar("scan", 5.0, 181, 180.0, -90.0, (0.1, 8.0), 0.01, 0.05, Pose(0.1, 0.0, 0.0)),)


def test_everything_has_a_default() -> None:
    assert loaded("{}") == WorldDescription()
    (robot,) = loaded("robots: [{name: r, pose: [1, 2]}]").robots
    assert (robot.shape, robot.drive, robot.pose.theta) == (Shape(circle=0.17), Drive(), 0.0)


ROBOT = "robots: [{name: r, pose: [1, 1], %s}]"
BAD = {
    "wals: []": "w.yaml:1:1: wals: unknown key 'wals' (did you mean 'walls'?)",
    ROBOT % "drve: {}": "1:34: robots[0].drve: unknown key 'drve' (did you mean 'drive'?)",
    ROBOT % "drive: {vmax: 1}": "1:42: robots[0].drive.vmax: unknown key 'vmax' (did you mean 'v_max'?)",
    ROBOT % "drive: {v_max: fast}": "1:49: robots[0].drive.v_max: expected float, got 'fast'",
    ROBOT % "drive: {v_max: 0}": "robots[0].drive.v_max: expected float >= 0.001, got '0'",
    ROBOT % "drive: {v_max: .nan}": "robots[0].drive.v_max: expected float >= 0.001, got '.nan'",
    ROBOT % "drive: {v_max: .inf}": "robots[0].drive.v_max: expected float <= 1000.0, got '.inf'",
    ROBOT % "drive: {v_max: 30}": "30 m/s is 0.3 m in a step of 0.01 s, and a robot of 0.17 m could pass through walls",
    ROBOT % "drive: {w_max: 400}": "more than a quarter turn in a step of 0.01 s: at most 157.1",
    ROBOT % "drive: {type: dif}": "1:48: robots[0].drive.type: no drive is called 'dif' (did you mean 'diff'?)",
    ROBOT % "shape: {}": "1:41: robots[0].shape: expected one of 'box' and 'circle', got neither",
    ROBOT % "shape: {box: [1, 1], circle: 1}": "expected one of 'box' and 'circle', got both",
    ROBOT % "shape: {circle: 0}": "robots[0].shape.circle: expected float >= 0.001, got '0'",
    ROBOT % "odom: {rate: 30}": "30 Hz is no whole number of steps of 0.01 s: take 25 or 33.3333",
    ROBOT % "odom: {rate: 200}": "200 Hz is no whole number of steps of 0.01 s: take 100",
    ROBOT % "sensors: [{lidar: scan, rate: 7}]": "7 Hz is no whole number of steps of 0.01 s: take 6.66667 or 7.14286",
    ROBOT % "sensors: [{lidar: scan, range: [5, 2]}]": "the nearest, 5 m, must be less than the farthest, 2 m",
    ROBOT % "sensors: [{lidar: scan}, {lidar: scan}]": "sensors[1].lidar: two sensors publish on 'scan'",
    ROBOT % "sensors: [{lidar: odom}]": "the topic 'odom' is taken",
    ROBOT % "sensors: [{lidar: 'my scan'}]": "'my scan' is no name",
    ROBOT % "sensors: [{lidar: scan, beams: 1}]": "sensors[0].beams: expected int >= 2, got '1'",
    ROBOT % "sensors: [{sonar: scan}]": "robots[0].sensors[0].sonar: unknown key 'sonar'",
    "robots: [{name: 7up, pose: [3, 3]}]": "1:17: robots[0].name: '7up' is no name",
    'robots: [{name: "r\\n", pose: [3, 3]}]': r"'r\n' is no name",
    "robots: [{name: r, pose: [1, 1]}, {name: r, pose: [3, 3]}]": "1:42: robots[1].name: two robots are called 'r'",
    "robots: [{name: r, pose: [1, 1]}, {name: s, pose: [1.2, 1]}]": "robots[0].pose: this starts inside of robots[1]",
    "robots: [{name: r, pose: [1, 1, 90]}]": "robots[0].pose[2]: expected float <= 6.2832, got '90'",
    "robots: [{name: r, pose: [1]}]": "robots[0].pose: expected list of at least length 2, got 1",
    "robots: [{name: r}]": "1:10: robots[0]: missing key 'pose'",
    "world: {size: [4, 4]}\nrobots: [{name: r, pose: [5, 1]}]": "2:26: robots[0].pose: [5, 1] lies outside",
    "world: {dt: 0}": "world.dt: expected float >= 0.0001, got '0'",
    "world: {seed: -1}": "world.seed: expected int >= 0, got '-1'",
    "walls: [{polyline: [[0, 0]]}]": "1:20: walls[0].polyline: expected list of length >= 2",
    "walls: [{polyline: [[0, 0], [1, 0]], closed: true}]": "a closed wall needs 3 points or more, got 2",
    "walls: [{polyline: [[0, 0], [1, 0], [1, 0]]}]": "walls[0].polyline[2]: a wall from [1, 0] to the same point",
    "walls: [{polyline: [[0, 0], [1, 0], [1, 1], [0, 0]], closed: true}]": "'closed: true' already leads back",
    "obstacles: [{pose: [1, 1]}]": "1:13: obstacles[0]: expected one of 'box' and 'circle', got neither",
    "obstacles: [{box: [0, 1], pose: [1, 1]}]": "obstacles[0].box[0]: expected float >= 0.001, got '0'",
    "obstacles: [{box: [1, 1], pose: [0, 0]}]\n" + ROBOT % "mass: 1, pose: [0.6, 0]": "key 'pose' is given twice",
    "obstacles: [{box: [2, 2], pose: [1, 1]}]\n" + ROBOT % "": "2:26: robots[0].pose: this starts inside of obst",
    "walls: [{polyline: [[0, 1.1], [9, 1.1]]}]\n" + ROBOT % "": "robots[0].pose: this starts inside of walls[0]",
    "obstacles: [{circle: 1, pose: [1, 1], mass: 1}, {circle: 1, pose: [1, 1]}]": "obstacles[0].pose: this starts",
    "walls: [": "w.yaml:1:",
    "- 1": "expected mapping",
}


@pytest.mark.parametrize(("text", "expected"), BAD.items())
def test_what_is_wrong_is_said_with_its_place(text: str, expected: str) -> None:
    with pytest.raises(DocumentError) as caught:
        loaded(text)
    message = str(caught.value)
    assert message.startswith("w.yaml:")
    assert expected in message
    assert "\n" not in message


def test_what_only_touches_does_not_overlap() -> None:
    text = "walls: [{polyline: [[0, 0], [9, 0]]}]\nobstacles: [{box: [1, 1], pose: [5, 0.5], mass: 1}]\n"
    world = loaded(text + "robots: [{name: r, pose: [1, 0.17]}]")
    assert list(problems(world)) == []


def test_fixed_things_may_overlap() -> None:
    assert len(loaded("obstacles: [{circle: 1, pose: [0, 0]}, {box: [1, 1], pose: [0, 0]}]").obstacles) == 2


@pytest.mark.parametrize(
    ("rate", "dt", "steps"),
    [(10, 0.01, 10), (50, 0.01, 2), (100, 0.01, 1), (30, 0.01, 0), (200, 0.01, 0), (100 / 3, 0.01, 3)],
)
def test_rates_are_whole_numbers_of_steps(rate: float, dt: float, steps: int) -> None:
    assert steps_between(rate, dt) == steps


NUMBERS = st.one_of(st.integers(-3, 12), st.floats(-3, 12), st.sampled_from([1e-9, 1e5, 1e300, math.nan, -math.inf]))
SCALARS = st.one_of(NUMBERS, st.text(max_size=4), st.booleans(), st.none())
PAIRS = st.lists(NUMBERS, min_size=2, max_size=2)
POSES = st.lists(st.one_of(st.floats(-6, 6), NUMBERS), min_size=1, max_size=4)


def mapping(**values: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    """A mapping with any of these keys, now and then with a wrong value or a key too many."""
    some = st.fixed_dictionaries({}, optional={key: value | SCALARS for key, value in values.items()})
    return some | st.builds(lambda good, key, bad: {**good, key: bad}, some, st.text(max_size=3), SCALARS)


SHAPES = {"box": PAIRS, "circle": NUMBERS}
LIDARS = mapping(lidar=st.just("scan"), rate=NUMBERS, beams=NUMBERS, fov=NUMBERS, range=PAIRS, offset=POSES)
ROBOTS = mapping(
    name=st.just("r"),
    pose=POSES,
    shape=mapping(**SHAPES),
    mass=NUMBERS,
    drive=mapping(v_max=NUMBERS, w_max=NUMBERS, a_max=NUMBERS, timeout=NUMBERS),
    sensors=st.lists(LIDARS, max_size=2),
)
FILES = mapping(
    world=mapping(dt=st.sampled_from([0.01, 0.1]) | NUMBERS, size=PAIRS, seed=NUMBERS),
    walls=st.lists(mapping(polyline=st.lists(PAIRS, max_size=4), closed=st.booleans()), max_size=2),
    obstacles=st.lists(mapping(pose=POSES, mass=NUMBERS, **SHAPES), max_size=3),
    robots=st.lists(ROBOTS, max_size=2),
)


def loaded_or_refused(text: str) -> WorldDescription | None:
    """Give the world, or None for a text that is refused as it should be."""
    try:
        return loaded(text)
    except DocumentError as error:
        refusal = str(error)
    assert refusal.startswith("w.yaml:")
    return None


def as_yaml(content: Any) -> str:
    return json.dumps(content).replace("NaN", ".nan").replace("Infinity", ".inf")


@given(FILES)
@settings(max_examples=150, deadline=None)
def test_a_file_of_wrong_values_raises_nothing_but_a_document_error(content: Any) -> None:
    world = loaded_or_refused(as_yaml(content))
    assert world is None or isinstance(world, WorldDescription)


LENGTHS = st.floats(0.05, 1.0) | st.floats(0.001, 1e5)
PLACES = st.lists(st.floats(-6, 6), min_size=2, max_size=3)
OUTLINES = st.fixed_dictionaries({"circle": LENGTHS}) | st.fixed_dictionaries({"box": st.tuples(LENGTHS, LENGTHS)})
MASSES = st.sampled_from([0.001, 1.0, 1e5])
SHARP = {"a_max": 1000, "alpha_max": 1000}
POLYLINES = st.lists(st.tuples(st.floats(-6, 6), st.floats(-6, 6)), min_size=2, max_size=4)
GOOD_WALLS = st.fixed_dictionaries({"polyline": POLYLINES})
GOOD_OBSTACLES = st.builds(
    lambda shape, rest: {**shape, **rest},
    OUTLINES,
    st.fixed_dictionaries({"pose": PLACES}, optional={"mass": MASSES}),
)
GOOD_ROBOTS = st.fixed_dictionaries(
    {"name": st.just("r"), "pose": PLACES, "sensors": st.just([{"lidar": "scan", "noise": 0.01}])},
    optional={"shape": OUTLINES, "mass": MASSES, "drive": st.just(SHARP)},
)
GOOD_FILES = st.fixed_dictionaries(
    {
        "walls": st.lists(GOOD_WALLS, max_size=2),
        "obstacles": st.lists(GOOD_OBSTACLES, max_size=2),
        "robots": st.lists(GOOD_ROBOTS, max_size=1),
    }
)


@given(GOOD_FILES)
@settings(max_examples=80, deadline=None)
def test_a_file_that_is_not_refused_can_be_simulated(content: Any) -> None:
    description = loaded_or_refused(as_yaml(content))
    if description is None:
        return
    world = World(description)
    for robot in world.robots.values():
        robot.command(1.0, 1.0)
    for _ in range(3):
        world.step()
    for robot in world.robots.values():
        assert math.isfinite(robot.pose.x + robot.pose.theta)
        assert not np.isnan(robot.scan().ranges).any()


@given(st.text(st.sampled_from("[]{}:-,&*!|>'\"#%@ \n\t0a\x00é\ud800") | st.characters(), max_size=40))
@example("robots: [{name: r, pose: [1e400, 0]}]")
@settings(max_examples=150, deadline=None)
def test_no_text_raises_anything_but_a_document_error(text: str) -> None:
    assert loaded_or_refused(text) is None or loaded(text) == WorldDescription()
