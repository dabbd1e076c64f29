"""Webots' cameras and range finders: what programs read of them, and what they have before the world is there."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from robolink.exceptions import NotFoundError
from robolink.image import to_array
from robolink.testing import System
from robolink.webots_controller.webots_controller import WebotsController
from tests.support.nodefiles import load_node_file

simulation = load_node_file("world")

WORLD = """
walls: [{polyline: [[3, -4], [3, 4]], colour: '#c80000', height: 3}]
robots:
  - name: cart
    pose: [0, 0]
    wheels: [{motor: left, at: [0, 0.1]}, {motor: right, at: [0, -0.1]}]
    sensors:
      - {camera: camera, width: 8, height: 6, fov: 60}
      - {camera: kinect, width: 10, height: 4, fov: 60, depth: true, range: [0.1, 3.2]}
"""


class Watcher(WebotsController):
    """Looks with both of its devices."""

    def __init__(self, **options: Any) -> None:
        super().__init__("watcher", **options)
        self.camera, self.kinect = self.robot.getDevice("camera"), self.robot.getDevice("kinect")
        self.camera.enable(32)
        self.kinect.enable(32)


@pytest.fixture
def world(tmp_path: Path) -> str:
    path = tmp_path / "room.yaml"
    path.write_text(WORLD)
    return str(path)


def test_a_program_reads_the_colours_of_a_camera(system: System, world: str, tmp_path: Path) -> None:
    images = system.messages("/camera/image_raw")
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    camera = system.start(Watcher).camera
    system.run(1.0)
    shown = to_array(images[-1], "rgb8")
    image = camera.getImage()
    assert (camera.getWidth(), camera.getHeight(), camera.getFov()) == (8, 6, pytest.approx(math.radians(60)))
    assert image == to_array(images[-1], "bgra8").tobytes()
    for x, y in ((4, 0), (7, 5)):
        red, green, blue = shown[y, x].tolist()
        found = (camera.imageGetRed(image, 8, x, y), camera.imageGetGreen(image, 8, x, y))
        assert (*found, camera.imageGetBlue(image, 8, x, y)) == (red, green, blue)
        assert camera.imageGetGray(image, 8, x, y) == (red + green + blue) // 3
        assert camera.getImageArray()[x][y] == [red, green, blue]
    assert camera.imageGetRed(image, 8, 4, 0) > 120 > camera.imageGetGreen(image, 8, 4, 0)
    assert camera.saveImage(str(tmp_path / "seen.png"), 100) == 0
    assert (tmp_path / "seen.png").read_bytes().startswith(b"\x89PNG")
    assert camera.saveImage(str(tmp_path / "no" / "folder.png"), 100) == -1
    assert camera.hasRecognition()


BALLS = """
walls: [{polyline: [[5, -4], [5, 4]], colour: '#808080', height: 3}]
obstacles:
  - {circle: 0.2, pose: [2.2, 0.8], height: 0.4, colour: red}
  - {circle: 0.15, pose: [3, -1], height: 0.4, colour: blue}
robots:
  - name: cart
    pose: [0, 0]
    sensors:
      - {camera: camera, width: 160, height: 120, fov: 80}
      - {camera: kinect, width: 160, height: 120, fov: 80, depth: true}
"""


def test_objects_are_recognized_by_their_colours(system: System, tmp_path: Path) -> None:
    path = tmp_path / "balls.yaml"
    path.write_text(BALLS)
    system.start(simulation.SimulatedWorld, parameters={"world": str(path)})
    watcher = system.start(Watcher)
    kinect = watcher.robot.getCamera("kinect")
    kinect.enable(32)
    for camera in (watcher.camera, kinect):
        assert camera.getRecognitionObjects() == []
        camera.recognitionEnable(32)
    system.run(1.0)
    assert watcher.camera.getRecognitionSamplingPeriod() == 32
    assert [each.getModel() for each in watcher.camera.getRecognitionObjects()] == ["red", "blue"]
    red, blue = kinect.getRecognitionObjects()
    assert red.getPosition() == pytest.approx([2.0, 0.8, 0.0], abs=0.1)
    assert blue.getPosition() == pytest.approx([2.85, -1.0, 0.0], abs=0.1)
    assert red.getSize()[0] == pytest.approx(0.4, abs=0.05)
    (x, y), (width, height) = red.getPositionOnImage(), red.getSizeOnImage()
    assert x < 80 < blue.getPositionOnImage()[0]
    assert 0 < y < 120
    assert height == pytest.approx(120 / 80 * width * 0.66, rel=0.5)
    assert (red.getNumberOfColors(), len(red.getColors()), len(red.getOrientation())) == (1, 3, 4)
    assert red.getColors()[0] > 0.4 > red.getColors()[1]
    first = red.getId(), blue.getId()
    system.run(0.5)
    assert tuple(each.getId() for each in kinect.getRecognitionObjects()) == first
    assert math.isnan(watcher.camera.getRecognitionObjects()[0].getPosition()[0])
    kinect.recognitionDisable()
    assert (kinect.getRecognitionNumberOfObjects(), kinect.getRecognitionSamplingPeriod()) == (0, 0)


def test_a_range_finder_tells_metres_from_left_to_right_and_down(system: System, world: str) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    kinect = system.start(Watcher).kinect
    system.run(1.0)
    depths = kinect.getRangeImage()
    assert len(depths) == 40
    assert depths[:10] == pytest.approx([3.0] * 10)
    assert kinect.rangeImageGetDepth(depths, 10, 3, 3) == depths[33]
    assert kinect.getRangeImageArray()[3][3] == depths[33]
    assert len(kinect.getRangeImage("buffer")) == 160
    assert (kinect.getWidth(), kinect.getHeight()) == (10, 4)
    with pytest.raises(ValueError, match="'list' or 'buffer', not 'array'"):
        kinect.getRangeImage("array")


def test_before_the_world_and_once_disabled_there_is_no_image(system: System, world: str) -> None:
    watcher = system.start(Watcher)
    camera = watcher.camera
    assert (camera.getImage(), camera.getImageArray(), camera.getWidth()) == (None, [], 0)
    assert math.isnan(camera.getFov())
    assert camera.saveImage("nothing.png", 100) == -1
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    system.run(0.5)
    assert camera.getImage() is None  # but now it listens
    system.run(0.5)
    assert camera.getImage() is not None
    camera.disable()
    assert camera.getImage() is None


def test_a_camera_of_no_name_is_an_error_that_names_those_there_are(system: System, world: str) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": world})
    watcher = system.start(Watcher)
    system.run(1.0)
    with pytest.raises(NotFoundError, match="camera"):
        watcher.robot.getDevice("camra")
