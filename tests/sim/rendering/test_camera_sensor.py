"""The sensor `camera` in a world file: limits, and what a shot keeps of its moment."""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path

import numpy as np
import pytest

from robolink.exceptions import DocumentError
from robolink.image.codecs import png_of
from robolink.sim import Shot, World, load_world
from robolink.sim.worldfile import check_world

TEXT = """
robots:
  - {name: eye, pose: [0, 0], sensors: [{camera: camera, MORE}]}
  - {name: ball, pose: [2, 0]}
"""


def at_first_image(made: World) -> World:
    """Let a world go on until its cameras have their first image."""
    for _ in range(10):
        made.step()
    return made


def world(more: str) -> World:
    """Return a world with more keys of its camera, at the time of its first image."""
    return at_first_image(World(load_world("eye.yaml", text=TEXT.replace("MORE", more))))


def shot(made: World) -> Shot:
    """Return what the camera sees now."""
    (found,) = [each.value for each in made.readings() if isinstance(each.value, Shot)]
    return found


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ("fov: 0", "fov: expected float >= 1.0, got '0'"),
        ("fov: 180", "fov: expected float <= 170.0, got '180'"),
        ("width: 7680", "width: expected int <= 4096, got '7680'"),
        ("height: 0", "height: expected int >= 1, got '0'"),
        ("z: 0", "z: expected float >= 0.005, got '0'"),
        ("pitch: 91", "pitch: expected float <= 90.0, got '91'"),
        ("noise: .nan", "noise: expected float >= 0.0, got '.nan'"),
        ("encoding: rgb16", "encoding: expected one of rgb8, bgr8, rgba8, bgra8, mono8, got 'rgb16'"),
        ("range: [5, 1]", "range: the nearest, 5 m, must be less than the farthest, 1 m"),
        ("roll: 5", "unknown key 'roll'"),
    ],
)
def test_a_camera_that_cannot_be_is_refused_with_its_line(more: str, told: str) -> None:
    errors = check_world("eye.yaml", text=TEXT.replace("MORE", more)).errors
    assert [told in str(each) and "eye.yaml:3:" in str(each) for each in errors] == [True]


@pytest.mark.parametrize("size", [(1, 1), (4096, 2), (2, 4096)])
def test_images_of_extreme_sizes(size: tuple[int, int]) -> None:
    found = shot(world(f"width: {size[0]}, height: {size[1]}, fov: 170, noise: 5"))
    assert found.image().shape == (size[1], size[0], 3)
    assert not np.isnan(found.depths()).any()


def test_a_shot_shows_its_moment_whenever_it_is_rendered() -> None:
    made = world("noise: 3, z: 0.1")
    early, same = shot(made), shot(made)
    expected = early.image("mono8")
    made.robots["ball"].command(0.5, 0.0)
    for _ in range(100):
        made.step()
    late = shot(made)
    assert late.depths()[120].min() > early.depths()[120].min() + 0.2
    np.testing.assert_array_equal(same.image("mono8"), expected)
    np.testing.assert_array_equal(early.image("mono8"), expected)


def test_alpha_has_no_noise() -> None:
    image = shot(world("noise: 20, encoding: rgba8")).image()
    assert (image[..., 3] == 255).all()
    assert image[..., 0].std() > 5.0


def test_an_unknown_encoding_is_an_error() -> None:
    with pytest.raises(KeyError):
        shot(world("z: 0.2")).image("rgb16")


def test_two_cameras_of_one_name_are_refused() -> None:
    with pytest.raises(DocumentError, match="two sensors publish on"):
        load_world("eye.yaml", text=TEXT.replace("{camera: camera, MORE}", "{camera: camera}, {camera: camera}"))


MOVING = """
obstacles:
  - {box: [0.4, 0.4], pose: [9, 9]}
  - {circle: 0.3, path: [[2, 0], [8, 0]], speed: 1.0, height: 1}
  - {circle: 0.1, pose: [0.5, -3], mass: 0.5}
robots:
  - {name: eye, pose: [0, 0], sensors: [{camera: camera, z: 0.1}]}
  - {name: pusher, pose: [0.5, -4, 1.5708], drive: {timeout: 10}, sensors: [{camera: ahead, z: 0.1}]}
"""


def test_what_moves_and_what_is_pushed_is_seen_where_it_is() -> None:
    made = World(load_world("moving.yaml", text=MOVING))
    made.robots["pusher"].command(0.5, 0.0)
    for _ in range(300):
        made.step()
    eye, ahead = (each.value.depths() for each in made.readings() if isinstance(each.value, Shot))
    _, mover, ball = made.obstacle_poses()
    assert 4.5 < mover.x < 5.5
    assert eye[120, 160] == pytest.approx(mover.x - 0.3, abs=0.01)
    pusher = made.robots["pusher"].pose
    assert ball.y > -2.95
    assert ahead[120, 160] == pytest.approx(ball.y - pusher.y - 0.1, abs=0.01)


THINGS = """
walls: [{polyline: [[4, -3], [4, 3]], height: 1.2, colour: silver}]
obstacles: [{box: [0.4, 0.4], pose: [2, 0.6, 0.3], height: 0.3, colour: teal}, {circle: 0.2, pose: [3, -0.6]}]
"""
PAINTED = """
world: {name: painted, floor: {colour: '#96918c', image: picture.png, resolution: 0.02, origin: [0, -1]}}
paint: [{line: [[0, 0], [2, 0], [3, 1]], radius: 0.5, width: 0.05, colour: yellow}, {circle: 0.2, pose: [2, 0]}]
signs: [{tag: 36h11/3, pose: [4, 0, 3.1416], z: 0.5, size: 0.3}, {image: picture.png, pose: [4, 1, 3], z: 1, size: 0.3}]
robots: [{name: eye, pose: [0, 0], sensors: [{camera: camera, pitch: 10, noise: 3, depth: true, width: 200}]}]
"""


@pytest.mark.parametrize("has_opencv", [True, False])
def test_the_bytes_of_an_image_are_the_same_everywhere(
    has_opencv: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not has_opencv:
        monkeypatch.setitem(sys.modules, "cv2", None)
    picture = np.arange(60 * 90 * 3, dtype=np.uint32).reshape(60, 90, 3) * 2654435761 >> 24
    (tmp_path / "picture.png").write_bytes(png_of(picture.astype(np.uint8)))
    (tmp_path / "painted.yaml").write_text(THINGS + PAINTED, encoding="utf-8")
    found = shot(at_first_image(World(load_world(tmp_path / "painted.yaml"), seed=5)))
    digest = hashlib.sha256(found.image("bgr8").tobytes() + found.depths().astype("<f4").tobytes()).hexdigest()
    assert digest[:16] == "73df6db5882bfcec"


@pytest.mark.parametrize(
    ("place", "ahead"),
    [
        ("z: 50", np.inf),  # above all
        ("offset: [2, 0.6]", 0.2095),  # in a box: its side
        ("offset: [2.2, 0.6]", -np.inf),  # nearer to the side than the range begins
        ("offset: [3, -0.6]", 1.0),  # in a cylinder, which has no inside
        ("offset: [4, 0]", np.inf),  # in the wall, which has no thickness
    ],
)
def test_a_camera_above_all_or_inside_of_a_thing(place: str, ahead: float) -> None:
    eye = f"robots: [{{name: eye, pose: [0, 0], sensors: [{{camera: camera, {place}}}]}}]"
    found = shot(at_first_image(World(load_world("inside.yaml", text=THINGS + eye))))
    assert found.image().shape == (240, 320, 3)
    assert found.depths()[120, 160] == pytest.approx(ahead, abs=1e-4)
    assert not np.isnan(found.depths()).any()
