"""Cameras of simulated robots: topics, calibration, frames, and that nothing is rendered for nobody."""

from __future__ import annotations

import math
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest

from robolink import Context, Node, Parameter
from robolink.clock_type import ClockType
from robolink.executors import SingleThreadedExecutor
from robolink.image import to_array
from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image
from robolink.launch import read_launch_file
from robolink.sim import Pose, Shot, World, load_world
from robolink.sim.rendering.canvas import Canvas
from robolink.sim.rendering.renderer import Renderer
from robolink.simulate import simulate
from robolink.testing import System
from robolink.tf2 import Buffer, TransformListener
from robolink.time import Time
from tests.support.halls import simulation
from tests.support.systems import log
from tests.support.waits import wait_until

ROOM = """
walls:
  - {polyline: [[0, 0], [6, 0], [6, 5], [0, 5]], closed: true}
robots:
  - name: robot
    pose: [1, 2.5]
    sensors:
      - {lidar: scan}
      - {camera: camera, width: 64, height: 48, MORE}
"""
Room: TypeAlias = "Callable[[str], str]"


@pytest.fixture
def room(tmp_path: Path) -> Room:
    """Return a function that writes a world with more keys of its camera, and returns its path."""

    def written(more: str) -> str:
        path = tmp_path / "room.yaml"
        path.write_text(ROOM.replace("MORE", more))
        return str(path)

    return written


@pytest.fixture
def renderings(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return a list that gets an item for each image that is rendered."""
    found: list[int] = []
    render = Renderer.render

    def counted(renderer: Renderer, *scene: Any) -> Canvas:
        found.append(1)
        return render(renderer, *scene)

    monkeypatch.setattr(Renderer, "render", counted)
    return found


def test_an_image_has_its_time_frame_and_size(system: System, room: Room) -> None:
    images, infos = system.messages("/camera/image_raw"), system.messages("/camera/camera_info")
    system.start(simulation.SimulatedWorld, parameters={"world": room("pitch: 10, encoding: bgr8")})
    system.run(0.305)
    assert len(images) == len(infos) == 3
    image = images[0]
    assert (image.width, image.height, image.encoding, image.step, image.is_bigendian) == (64, 48, "bgr8", 192, 0)
    assert image.header.frame_id == "camera_optical_frame"
    assert [each.header for each in infos] == [each.header for each in images]
    shown = to_array(image, "rgb8")
    assert shown[0, 0].tolist() != shown[-1, 0].tolist()  # the wall, and the floor


def test_the_calibration_is_that_of_a_pinhole_with_whole_pixel_centres(system: System, room: Room) -> None:
    infos = system.messages("/camera/camera_info")
    system.start(simulation.SimulatedWorld, parameters={"world": room("fov: 90, baseline: 0.1")})
    system.run(0.105)
    (info,) = infos
    assert (info.width, info.height, info.distortion_model, list(info.d)) == (64, 48, "plumb_bob", [0.0] * 5)
    assert list(info.k) == pytest.approx([32.0, 0.0, 31.5, 0.0, 32.0, 23.5, 0.0, 0.0, 1.0])
    assert list(info.p) == pytest.approx([32.0, 0.0, 31.5, -3.2, 0.0, 32.0, 23.5, 0.0, 0.0, 0.0, 1.0, 0.0])
    assert list(info.r) == [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]


def test_the_optical_frame_looks_ahead_and_down(system: System, room: Room) -> None:
    buffer = Buffer()
    TransformListener(buffer, system.node)
    path = room("offset: [0.1, 0.2, 0.5], z: 0.3, pitch: 30")
    system.start(simulation.SimulatedWorld, parameters={"world": path})
    system.run(0.205)
    found = buffer.lookup_transform("base_link", "camera_optical_frame", Time(clock_type=ClockType.ROS_TIME)).transform
    place, turn = found.translation, found.rotation
    assert (place.x, place.y, place.z) == pytest.approx((0.1, 0.2, 0.3))
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    ahead = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))  # the frame's z axis
    cos, sin = math.cos(math.radians(30)), math.sin(math.radians(30))
    assert ahead == pytest.approx((cos * math.cos(0.5), cos * math.sin(0.5), -sin))
    right = (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y))  # its x axis
    assert right == pytest.approx((math.sin(0.5), -math.cos(0.5), 0.0), abs=1e-9)


def test_depths_are_metres_ahead(system: System, room: Room) -> None:
    depths, infos = system.messages("/camera/depth/image_raw"), system.messages("/camera/depth/camera_info")
    path = room("depth: true, range: [0.1, 5.2], offset: [0.1, 0]")
    system.start(simulation.SimulatedWorld, parameters={"world": path})
    system.run(0.105)
    assert (depths[0].encoding, len(infos)) == ("32FC1", 1)
    found = to_array(depths[0])
    np.testing.assert_allclose(found[23, 20:44], 4.9, atol=1e-4)  # the wall at x = 6
    assert not np.isnan(found).any()


def test_what_nobody_looks_at_is_not_rendered(tmp_path: Path, room: Room, renderings: list[int]) -> None:
    world = World(load_world(room("depth: true")))
    for _ in range(10):
        world.step()
    shots = [each.value for each in world.readings() if isinstance(each.value, Shot)]
    assert len(shots) == 1
    assert not renderings
    shots[0].image()
    shots[0].depths()
    assert len(renderings) == 1


@pytest.mark.parametrize(("all_images", "count"), [(False, 0), (True, 10)])
def test_a_simulation_renders_what_nodes_subscribe_to_or_all(
    room: Room, renderings: list[int], all_images: bool, count: int
) -> None:
    launch_file = Path(room("")).with_name("launch.yaml")
    launch_file.write_text(
        f"nodes:\n  - node: world\n    parameters: {{world: {room('')}, all_images: {str(all_images).lower()}}}\n"
    )
    entries = read_launch_file(launch_file, {})
    result = simulate(entries, duration=1.005)
    assert result.messages["/camera/camera_info"] == 10
    assert result.messages["/camera/image_raw"] == len(renderings) == count
    assert simulate(entries, duration=1.005).hash == result.hash


def test_an_image_and_its_depths_are_rendered_once(system: System, room: Room, renderings: list[int]) -> None:
    images, depths = system.messages("/camera/image_raw"), system.messages("/camera/depth/image_raw")
    system.start(simulation.SimulatedWorld, parameters={"world": room("depth: true")})
    system.run(0.205)
    assert len(images) == len(depths) == len(renderings) == 2


def test_the_noise_of_an_image_follows_from_the_seed_and_its_time(tmp_path: Path, room: Room) -> None:
    def life(seed: int) -> list[bytes]:
        with System() as system:
            images = system.messages("/camera/image_raw")
            system.start(simulation.SimulatedWorld, parameters={"world": room("noise: 5"), "seed": seed})
            system.run(0.205)
            return [bytes(each.data) for each in images]

    first, again, other = life(1), life(1), life(2)
    assert first == again
    assert first[0] != first[1]
    assert first[0] != other[0]


ROBOTS = """
robots:
  - {name: a, pose: [0, 0], sensors: [{camera: eye, width: 40, height: 30, depth: true, z: 0.1}]}
  - {name: b, pose: [2, 0, 0]}
  - {name: c, pose: [9, 9, 0]}
"""


def test_other_robots_are_seen_where_they_are(system: System, tmp_path: Path) -> None:
    path = tmp_path / "robots.yaml"
    path.write_text(ROBOTS)
    depths = system.messages("/a/eye/depth/image_raw")
    world = system.start(simulation.SimulatedWorld, parameters={"world": str(path)})
    system.run(0.105)
    assert depths[-1].header.frame_id == "a/eye_optical_frame"
    assert to_array(depths[-1])[15].min() == pytest.approx(1.83, abs=0.01)  # not the robot's own body
    world.simulation.teleport("b", Pose(3.0, 0.0))
    system.run(0.1)
    assert to_array(depths[-1])[15].min() == pytest.approx(2.83, abs=0.01)
    world.simulation.delete("b")
    system.run(0.1)
    assert to_array(depths[-1])[15].min() > 3.0


def test_a_compressed_image_is_made_for_who_subscribes(system: System, room: Room, renderings: list[int]) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": room("encoding: mono8")})
    found: list[CompressedImage] = []
    system.node.create_subscription(CompressedImage, "/camera/image_raw/compressed", found.append, 10)
    system.run(0.205)
    assert [each.format for each in found] == ["mono8; jpeg compressed mono8"] * 2
    assert to_array(found[0]).shape == (48, 64)
    assert len(renderings) == 2


def test_without_opencv_one_line_says_that_there_are_no_compressed_images(
    system: System, room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    images = system.messages("/camera/image_raw")
    system.start(simulation.SimulatedWorld, parameters={"world": room("")})
    found: list[CompressedImage] = []
    system.node.create_subscription(CompressedImage, "/camera/image_raw/compressed", found.append, 10)
    system.run(0.505)
    assert (len(images), found) == (5, [])
    assert sum("no compressed images" in each and "OpenCV" in each for each in log(system)) == 1


def test_a_world_without_cameras_has_no_parameter_for_them(system: System) -> None:
    """Else the hashes of all such worlds would be others than before there were cameras."""
    world = system.start(simulation.SimulatedWorld, parameters={"world": "empty_room"})
    assert not world.has_parameter("all_images")


def test_in_real_time_images_come_from_a_thread_that_ends_with_the_node(room: Room) -> None:
    found: list[Image] = []
    context = Context(transport="memory")
    context.init(args=[])
    with context, SingleThreadedExecutor(context=context) as executor:
        options: dict[str, Any] = {"context": context}
        world = simulation.SimulatedWorld(**options, parameter_overrides=[Parameter("world", value=room("rate: 50"))])
        listener = Node("listener", **options)
        listener.create_subscription(Image, "/camera/image_raw", found.append, 10)
        for node in (world, listener):
            executor.add_node(node)

        def five() -> bool:
            executor.spin_once(timeout_sec=0.1)
            return len(found) >= 5

        wait_until(five)
        assert any(each.name == "robolink images" for each in threading.enumerate())
        world.destroy_node()
        listener.destroy_node()
    assert not any(each.name == "robolink images" for each in threading.enumerate())
    times = [each.header.stamp.sec * 10**9 + each.header.stamp.nanosec for each in found]
    assert times == sorted(set(times))
