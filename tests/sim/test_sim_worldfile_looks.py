"""What world files say of colours, heights, paint and signs, and what they are told when that is wrong."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from robolink.exceptions import DocumentError
from robolink.image.codecs import png_of
from robolink.sim import World, load_world
from robolink.sim.scene.scenery import scenery
from robolink.sim.worldfile import check_world

ALL = """
world: {name: hall, size: [6, 5], floor: {colour: '#96918c', image: floor.png, resolution: 0.5, origin: [1, 1]}}
walls: [{polyline: [[0, 0], [6, 0], [6, 5], [0, 5]], closed: true, height: 0.4, colour: silver}]
obstacles:
  - {circle: 0.1, pose: [3, 2], height: 0.3, colour: blue}
  - {box: [0.3, 0.3], pose: [4, 4], mass: 1, signs: [{image: stop.png, pose: [0.15, 0], z: 0.2, size: 0.2}]}
robots:
  - {name: r, pose: [1, 1], height: 0.3, colour: '#46464f', signs: [{tag: 36h11/9, pose: [-0.17, 0, 3.14], size: 0.1}]}
paint:
  - {line: [[1, 1], [5, 1], [5, 4], [1, 4]], closed: true, radius: 0.8, width: 0.05, colour: yellow}
  - {line: [[0, 0], [1, 0]], dashes: [0.2, 0.1]}
  - {polygon: [[0, 0], [1, 0], [0, 1]], pose: [2, 2, 0.5], colour: red}
  - {box: [0.5, 0.4], pose: [3, 3]}
  - {circle: 0.3, pose: [2, 3], colour: white}
signs:
  - {tag: 36h11/3, pose: [6, 2, 3.1416], z: 0.25, size: 0.16}
  - {image: stop.png, pose: [4, 1, 1.57], z: 0.4, size: 0.15}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with two pictures."""
    (tmp_path / "floor.png").write_bytes(png_of(np.full((4, 6, 3), 200, np.uint8)))
    (tmp_path / "stop.png").write_bytes(png_of(np.full((20, 10, 3), 100, np.uint8)))
    return tmp_path


def write(folder: Path, text: str) -> Path:
    (folder / "w.yaml").write_text(text, encoding="utf-8")
    return folder / "w.yaml"


def test_all_that_a_world_may_say_of_its_looks(folder: Path) -> None:
    path = write(folder, ALL)
    assert check_world(path).errors == []
    found = scenery(load_world(path))
    assert found.floor.colour == (0x96, 0x91, 0x8C)
    assert found.floor.image is not None
    assert {each.colour for each in found.fixed.faces if each.b == (0.0, 0.0, 0.4)} == {(192, 192, 192)}
    assert (found.fixed.cylinders[0].z1, found.fixed.cylinders[0].colour) == (0.3, (0, 0, 255))
    assert found.robots["r"].cylinders[0][3:] == (0.02, 0.3, (0x46, 0x46, 0x4F))
    (stop,) = (each for each in found.movable[1].faces if each.texture is not None)
    assert math.hypot(*stop.b) == pytest.approx(0.4)  # twice as high as wide
    assert sum(each.texture is not None for each in found.fixed.faces) == 2


def test_pictures_are_found_from_anywhere(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(folder, ALL)
    monkeypatch.chdir(folder)
    description = load_world("w.yaml")
    monkeypatch.chdir(folder.parent)
    assert description == check_world(folder / "w.yaml").description
    assert scenery(description).floor.image is not None


def test_looks_change_nothing_that_is_measured(folder: Path) -> None:
    plain = """
world: {size: [6, 5]}
walls: [{polyline: [[0, 0], [6, 0], [6, 5], [0, 5]], closed: true}]
obstacles: [{circle: 0.1, pose: [3, 2]}, {box: [0.3, 0.3], pose: [4, 4], mass: 1}]
robots: [{name: r, pose: [1, 1], sensors: [{lidar: scan, noise: 0.01}]}]
"""
    robot = "signs: [{tag: 36h11/9, pose: [-0.17, 0, 3.14], size: 0.1}]"
    worlds = [
        World(load_world(write(folder, text)))
        for text in (plain, ALL.replace(robot, f"{robot}, sensors: [{{lidar: scan, noise: 0.01}}]"))
    ]
    for world in worlds:
        world.robots["r"].command(0.5, 0.2)
        for _ in range(100):
            world.step()
    first, second = (world.robots["r"] for world in worlds)
    assert first.pose == second.pose
    np.testing.assert_array_equal(first.scan().ranges, second.scan().ranges)


def test_a_map_has_walls_of_a_height_and_a_colour(tmp_path: Path) -> None:
    (tmp_path / "m.pgm").write_bytes(b"P5 3 3 255\n" + bytes([255] * 4 + [0] + [255] * 4))
    (tmp_path / "m.yaml").write_text(
        "{image: m.pgm, resolution: 1, origin: [0, 0, 0], occupied_thresh: 0.65, free_thresh: 0.2, negate: 0}"
    )
    (wall,) = load_world(write(tmp_path, "map: {yaml: m.yaml, height: 2.5, colour: teal}")).walls
    assert (wall.height, wall.colour) == (2.5, "teal")
    found = scenery(load_world(tmp_path / "w.yaml")).fixed.faces
    assert {(each.b, each.colour) for each in found} == {((0.0, 0.0, 2.5), (0, 128, 128))}
    with pytest.raises(DocumentError, match=r"1:29: map\.colour: 'x' is not a colour"):
        load_world(write(tmp_path, "map: {yaml: m.yaml, colour: x}"))


SIGN = "signs: [{%s}]"
PAINT = "paint: [{%s}]"
BAD = {
    "walls: [{polyline: [[0, 0], [1, 0]], colour: rde}]": "1:46: walls[0].colour: 'rde' is not a colour (did you",
    "walls: [{polyline: [[0, 0], [1, 0]], colour: }]": "walls[0].colour: this colour is empty: one that begins with # "
    "stands in quotes, '#ff0000'",
    "walls: [{polyline: [[0, 0], [1, 0]], height: 0}]": "walls[0].height: expected float >= 0.001, got '0'",
    "obstacles: [{circle: 1, pose: [0, 0], colour: 3}]": "obstacles[0].colour: expected str",
    "obstacles: [{circle: 1, pose: [0, 0], colour: '#12345'}]": "1:47: obstacles[0].colour: '#12345' is not a colour",
    "robots: [{name: r, pose: [0, 0], colour: reddish}]": "1:42: robots[0].colour: 'reddish' is not a colour",
    "robots: [{name: r, pose: [0, 0], colour: null}]": "robots[0].colour: this colour is empty",
    "world: {floor: {colour: x}}": "1:25: world.floor.colour: 'x' is not a colour",
    "world: {floor: {colour: }}": "world.floor.colour: this colour is empty",
    "world: {floor: {origin: [1, 1]}}": "1:17: world.floor.origin: this is where an 'image' lies, and there is none",
    "world: {floor: {image: f.png}}": "world.floor.image: missing key 'resolution' beside it",
    "world: {floor: {image: f.png, resolution: 0.1}}": "world.floor.image: no file 'f.png'",
    "world: {floor: {resolution: 0}}": "world.floor.resolution: expected float >= 0.0001, got '0'",
    PAINT
    % "circle: 50": "1:1: world.floor: 100 x 100 m at 0.005 m are 400 million pixels, at most 16 million: take 0.026",
    f"world: {{floor: {{resolution: 0.01}}}}\n{PAINT}"
    % "circle: 50": "1:29: world.floor.resolution: 100 x 100 m at 0.01",
    PAINT % "colour: red": "1:9: paint[0]: expected one of 'line', 'box', 'circle' and 'polygon', got none of them",
    PAINT % "circle: 1, box: [1, 1]": "paint[0]: expected one of 'box', 'circle' and 'polygon', got box and circle",
    PAINT
    % "line: [[0, 0], [1, 1]], circle: 1": "paint[0].line: this is a line and an outline at once: make two of them",
    PAINT % "line: [[0, 0], [0, 0]]": "paint[0].line[1]: a line from [0, 0] to the same point has no length",
    PAINT % "line: [[0, 0], [1, 0]], closed: true": "paint[0].line: a closed line needs 3 points or more, got 2",
    PAINT % "line: [[0, 0], [1, 0]], pose: [1, 1]": "1:34: paint[0].pose: only an outline has 'pose'",
    PAINT % "circle: 1, dashes: [1, 1]": "1:21: paint[0].dashes: only a 'line' has 'dashes'",
    PAINT % "circle: 1, width: 1": "paint[0].width: only a 'line' has 'width'",
    PAINT % "circle: 1, colour: ''": "paint[0].colour: '' is not a colour",
    PAINT % "polygon: [[0, 0], [1, 0], [2, 0]]": "paint[0].polygon: its corners lie in one line",
    f"world: {{size: [4, 4]}}\n{PAINT}"
    % "circle: 1, pose: [5, 1]": "paint[0].pose: [5, 1] lies outside of the world's",
    f"world: {{size: [4, 4]}}\n{PAINT}" % "line: [[1, 1], [1, 5]]": "paint[0].line[1]: [1, 5] lies outside of the",
    SIGN % "pose: [1, 1]": "1:9: signs[0]: expected one of 'tag' and 'image', got none of them",
    SIGN % "pose: [1, 1], tag: 16h5/0, image: s.png": "signs[0]: expected one of 'tag' and 'image', got tag and image",
    SIGN % "tag: 36h11/3": "signs[0]: missing key 'pose'",
    SIGN % "pose: [1, 1], tag: 36h12/3": "1:29: signs[0].tag: '36h12/3' has no known family (did you mean '36h11'?)",
    SIGN % "pose: [1, 1], tag: 16h5/30": "signs[0].tag: '16h5/30' is not a tag of 16h5: expected 16h5/0 to 16h5/29",
    SIGN % "pose: [1, 1], tag: 3": "signs[0].tag: expected str",
    SIGN % "pose: [1, 1], tag: 36h11/3, z: 0.1": "signs[0].z: with its margin it is 0.25 m high, and would reach below "
    "the floor: at least 0.125",
    SIGN % "pose: [1, 1], image: no.png": "1:31: signs[0].image: no file 'no.png'",
    SIGN % "pose: [1, 1], image: ''": "signs[0].image: '' cannot be read: it is a folder, and no file",
    SIGN % r'pose: [1, 1], image: "a\0b"': "signs[0].image: 'a\\x00b' cannot be read: a path has no null character",
    f"world: {{size: [4, 4]}}\n{SIGN}" % "pose: [5, 1], tag: 36h11/3": "signs[0].pose: [5, 1] lies outside of the",
    "robots: [{name: r, pose: [0, 0], signs: [{pose: [0, 0], tag: x}]}]": "robots[0].signs[0].tag: 'x' has no known",
    "obstacles: [{circle: 1, pose: [0, 0], signs: [{pose: [0, 0], tag: x}]}]": "obstacles[0].signs[0].tag: 'x' has no",
}


@pytest.mark.parametrize(("text", "expected"), BAD.items())
def test_what_is_wrong_is_said_with_its_place(text: str, expected: str) -> None:
    with pytest.raises(DocumentError) as caught:
        load_world("w.yaml", text=text)
    message = str(caught.value)
    assert message.startswith(("w.yaml:1:", "w.yaml:2:"))
    assert expected in message
    assert "\n" not in message
    assert message in [str(each) for each in check_world("w.yaml", text=text).errors]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("signs: [{image: stop.pn, pose: [1, 1]}]", "stop.pn' (did you mean 'stop.png'?)"),
        (
            "signs: [{image: w.yaml, pose: [1, 1]}]",
            "1:17: signs[0].image: 'w.yaml' cannot be read: no PNG, JPEG or PGM",
        ),
        (
            "signs: [{image: stop.png, pose: [1, 1], size: 0.4}]",
            "it is 0.8 m high, and would reach below the floor: z at",
        ),
        ("signs: [{image: ., pose: [1, 1]}]", "signs[0].image: '.' cannot be read: it is a folder, and no file"),
        ("world: {floor: {image: huge.png, resolution: 9}}", "9000 x 9000 pixels: at most 8 million"),
        ("world: {floor: {image: floor.png, resolution: 0.001}}\npaint: [{circle: 1, pose: [9, 9]}]", "million pixels"),
    ],
)
def test_pictures_that_will_not_do_are_named(folder: Path, line: str, expected: str) -> None:
    head = png_of(np.zeros((1, 1, 3), np.uint8))
    size = (9000).to_bytes(4, "big")
    (folder / "huge.png").write_bytes(head[:16] + size + size + head[24:])
    path = write(folder, line)
    with pytest.raises(DocumentError) as caught:
        load_world(path)
    assert str(caught.value).startswith(f"{path}:1:")
    assert expected in str(caught.value)
    assert [str(each) for each in check_world(path).errors] == [str(caught.value)]


def test_pictures_of_too_many_pixels_together_are_refused(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.sim.checks.appearance.MOST_PIXELS", 10)
    text = "signs: [{image: floor.png, pose: [1, 1], z: 1}, {image: stop.png, pose: [1, 1], z: 1}]"
    (error,) = check_world(write(folder, text)).errors
    assert "signs[1].image: all pictures together have over" in str(error)
