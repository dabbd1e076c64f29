"""Worlds of Webots as worlds of this simulator: what of them is flat, what stands in the way, what is told."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink.documents.foreign import warnings_to
from robolink.exceptions import DocumentError
from robolink.sim import World, WorldDescription, WorldError, load_world
from robolink.sim.description import Obstacle
from robolink.sim.quantities import Pose
from robolink.sim.webots import WebotsWorld, WorldWarning, load, read
from robolink.workspace import find_world, list_worlds

HEADER = "#VRML_SIM R2023b utf8\n"
CART = 'Robot { name "cart" children [ Shape { geometry Box { size 0.2 0.2 0.2 } } ] translation %s }'


def world(text: str) -> WebotsWorld:
    return read("w.wbt", HEADER + text)


def obstacles(text: str) -> list[Obstacle]:
    """The obstacles as lidars see them, without their heights."""
    return [msgspec.structs.replace(each, height=None) for each in world(text).description.obstacles]


def obstacle(text: str) -> Obstacle:
    (found,) = obstacles(text)
    return found


def refused(text: str) -> str:
    with pytest.raises(DocumentError) as caught:
        world(text)
    return str(caught.value)


def box(size: str, more: str = "") -> str:
    return f"Solid {{ {more} children [ Shape {{ geometry Box {{ size {size} }} }} ] }}"


def test_the_world_itself() -> None:
    settings_ = world('WorldInfo { title "Hall" basicTimeStep 16 randomSeed 7 info [ "by me" ] }').description.world
    assert (settings_.name, settings_.dt, settings_.seed) == ("Hall", 0.016, 7)
    assert world("").description.world.dt == 0.032
    assert world('WorldInfo { info [ "by me" ] }').description.world.name == "by me"
    assert world("WorldInfo { basicTimeStep 128 }").description.world.dt == pytest.approx(0.064)


@pytest.mark.parametrize(
    ("text", "report"),
    [
        ("WorldInfo { basicTimeStep 0.1 }", "2:27: WorldInfo.basicTimeStep: expected 1 ms or more, got 0.1"),
        (box("1 1 1", "translation 1e9 0 0"), "2:21: Solid.translation: this is more than 100 km away"),
    ],
)
def test_what_cannot_be(text: str, report: str) -> None:
    assert report in refused(text)


def test_an_arena_is_four_walls_at_the_faces_that_one_sees_from_inside() -> None:
    (wall,) = world("RectangleArena { translation 1 0 0 rotation 0 0 1 1.5708 floorSize 4 2 }").description.walls
    assert wall.closed
    corners = [(round(x, 3), round(y, 3)) for x, y in wall.polyline]
    assert sorted(corners) == [(0.0, -2.0), (0.0, 2.0), (2.0, -2.0), (2.0, 2.0)]
    (ring,) = world("CircleArena { radius 2 subdivision 24 }").description.walls
    assert len(ring.polyline) == 24
    assert {round(math.hypot(*corner), 9) for corner in ring.polyline} == {2.0}


def test_shapes_from_above() -> None:
    assert obstacle(box("2 1 1", "translation 3 4 0.5 rotation 0 0 1 0.5")) == Obstacle(
        box=(2.0, 1.0), pose=Pose(3, 4, 0.5)
    )
    cylinder = "Solid { translation 1 2 0 children [ Shape { geometry Cylinder { radius 0.3 height 1 } } ] }"
    assert obstacle(cylinder) == Obstacle(circle=0.3, pose=Pose(1, 2))
    lying = "translation 0 0 0.1 rotation 1 0 0 1.5708 children [ Shape { geometry Cylinder { radius 0.1 height 2 } } ]"
    assert obstacle(f"Solid {{ {lying} }}").box == pytest.approx((0.2, 2.0))
    capsule = "Solid { children [ Shape { geometry Capsule { radius 0.2 height 1 } } ] }"
    assert obstacle(capsule) == Obstacle(circle=0.2, pose=Pose(0, 0))
    prism = (
        "IndexedFaceSet { coord Coordinate { point [ 0 0 0 2 0 0 0 1 0 0 0 1 2 0 1 0 1 1 ] } coordIndex [ 0 1 2 -1 ] }"
    )
    found = obstacle(f"Solid {{ children [ Shape {{ geometry {prism} }} ] }}")
    assert found.polygon is not None
    assert found.pose is not None
    placed = {(round(x + found.pose.x, 6), round(y + found.pose.y, 6)) for x, y in found.polygon}
    assert placed == {(0.0, 0.0), (2.0, 0.0), (0.0, 1.0)}


def test_a_ball_is_as_wide_as_it_is_within_the_robots_reach() -> None:
    ball = "Solid { translation 0 0 %s children [ Shape { geometry Sphere { radius 0.5 } } ] }"
    assert obstacle(ball % "0.3").circle == 0.5
    assert obstacle(ball % "0.9").circle == pytest.approx(0.3)  # 0.4 m above what is 0.5 m high
    assert obstacles(ball % "1.1") == []


def test_what_leans_is_cut_off_at_the_robots_height() -> None:
    leaning = box("0.1 1 4", "rotation 0 1 0 0.5")
    found = obstacle(leaning)
    assert found.box is not None
    height, low = 0.5 - 0.02, 0.02
    assert found.box[0] == pytest.approx(0.1 / math.cos(0.5) + height * math.tan(0.5))
    assert found.start.x == pytest.approx((low + height / 2) * math.tan(0.5))


def test_groups_transforms_and_scales_add_up() -> None:
    nested = """
        Group { children [ Transform { translation 1 0 0 scale 2 2 1 children [
          Pose { rotation 0 0 1 1.5707963267948966 children [ DEF BOX Shape { geometry Box { size 1 0.5 1 } } ] } ] }
        Solid { translation 5 0 0 children [ USE BOX ] } ] }
    """
    first, second = obstacles(nested)
    assert first == Obstacle(box=(1.0, 2.0), pose=Pose(1, 0))
    assert second == Obstacle(box=(1.0, 0.5), pose=Pose(5, 0))


def test_heights_decide() -> None:
    assert obstacles(box("9 9 0.1", "translation 0 0 -0.05")) == []  # a floor
    assert obstacles(box("1 1 0.1", "translation 0 0 2")) == []  # a lamp
    low_robot = CART % "3 0 0.1"
    assert obstacles(box("1 1 0.1", "translation 0 0 0.3") + low_robot) == []  # a table's top
    assert len(obstacles(box("1 1 0.1", "translation 0 0 0.15") + low_robot)) == 1
    stage = box("9 9 0.2", "translation 0 0 0.1")
    assert obstacles(stage + CART % "0 0 0.3") == []  # the robot stands on it
    raised = "Floor { translation 0 0 1 }" + box("1 1 1", "translation 2 0 0.5")
    assert obstacles(raised + CART % "0 0 1.1") == []


def test_what_it_collides_with_counts_else_what_one_sees() -> None:
    both = """Solid { children [ Shape { geometry Box { size 1 1 1 } } ]
              boundingObject Group { children [ Pose { translation 1 0 0 children [ Cylinder { radius 0.2 } ] } ] } }"""
    assert obstacle(both) == Obstacle(circle=0.2, pose=Pose(1, 0))


@pytest.mark.parametrize(
    ("physics", "mass"),
    [("Physics { mass 3 density -1 }", 3.0), ("Physics { }", 1000.0), ("Physics { density 2 }", 2.0), ("NULL", None)],
)
def test_physics_makes_it_pushable(physics: str, mass: float | None) -> None:
    assert obstacle(box("1 1 1", f"physics {physics}")).mass == mass


def test_what_is_fixed_to_something_pushable_moves_with_it() -> None:
    cross = f"""Solid {{ physics Physics {{ mass 1 }} children [ Shape {{ geometry Box {{ size 1 1 1 }} }}
                {box("1 1 1", "translation 1 0 0")} ] }}"""
    assert obstacle(cross) == Obstacle(box=(2.0, 1.0), pose=Pose(0.5, 0.0), mass=1.0)
    assert [each.pose for each in obstacles(cross.replace("physics Physics { mass 1 }", ""))] == [
        Pose(0, 0),
        Pose(1, 0),
    ]


def test_boxes_of_the_library() -> None:
    text = """Wall { translation 0 3 0 } WoodenBox { translation 2 0 0.05 size 0.1 0.2 0.1 } CardboardBox { mass 1.5 }
              SolidBox { translation -3 0 0 size 1 1 1 physics Physics { mass 2 } } Window { translation 0 -3 0 }"""
    wall, wooden, cardboard, solid, window = obstacles(text)
    assert (wall.box, wall.pose, wall.mass) == ((0.2, 1.0), Pose(0, 3), None)
    assert (wooden.box, wooden.mass) == ((0.1, 0.2), None)
    assert (cardboard.box, cardboard.mass) == ((0.6, 0.6), 1.5)
    assert (solid.box, solid.mass) == ((1.0, 1.0), 2.0)
    assert (window.box, window.pose) == ((0.2, 0.8), Pose(0, -3))
    assert obstacles("SolidBox { enableBoundingObject FALSE }") == []
    (raised,) = world("SolidBox { size 1 1 0.4 }" + CART % "3 0 0.1").description.obstacles or (None,)
    assert raised is None  # its default z is 1: above the cart


@pytest.mark.parametrize(
    ("text", "sides", "mass", "told"),
    [
        ("CardboardBox { size 2 2 2 }", (0.6, 0.6), None, "CardboardBox.size: the PROTO does not take this"),
        ("CardboardBox { size 3 0.5 0.6 translation 0 0 0.3 }", (2.5, 0.5), None, "2.5 0.5 0.6 is used"),
        ("WoodenBox { size 4 0.2 0.6 }", (3.0, 0.2), None, "3 0.2 0.6 is used"),
        ("CardboardBox { mass 0.1 }", (0.6, 0.6), 0.216 ** (2 / 3), "CardboardBox.mass: the PROTO does not take this"),
        ("CardboardBox { mass 999 }", (0.6, 0.6), 100 * 0.216 ** (2 / 3), "36 is used"),
        ("WoodenBox { mass 1 }", (0.6, 0.6), 1.0, ""),
        ("Wall { size 1 0 1 }", (0.2, 1.0), None, "Wall.size: expected more than 0, got 0; 0.2 1 2.4 is used"),
    ],
)
def test_the_library_brings_sizes_and_masses_into_range(
    text: str, sides: tuple[float, float], mass: float | None, told: str
) -> None:
    (found,), notes = world(text).description.obstacles, world(text).notes
    assert (found.box, found.mass) == (sides, mass if mass is None else pytest.approx(mass))
    assert [told in each for each in notes] == ([True] if told else [])


@pytest.mark.parametrize(("asked", "sides"), [(6, 8), (8, 8), (9, 9), (24, 24), (999, 360)])
def test_a_round_arena_has_eight_walls_at_least(asked: int, sides: int) -> None:
    (wall,) = world(f"CircleArena {{ subdivision {asked} }}").description.walls
    assert len(wall.polyline) == sides


def test_worlds_with_y_upwards_are_laid_down() -> None:
    north, height, east = 1.0, 0.5, 3.0
    thing = f"Solid {{ translation {north} {height} {east} children [ Shape {{ geometry Box {{ size 1 1 2 }} }} ] }}"
    (found,) = obstacles('WorldInfo { coordinateSystem "NUE" }' + thing)
    assert (found.box, found.pose) == ((2.0, 1.0), Pose(east, north))
    (found,) = obstacles('WorldInfo { coordinateSystem "EUN" }' + thing)
    assert (found.box, found.pose) == ((1.0, 2.0), Pose(1.0, -3.0))
    arena = 'WorldInfo { coordinateSystem "NUE" } RectangleArena { rotation 1 0 0 -1.5707963 floorSize 2 4 }'
    (wall,) = world(arena).description.walls
    assert {(round(abs(x), 3), round(abs(y), 3)) for x, y in wall.polyline} == {(2.0, 1.0)}
    odd = world('WorldInfo { coordinateSystem "XYZ" basicTimeStep 0 }')
    assert {each.rpartition("; ")[2] for each in odd.notes} == {"ENU is used", "32 is used"}


def test_what_is_not_known_is_told_in_one_warning(tmp_path: Path) -> None:
    text = "Fridge { } Sofa { } Sofa { } DirectionalLight { } TexturedBackground { } Fog { } Viewpoint { }"
    text += 'Solid { children [ Shape { geometry Mesh { url "a.obj" } } ] }'
    assert world(text).notes == ("not known here, so this is not there: Fridge, Mesh, Sofa (2 times)",)
    path = tmp_path / "w.wbt"
    path.write_text(HEADER + text)
    with pytest.warns(WorldWarning) as caught:
        load_world(path)
    assert [str(each.message) for each in caught] == [
        f"{path}: not known here, so this is not there: Fridge, Mesh, Sofa (2 times)"
    ]
    lines: list[str] = []
    with warnings_to(lines.append):
        load(path)
    assert lines == [str(caught[0].message)]


def test_worlds_of_webots_are_found_by_name_too(tmp_path: Path) -> None:
    folder = tmp_path / "configs" / "worlds"
    folder.mkdir(parents=True)
    (folder / "my_lab.wbt").write_text(HEADER)
    assert find_world("my-lab", workspace=tmp_path) == folder / "my_lab.wbt"
    assert find_world(str(folder / "my_lab.wbt")) == folder / "my_lab.wbt"
    assert "my_lab" in [each.stem for each in list_worlds(workspace=tmp_path)]


def test_what_is_too_light_for_walls_to_hold_is_told() -> None:
    light = box("0.1 0.1 0.3", 'name "feather" translation 2 0 0.15 physics Physics { mass 0.001 }')
    notes = world(f"{CART % '0 0 0.1'} {light}").notes
    assert "so light that a robot may push it through a wall: Solid 'feather'" in notes
    assert not any("so light" in each for each in world(f"{CART % '0 0 0.1'} {light.replace('0.001', '1')}").notes)


def test_what_is_too_light_keeps_only_a_heavier_robot_from_coming() -> None:
    light = box("0.1 0.1 0.3", 'name "feather" translation 2 0 0.15 physics Physics { mass 0.001 }')
    made = World(world(f"{CART % '0 0 0.1'} {light}").description)
    [cart] = made.description.robots
    another = msgspec.structs.replace(cart, name="another", pose=Pose(-3.0, 0.0))
    with pytest.raises(WorldError, match="would push through walls"):
        made.spawn(msgspec.structs.replace(another, mass=cart.mass + 1.0))
    assert made.spawn(another).name == "another"


def test_nothing_is_told_of_a_world_that_is_all_understood() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert load("w.wbt", HEADER + "RectangleArena { floorSize 9 9 }" + box("1 1 1")).obstacles


def test_things_that_run_into_each_other() -> None:
    corner = box("2 0.2 1") + box("0.2 2 1")
    assert len(obstacles(corner)) == 2
    pushed = box("1 1 1", 'name "crate" translation %s physics Physics { mass 1 }')
    stack = world(box("1 1 0.4", "translation 0 0 0.2") + pushed % "0.1 0 0.9")
    assert (len(stack.description.obstacles), stack.notes) == (1, ("Solid 'crate' stands on something else: left out",))
    stuck = world(box("1 1 1", "translation 0 0 0.5") + pushed % "0.1 0 0.5")
    assert [each.mass for each in stuck.description.obstacles] == [None, None]
    assert stuck.notes == ("Solid 'crate' starts inside of something else: nothing can push it",)


def test_a_robot_inside_of_something_is_an_error_with_its_place() -> None:
    report = refused(box("1 1 1", 'name "pillar" translation 0 0 0.5') + "\n" + CART % "0.2 0 0.1")
    assert report == "w.wbt:3:1: Robot 'cart': this starts inside of Solid 'pillar': move it out of there"


def test_a_mesh_for_the_eye_is_left_out() -> None:
    points = " ".join(f"{x} {x * x} 0" for x in range(600))
    mesh = (
        f"Solid {{ children [ Shape {{ geometry IndexedFaceSet {{ coord Coordinate {{ point [ {points} ] }} }} }} ] }}"
    )
    assert world(mesh).notes == ("not known here, so this is not there: IndexedFaceSet of 600 points",)


FIELDS = {
    "size": 3,
    "radius": 1,
    "height": 1,
    "translation": 3,
    "rotation": 4,
    "scale": 3,
    "floorSize": 2,
    "mass": 1,
    "anchor": 3,
    "axis": 3,
    "lookupTable": 3,
    "maxVelocity": 1,
    "fieldOfView": 1,
    "basicTimeStep": 1,
}
TYPES = ["Box", "Cylinder", "Sphere", "Capsule", "Cone", "Shape", "Solid", "Transform", "Group", "Robot", "WorldInfo"]
TYPES += [
    "HingeJoint",
    "RotationalMotor",
    "HingeJointParameters",
    "Physics",
    "Lidar",
    "DistanceSensor",
    "PositionSensor",
]
TYPES += ["RectangleArena", "WoodenBox", "Wall", "TouchSensor", "Gyro", "Sofa", "Floor", "CircleArena", "SolidBox"]
TYPES += ["TurtleBot3Burger", "Pioneer3at", "CardboardBox", "RobotisLds01"]
INNER = ["children", "geometry", "boundingObject", "endPoint", "device", "physics", "jointParameters"]
NUMBERS = st.sampled_from([0.0, 1e-6, 0.01, 0.5, 1.0, -1.0, 3.0, 1e3, 1e7, 1e300]) | st.floats(-10, 10)


def _written(fields: list[tuple[str, str]], kind: str) -> str:
    return f"{kind} {{ " + " ".join(f"{name} {value}" for name, value in fields) + " }"


def _field(inner: st.SearchStrategy[str]) -> st.SearchStrategy[tuple[str, str]]:
    numbers = st.sampled_from(sorted(FIELDS)).flatmap(
        lambda name: st.tuples(
            st.just(name),
            st.lists(NUMBERS, min_size=FIELDS[name], max_size=FIELDS[name]).map(lambda each: " ".join(map(str, each))),
        )
    )
    nodes = st.tuples(st.sampled_from(INNER), st.lists(inner, max_size=3).map(lambda each: f"[ {' '.join(each)} ]"))
    return numbers | nodes | st.tuples(st.just("name"), st.sampled_from(['"a b"', '""', '"left"', '"é 1"']))


WORLDS = st.recursive(
    st.sampled_from(TYPES).map(lambda kind: f"{kind} {{ }}"),
    lambda inner: st.builds(_written, st.lists(_field(inner), max_size=5), st.sampled_from(TYPES)),
    max_leaves=15,
)


@pytest.mark.slow
@settings(max_examples=100)
@given(st.lists(WORLDS, max_size=4).map("\n".join))
def test_any_world_gives_a_valid_description_or_a_document_error(text: str) -> None:
    try:
        description = world(text).description
    except DocumentError as error:
        report = str(error)
    else:
        report = ""
        is_valid(description)
    assert report == "" or report.startswith("w.wbt:")


def is_valid(description: WorldDescription) -> None:
    """See that every number is within its limits, and that it makes a world."""
    for robot in description.robots:
        for sensor in robot.sensors:
            msgspec.convert(msgspec.to_builtins(sensor), type(sensor))
    plain = msgspec.to_builtins(
        msgspec.structs.replace(
            description, robots=tuple(msgspec.structs.replace(each, sensors=()) for each in description.robots)
        )
    )
    assert msgspec.convert(plain, WorldDescription).obstacles == description.obstacles
    made = World(description)
    made.step()
    assert set(made.robots) == {each.name for each in description.robots}


RED = "appearance Appearance { material Material { diffuseColor 1 0 0 } }"
BLUE = "appearance PBRAppearance { baseColor 0 0.5 1 roughness 1 }"
TEXTURED = 'appearance PBRAppearance { baseColorMap ImageTexture { url "wood.jpg" } }'


@pytest.mark.parametrize(
    ("text", "height", "colour"),
    [
        (
            f"Solid {{ translation 0 0 0.3 children [ Shape {{ {RED} geometry Box {{ size 1 1 0.6 }} }} ] }}",
            0.6,
            "#ff0000",
        ),
        (f"Shape {{ {BLUE} geometry Cylinder {{ radius 0.2 height 0.5 }} }}", 0.25, "#0080ff"),
        ("Shape { appearance PBRAppearance { } geometry Sphere { radius 0.2 } }", 0.2, "#ffffff"),
        ("Shape { appearance Appearance { material Material { } } geometry Sphere { } }", 1.0, "#cccccc"),
        (f"Shape {{ {TEXTURED} geometry Sphere {{ }} }}", 1.0, None),
        ("Shape { appearance Parquetry { } geometry Sphere { } }", 1.0, None),
        ("Shape { geometry Sphere { } }", 1.0, None),
        (f"SolidBox {{ {BLUE} size 1 1 0.4 translation 0 0 0.2 }}", 0.4, "#0080ff"),
        (f"Window {{ {RED.replace('appearance', 'wallAppearance', 1)} }}", 2.4, "#ff0000"),
        (f"Wall {{ {RED} }}", 2.4, "#ff0000"),
        # the colour of what is seen, where something else is what it collides with
        (
            (
                f"Solid {{ children [ Pose {{ children [ Shape {{ {RED} geometry Box {{ size 1 1 1 }} }} ] }} ]"
                " boundingObject Box { size 1 1 0.8 } }"
            ),
            0.4,
            "#ff0000",
        ),
        # two of one thing that is pushed: the first colour, the greatest height
        (
            (
                f"Solid {{ physics Physics {{ }} children [ Shape {{ {BLUE} geometry Box {{ size 1 1 1 }} }}"
                f" Pose {{ translation 0 0 1 children [ Shape {{ {RED} geometry Box {{ size 1 1 2 }} }} ] }} ] }}"
            ),
            2.0,
            "#0080ff",
        ),
    ],
)
def test_things_keep_their_heights_and_colours(text: str, height: float, colour: str | None) -> None:
    (found,) = world(f"Floor {{ }} {text}").description.obstacles
    assert found.height == pytest.approx(height)
    assert found.colour == colour


def test_arenas_and_floors_keep_their_colours() -> None:
    wall, floor = RED.replace("appearance", "wallAppearance", 1), BLUE.replace("appearance", "floorAppearance", 1)
    found = world(f"RectangleArena {{ wallHeight 0.3 translation 0 0 2 {wall} {floor} }}").description
    assert found.walls[0].height == pytest.approx(0.3)
    assert found.walls[0].colour == "#ff0000"
    assert found.world.floor.colour == "#0080ff"
    assert world(f"Floor {{ {RED} }}").description.world.floor.colour == "#ff0000"
    assert world("RectangleArena { }").description.world.floor.colour is None


def test_a_colour_of_two_numbers_is_named() -> None:
    bad = refused("Shape { appearance PBRAppearance { baseColor 1 0 } geometry Sphere { } }")
    assert bad.endswith("PBRAppearance.baseColor: expected 3 numbers, got 2")
