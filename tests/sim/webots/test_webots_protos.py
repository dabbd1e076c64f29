"""PROTOs of Webots: from files beside a world, from Webots' folder, from this one's own, and what is told of others."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from robolink.exceptions import DocumentError
from robolink.sim import World
from robolink.sim.description import RobotDescription
from robolink.sim.quantities import Pose
from robolink.sim.sensors import Camera, Lidar, RangeFinder
from robolink.sim.webots import WebotsWorld, read
from robolink.sim.webots import protos as room

HEADER = "#VRML_SIM R2023b utf8\n"
CRATE = """#VRML_SIM R2021c utf8
# the year of a PROTO's header is that of its last change
EXTERNPROTO "Inner.proto"
PROTO Crate [
  field       SFVec3f              translation 0 0 0.5  # a comment
  vrmlField   SFRotation           rotation    0 0 1 0
  field       SFString{"a", "b"}   kind        "a"
  field       SFVec3f              size        1 1 1
  field       SFNode               physics     NULL
  hiddenField MFNode               children    [ ]
]
{
  Solid {
    translation IS translation
    rotation IS rotation
    children [ Inner { size IS size } Group { children IS children } ]
    physics IS physics
  }
}
"""
INNER = """#VRML_SIM R2023b utf8
PROTO Inner [ field SFVec3f size 9 9 9 ]
{ DEF S Shape { geometry Box { size IS size } } }
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "worlds").mkdir()
    (tmp_path / "protos").mkdir()
    (tmp_path / "protos" / "Crate.proto").write_text(CRATE)
    (tmp_path / "protos" / "Inner.proto").write_text(INNER)
    return tmp_path / "worlds"


def world(folder: Path, text: str, declares: str = "../protos/Crate.proto") -> WebotsWorld:
    declared = f'EXTERNPROTO "{declares}"\n' if declares else ""
    return read(folder / "w.wbt", f"{HEADER}{declared}{text}")


@pytest.mark.parametrize("declares", ["../protos/Crate.proto", ""])
def test_a_proto_beside_the_world_is_read(folder: Path, declares: str) -> None:
    text = """Crate { }
              Crate { translation 3 0 0.5 rotation 0 0 1 0.5 size 2 1 1 physics Physics { mass 4 density -1 } }
              Crate { translation 0 5 0.5 children [ Pose { translation 0 1 0
                children [ Shape { geometry Cylinder { radius 0.2 } } ] } ] }"""
    found = world(folder, text, declares)
    assert found.notes == ()
    shapes = [(each.box, each.circle, each.pose, each.mass) for each in found.description.obstacles]
    assert shapes == [
        ((1.0, 1.0), None, Pose(0, 0), None),
        ((2.0, 1.0), None, Pose(3, 0, 0.5), 4.0),
        ((1.0, 1.0), None, Pose(0, 5), None),
        (None, 0.2, Pose(0, 6), None),
    ]


def test_one_beside_the_world_goes_before_one_that_is_known(folder: Path) -> None:
    (folder / "Wall.proto").write_text(CRATE.replace("PROTO Crate", "PROTO Wall").replace("Inner.", "../protos/Inner."))
    assert world(folder, "Wall { }", "Wall.proto").description.obstacles[0].box == (1.0, 1.0)
    assert world(folder, "Wall { }", "").description.obstacles[0].box == (0.2, 1.0)


def test_a_field_that_a_proto_lacks_is_told(folder: Path) -> None:
    found = world(folder, "Crate { sise 2 2 2 }")
    assert len(found.description.obstacles) == 1
    assert found.notes == ("3:14: Crate.sise: unknown key 'sise' (did you mean 'size'?): ignored",)


@pytest.mark.parametrize(
    ("proto", "report"),
    [
        ("Solid { }", "Crate.proto:1:1: expected PROTO, got 'Solid'"),
        ("PROTO Crate { }", "1:13: expected '[', got '{'"),
        ("PROTO Crate [ field SFVec3f ] { }", "1:29: expected the name of a field, got ']'"),
        ("PROTO Crate [ field SFFloat mass 1 ] { }", "1:40: the PROTO Crate has no node in it"),
        ("PROTO Crate [ ] { Solid { name IS nmae } }", "1:35: the PROTO has no field 'nmae'"),
        ("PROTO Crate [ ] { Solid { name", "expected a value, got the end of the file"),
        ("PROTO Crate [ field SFString{ name", "the end of the file"),
        ("PROTO Crate [ ] { Crate { } }", "more than 60 nodes are inside of each other"),
        ("PROTO Crate [ field SFVec3f size 1 2 ] { Shape { geometry Box { size IS size } } }", "expected 3 numbers"),
    ],
)
def test_a_mistake_in_a_proto_has_its_place_there(folder: Path, proto: str, report: str) -> None:
    (folder.parent / "protos" / "Crate.proto").write_text(proto)
    with pytest.raises(DocumentError) as caught:
        world(folder, "Crate { }")
    assert "Crate.proto:" in str(caught.value)
    assert report in str(caught.value)


def test_a_wrong_value_is_told_where_it_was_written(folder: Path) -> None:
    with pytest.raises(DocumentError, match=r"w\.wbt:3:14: Box\.size: expected 3 numbers, got 2"):
        world(folder, "Crate { size 1 2 }")
    with pytest.raises(DocumentError, match=r"w\.wbt:3:17: IS is for the body of a PROTO"):
        world(folder, "Solid { name IS name }")


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("PROTO Crate [ ] { %< if (1) { >% Solid { } }", "its definition is a program, which is not run"),
        ("PROTO Crate [ ] { Solid { name %{= 'a' }% } }", "its definition is a program, which is not run"),
    ],
)
def test_one_that_is_a_program_is_left_out(folder: Path, body: str, told: str) -> None:
    (folder.parent / "protos" / "Crate.proto").write_text(body)
    found = world(folder, "Crate { }")
    assert found.description.obstacles == ()
    assert [told in each for each in found.notes] == [True]


def test_one_whose_file_is_not_there_and_one_on_the_network_are_told(folder: Path) -> None:
    assert world(folder, "Thing { }", "../protos/Thing.proto").notes == (
        "the file '../protos/Thing.proto' is missing, so this is not there: Thing",
    )
    arm = (
        "https://raw.githubusercontent.com/cyberbotics/webots/R2023b/projects/robots/universal_robots/protos/UR5e.proto"
    )
    (note,) = world(folder, "UR5e { }", arm).notes
    assert note.endswith(
        "by name (E-puck, Pioneer3at, Pioneer3dx, TurtleBot3Burger) or by their .proto file, so this is not there: UR5e"
    )


def test_a_robot_inside_of_something_is_told_where_the_world_has_it(folder: Path) -> None:
    with pytest.raises(DocumentError, match=r"w\.wbt:4:1: Robot 'TurtleBot3Burger': this starts inside of WoodenBox"):
        world(folder, "WoodenBox { }\nTurtleBot3Burger { }")


def test_webots_own_definitions_are_read_where_it_is_installed(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    home = tmp_path / "webots" / "projects" / "objects"
    home.mkdir(parents=True)
    (home / "Crate2.proto").write_text(CRATE.replace("Crate", "Crate2"))
    (home / "Inner.proto").write_text(INNER)
    address = "https://raw.githubusercontent.com/cyberbotics/webots/R2025a/projects/objects/Crate2.proto"
    assert world(folder, "Crate2 { }", address).description.obstacles == ()
    monkeypatch.setenv("WEBOTS_HOME", str(tmp_path / "webots"))
    assert len(world(folder, "Crate2 { }", address).description.obstacles) == 1
    assert len(world(folder, "Crate2 { }", "webots://projects/objects/Crate2.proto").description.obstacles) == 1


def test_protos_multiply_neither_nodes_nor_work_without_end(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for index in range(12):
        inner = f"P{index + 1} {{ }} " * 10 if index < 11 else ""
        text = f"PROTO P{index} [ ] {{ Group {{ }} Solid {{ children [ {inner} ] }} }}"  # the second node is dropped
        (folder / f"P{index}.proto").write_text(text)
    monkeypatch.setattr(room, "MOST_WORK", 3000)
    with pytest.raises(DocumentError, match="the PROTOs of this world have more than 3,000 words"):
        world(folder, "P0 { }", "")
    deep = "".join("Group { children [ " for _ in range(40)) + "%s" + "] }" * 40
    for name, inside in (("Deep", "Deeper { }"), ("Deeper", "Box { }")):
        (folder / f"{name}.proto").write_text(f"PROTO {name} [ ] {{ {deep % inside} }}")
    with pytest.raises(DocumentError, match="are inside of each other"):
        world(folder, "Deep { }", "")


# --- robots of Webots that worlds name and this room knows ---------------------------------------------------


def robot(text: str) -> RobotDescription:
    (found,) = read("w.wbt", HEADER + text).description.robots
    return found


@pytest.mark.parametrize(
    ("kind", "wheels", "radius", "apart", "speed", "mass"),
    [
        ("E-puck", 2, 0.02, 0.052, 6.28, 0.16),
        ("TurtleBot3Burger", 2, 0.033, 0.16, 6.67, 0.825735 + 2 * 0.028499),
        ("Pioneer3at", 4, 0.11, 0.394, 6.4, 8.8),
        ("Pioneer3dx", 2, 0.0975, 0.33, 12.3, 9.0),
    ],
)
def test_robots_have_the_wheels_that_webots_gives_them(
    kind: str, wheels: int, radius: float, apart: float, speed: float, mass: float
) -> None:
    found = robot(f'{kind} {{ translation 1 2 0 rotation 0 0 1 0.5 name "me" controller "<extern>" }}')
    assert (found.name, found.pose, len(found.wheels)) == ("me", Pose(1, 2, 0.5), wheels)
    assert {each.radius for each in found.wheels} == {radius}
    assert {each.speed_max for each in found.wheels} == {speed}
    sides = [each.at.y for each in found.wheels]
    assert max(sides) - min(sides) == pytest.approx(apart)
    assert found.mass == pytest.approx(mass)
    assert all(each.at.theta == 0.0 for each in found.wheels)


def test_an_e_puck_drives_and_sees() -> None:
    found = robot("E-puck { camera_width 64 groundSensorsSlot [ Gyro { } ] }")
    assert found.shape.circle == pytest.approx(0.037)
    eyes = {each.topic: each for each in found.sensors if isinstance(each, RangeFinder)}
    assert list(eyes) == [f"ps{i}" for i in range(8)]
    assert (eyes["ps2"].offset, eyes["ps5"].offset.y) == (Pose(0, -0.031, -1.5708), 0.031)
    (camera,) = [each for each in found.sensors if isinstance(each, Camera)]
    assert (camera.width, camera.height, round(math.radians(camera.fov), 2)) == (64, 39, 0.84)
    second = robot('E-puck { version "2" }')
    assert second.wheels[0].speed_max == 7.536
    assert "tof" in [getattr(each, "topic", "") for each in second.sensors]
    made = World(read("w.wbt", HEADER + "RectangleArena { } E-puck { }").description)
    made.robots["e_puck"].turn_wheels({"left wheel motor": 3.0, "right wheel motor": 3.0})
    for _ in range(100):
        made.step()
    assert made.robots["e_puck"].twist.v == pytest.approx(0.06)


def test_a_turtlebot_has_its_lidar_unless_it_carries_something_else() -> None:
    (lidar,) = [each for each in robot("TurtleBot3Burger { }").sensors if isinstance(each, Lidar)]
    assert (lidar.topic, lidar.beams, lidar.offset) == ("scan", 360, Pose(-0.03, 0))
    other = robot("TurtleBot3Burger { extensionSlot [ SickLms291 { } ] }")
    assert [each.beams for each in other.sensors if isinstance(each, Lidar)] == [180]
