"""World files of any content are read or refused, and what is not refused can be simulated."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from robolink.exceptions import DocumentError
from robolink.sim import World, WorldDescription, load_world
from robolink.sim.description import RobotDescription
from robolink.sim.scene.scenery import scenery
from robolink.sim.worldfile import check_world


def loaded(text: str) -> WorldDescription:
    return load_world("w.yaml", text=text)


NUMBERS = st.one_of(st.integers(-3, 12), st.floats(-3, 12), st.sampled_from([1e-9, 1e5, 1e300, math.nan, -math.inf]))
SCALARS = st.one_of(NUMBERS, st.text(max_size=4), st.booleans(), st.none())
PAIRS = st.lists(NUMBERS, min_size=2, max_size=2)
POSES = st.lists(st.one_of(st.floats(-6, 6), NUMBERS), min_size=1, max_size=4)


def mapping(**values: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    """A mapping with any of these keys, now and then with a wrong value or a key too many."""
    some = st.fixed_dictionaries({}, optional={key: value | SCALARS for key, value in values.items()})
    return some | st.builds(lambda good, key, bad: {**good, key: bad}, some, st.text(max_size=3), SCALARS)


PATHS = st.lists(PAIRS, max_size=5)
SHAPES = {"box": PAIRS, "circle": NUMBERS, "polygon": PATHS}
SENSED: dict[str, st.SearchStrategy[Any]] = {
    **{
        kind: st.sampled_from(["scan", "imu", "odom"])
        for kind in ("lidar", "bumper", "imu", "range_finder", "encoders")
    },
    **dict.fromkeys(("rate", "beams", "fov", "start", "dropout", "ticks"), NUMBERS),
    "range": PAIRS,
    "offset": POSES,
    "noise": NUMBERS | mapping(gyro=NUMBERS),
    "radiation": st.sampled_from(["ultrasound", "radio"]),
}
LIMITS = ("v_max", "w_max", "a_max", "alpha_max", "timeout", "wheelbase", "steer_max", "steer_rate")
COLOURS = st.sampled_from(["red", "#00ff00", "#0f0", "rod", ""])
SIGNS = mapping(
    pose=POSES,
    tag=st.sampled_from(["36h11/3", "4x4_50/50", "36h11"]),
    image=st.sampled_from(["w.png", "", ".", "a\0b"]),
    z=NUMBERS,
    size=NUMBERS,
)
SOME_SIGNS = st.lists(SIGNS, max_size=1)
PAINT = mapping(
    line=PATHS,
    width=NUMBERS,
    radius=NUMBERS,
    closed=st.booleans(),
    dashes=PAIRS,
    pose=POSES,
    colour=COLOURS,
    **SHAPES,
)
FLOORS = mapping(colour=COLOURS, image=st.sampled_from(["w.png", ""]), resolution=NUMBERS, origin=PAIRS)
ROBOTS = mapping(
    name=st.just("r"),
    pose=POSES,
    shape=mapping(**SHAPES),
    mass=NUMBERS,
    drive=mapping(type=st.sampled_from(["diff", "omni", "ackermann"]), **dict.fromkeys(LIMITS, NUMBERS)),
    wheels=st.lists(mapping(motor=st.sampled_from("ab"), at=POSES, radius=NUMBERS), max_size=4),
    sensors=st.lists(mapping(**SENSED), max_size=2),
    colour=COLOURS,
    height=NUMBERS,
    signs=SOME_SIGNS,
)
FILES = mapping(
    world=mapping(dt=st.sampled_from([0.01, 0.1]) | NUMBERS, size=PAIRS, seed=NUMBERS, floor=FLOORS),
    map=mapping(yaml=st.sampled_from(["w.yaml", "", ".", "a\0b"])),
    walls=st.lists(mapping(polyline=PATHS, closed=st.booleans(), colour=COLOURS, height=NUMBERS), max_size=2),
    obstacles=st.lists(
        mapping(pose=POSES, mass=NUMBERS, path=PATHS, speed=NUMBERS, colour=COLOURS, signs=SOME_SIGNS, **SHAPES),
        max_size=3,
    ),
    robots=st.lists(ROBOTS, max_size=2),
    paint=st.lists(PAINT, max_size=2),
    signs=SOME_SIGNS,
)
ANYTHING = st.recursive(
    SCALARS,
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from([*WorldDescription.__struct_fields__, *RobotDescription.__struct_fields__]), inner
        )
    ),
    max_leaves=8,
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


@pytest.mark.slow
@given(FILES | ANYTHING)
@settings(max_examples=200, deadline=None)
def test_a_file_of_wrong_values_raises_nothing_but_a_document_error(content: Any) -> None:
    world = loaded_or_refused(as_yaml(content))
    assert world is None or isinstance(world, WorldDescription)
    checked = check_world("w.yaml", text=as_yaml(content))
    assert (world, bool(checked.errors)) == (checked.description, world is None)


LENGTHS = st.floats(0.05, 1.0) | st.floats(0.001, 1e5)
PLACES = st.lists(st.floats(-6, 6), min_size=2, max_size=3)
CORNERS = st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=3, max_size=6)
OUTLINES = (
    st.fixed_dictionaries({"circle": LENGTHS})
    | st.fixed_dictionaries({"box": st.tuples(LENGTHS, LENGTHS)})
    | st.fixed_dictionaries({"polygon": CORNERS})
)
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
GOOD_LINES = st.fixed_dictionaries(
    {"line": POLYLINES},
    optional={
        "width": st.floats(0.001, 1.0),
        "radius": st.floats(0.0, 9.0),
        "closed": st.booleans(),
        "dashes": st.tuples(st.floats(0.02, 1.0), st.floats(0.02, 1.0)),
    },
)
GOOD_FILES = st.fixed_dictionaries(
    {
        "walls": st.lists(GOOD_WALLS, max_size=2),
        "obstacles": st.lists(GOOD_OBSTACLES, max_size=2),
        "robots": st.lists(GOOD_ROBOTS, max_size=1),
        "paint": st.lists(GOOD_LINES | OUTLINES, max_size=2),
        "signs": st.lists(st.fixed_dictionaries({"tag": st.just("36h11/3"), "pose": PLACES}), max_size=2),
        "world": st.just({"floor": {"resolution": 0.02}}),
    }
)


@pytest.mark.slow
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
    faces = scenery(description).fixed.faces
    assert np.isfinite([number for face in faces for vector in face[:3] for number in vector]).all()


@pytest.mark.slow
@given(st.text(st.sampled_from("[]{}:-,&*!|>'\"#%@ \n\t0a\x00é\ud800") | st.characters(), max_size=40))
@example("robots: [{name: r, pose: [1e400, 0]}]")
@settings(max_examples=150, deadline=None)
def test_no_text_raises_anything_but_a_document_error(text: str) -> None:
    assert loaded_or_refused(text) is None or loaded(text) == WorldDescription()
