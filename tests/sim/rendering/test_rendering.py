"""Renderer: depths and what is seen, against rays met with every surface in double precision."""

from __future__ import annotations

import hashlib
import math

import numpy as np
import pytest

from robolink.sim.rendering import drawing
from robolink.sim.rendering.canvas import Canvas, write_colours, write_depths
from robolink.sim.rendering.pinhole import Pinhole, view_from
from robolink.sim.rendering.renderer import Backdrop, Renderer, Setting
from robolink.sim.scene.solids import Cylinder, Face, Floor, Outline, Scenery, Surfaces
from tests.support.raycasting import Array, depths, rays

SKY = (190, 205, 225)
NOWHERE = np.zeros((0, 3))
Eye = tuple[float, float, float]


def rendered(
    surfaces: Surfaces,
    eye: Eye,
    yaw: float,
    pitch: float,
    size: tuple[int, int],
    fov: float = 70.0,
    floor: Floor | None = None,
) -> Canvas:
    """Return the canvas of a camera at a place."""
    setting = Setting(Backdrop(Scenery(floor or Floor((150, 145, 140)), SKY, surfaces, {}, {})), ())
    return Renderer(Pinhole(*size, fov)).render(setting, view_from(eye, yaw, pitch), NOWHERE)


def depth_image(canvas: Canvas) -> Array:
    found = np.empty_like(canvas.inverse)
    write_depths(canvas.inverse, 1e-6, 1e4, found)
    return found.astype(np.float64)


def colours(canvas: Canvas, encoding: str = "rgb8") -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    image = np.empty((*canvas.inverse.shape, 1 if encoding == "mono8" else len(encoding) - 1), dtype=np.uint8)
    write_colours(canvas.colours, encoding, image)
    return image


def wall(x1: float, y1: float, x2: float, y2: float, height: float, colour: tuple[int, int, int] = (9, 9, 9)) -> Face:
    return Face((x1, y1, 0.0), (x2 - x1, y2 - y1, 0.0), (0.0, 0.0, height), colour)


def random_surfaces(random: np.random.Generator, count: int, side: float) -> Surfaces:
    """Return faces of any shape and direction, and cylinders, about the origin."""
    places, sides = random.uniform(-4.0, 4.0, (count, 3)), random.uniform(-side, side, (count, 2, 3))
    outlines: list[Outline] = ["parallelogram", "ellipse", "triangle"]
    faces = [
        Face(
            (place[0], place[1], place[2] + 4.0),
            (a[0], a[1], a[2]),
            (b[0], b[1], b[2]),
            (number % 250, number // 250, 7),
            None,
            outlines[number % 3],
        )
        for number, (place, (a, b)) in enumerate(zip(places.tolist(), sides.tolist(), strict=True))
    ]
    x, y, radius = (
        random.uniform(-4, 4, count // 4),
        random.uniform(-4, 4, count // 4),
        random.uniform(0.05, 0.4, count // 4),
    )
    cylinders = [
        Cylinder(*each, 0.2, 1.5, (200, number % 250, 3))
        for number, each in enumerate(zip(x.tolist(), y.tolist(), radius.tolist(), strict=True))
    ]
    return Surfaces(tuple(faces), tuple(cylinders))


def test_depths_are_exact_to_a_tenth_of_a_millimetre() -> None:
    scene = Surfaces((wall(3.0, -40.0, 3.0, 40.0, 30.0),), (Cylinder(1.5, 0.3, 0.2, 0.0, 2.0, (9, 9, 9)),))
    eye, yaw, pitch = (0.3, 0.1, 0.4), 0.2, 0.15
    found = depth_image(rendered(scene, eye, yaw, pitch, (320, 240)))
    exact, _ = depths(scene, eye, rays(320, 240, 70.0, yaw, pitch))
    assert np.abs(found - exact).max() < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize(("count", "side"), [(12, 3.0), (40, 1.0), (700, 0.5)])
@pytest.mark.parametrize("seed", range(4))
def test_what_is_seen_is_what_each_ray_meets_first(count: int, side: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    scene = random_surfaces(random, count, side)
    eye = (float(random.uniform(-1, 1)), float(random.uniform(-1, 1)), float(random.uniform(0.1, 4.0)))
    yaw, pitch, fov = float(random.uniform(-3, 3)), float(random.uniform(-1.5, 1.5)), float(random.uniform(30, 120))
    found = depth_image(rendered(scene, eye, yaw, pitch, (97, 71), fov))
    exact, _ = depths(scene, eye, rays(97, 71, fov, yaw, pitch))
    exact[exact > 1e4] = np.inf
    with np.errstate(invalid="ignore"):
        off = (np.abs(found - exact) > 1e-4 + 1e-5 * exact**2) & (found != exact)
    assert np.count_nonzero(off) <= 3  # pixels whose centre lies on an edge to a thousandth of a pixel


def test_the_colour_is_that_of_the_nearest() -> None:
    random = np.random.default_rng(5)
    scene = random_surfaces(random, 60, 1.5)
    scene = scene._replace(cylinders=())
    eye, yaw, pitch = (0.1, 0.2, 3.0), 0.5, 0.2
    image = colours(rendered(scene, eye, yaw, pitch, (97, 71)))
    _, which = depths(scene, eye, rays(97, 71, 70.0, yaw, pitch))
    for number in np.unique(which[which >= 0]):
        shown = np.unique(image[which == number].reshape(-1, 3), axis=0)
        assert len(shown) <= 2, "one colour, but for a pixel on an edge"
        red = scene.faces[number].colour[0]
        assert any(0.69 * red - 1 <= each[0] <= red + 1 for each in shown.tolist()), number


def test_a_wall_that_reaches_behind_the_camera_is_seen_to_the_image_edge() -> None:
    scene = Surfaces((wall(-5.0, -0.5, 5.0, -0.5, 2.0),))
    eye = (0.0, 0.0, 0.5)
    found = depth_image(rendered(scene, eye, 0.0, 0.0, (160, 120), 120.0))
    exact, _ = depths(scene, eye, rays(160, 120, 120.0, 0.0, 0.0))
    exact[exact > 1e4] = np.inf
    np.testing.assert_allclose(found, exact, rtol=1e-5)


@pytest.mark.parametrize(
    "eye", [(0.0, 0.0, 0.5), (0.0, 0.0, 1.0), (1e-9, 0.0, 0.5), (0.0, 0.0, 50.0), (0.25, 0.0, 0.1)]
)
def test_a_camera_in_a_wall_or_a_thing_sees_without_a_warning(eye: Eye) -> None:
    scene = Surfaces((wall(0.0, -2.0, 0.0, 2.0, 1.0),), (Cylinder(0.25, 0.0, 0.25, 0.0, 1.0, (200, 0, 0)),))
    for yaw in (0.0, 1.0, math.pi):
        for pitch in (-math.pi / 2, 0.0, math.pi / 2):
            found = depth_image(rendered(scene, eye, yaw, pitch, (32, 24)))
            assert not np.isnan(found).any()
            assert (found > 0.0).all()


@pytest.mark.parametrize("size", [(1, 1), (1, 300), (300, 1)])
@pytest.mark.parametrize("fov", [1.0, 170.0])
def test_images_of_any_shape_are_rendered(size: tuple[int, int], fov: float) -> None:
    scene = random_surfaces(np.random.default_rng(3), 50, 1.0)
    assert not np.isnan(depth_image(rendered(scene, (0.0, 0.0, 2.0), 0.3, 0.2, size, fov))).any()


def test_the_floor_shows_its_picture_where_it_is() -> None:
    picture = np.full((200, 300, 3), 100, dtype=np.uint8)
    picture[120, 210] = 255, 0, 0  # x from 1.10 to 1.11 m, y from 0.20 to 0.21
    floor = Floor((1, 2, 3), picture, 0.01, (-1.0, -1.0))
    image = colours(rendered(Surfaces(), (1.105, 0.205, 0.5), 0.0, math.pi / 2, (41, 41), 5.0, floor))
    assert tuple(image[20, 20]) == (255, 0, 0)
    rows, columns = np.nonzero(image[..., 1] == 0)
    assert (rows.mean(), columns.mean()) == pytest.approx((20.0, 20.0), abs=0.5)
    assert len(rows) == pytest.approx((0.01 / 0.5 * 41 / 2 / math.tan(math.radians(2.5))) ** 2, rel=0.15)


def test_beyond_its_picture_the_floor_has_its_colour() -> None:
    floor = Floor((1, 2, 3), np.full((10, 10, 3), 100, dtype=np.uint8), 0.01, (0.0, 0.0))
    image = colours(rendered(Surfaces(), (5.0, 5.0, 0.5), 0.0, 0.5, (20, 20), 70.0, floor))
    assert tuple(image[-1, 3]) == (1, 2, 3)


def test_far_away_the_floor_shows_the_mean_of_its_picture() -> None:
    picture = np.zeros((1024, 1024, 3), dtype=np.uint8)
    picture[::2, ::2] = picture[1::2, 1::2] = 200  # a fine chessboard
    image = colours(
        rendered(Surfaces(), (5.12, 5.12, 3.0), 0.0, math.pi / 2, (40, 40), 40.0, Floor((0, 0, 0), picture, 0.01))
    )
    np.testing.assert_allclose(image, 100, atol=1)


def sign(texture: np.ndarray[tuple[int, ...], np.dtype[np.uint8]], x: float, size: float) -> Face:
    """Return a sign that looks back along x."""
    return Face((x, size / 2, 0.5 + size / 2), (0.0, -size, 0.0), (0.0, 0.0, -size), (0, 0, 0), texture)


def test_a_sign_is_seen_upright_in_its_wall_and_only_from_ahead() -> None:
    picture = np.arange(4 * 4 * 3, dtype=np.uint8).reshape(4, 4, 3) * 5
    scene = Surfaces((wall(2.0, -3.0, 2.0, 3.0, 2.0, (255, 255, 255)), sign(picture, 2.0, 1.0)))
    image = colours(rendered(scene, (0.0, 0.0, 0.5), 0.0, 0.0, (160, 160), 60.0))
    span = 160 / 2 / math.tan(math.radians(30)) / 2  # pixels of the sign's side
    for row in range(4):
        for column in range(4):
            v, u = (round(79.5 + span * ((place + 0.5) / 4 - 0.5)) for place in (row, column))
            assert tuple(image[v, u]) == tuple(picture[row, column])
    behind = colours(rendered(scene, (4.0, 0.0, 0.5), math.pi, 0.0, (160, 160), 60.0))
    assert len(np.unique(behind[70:90, 70:90].reshape(-1, 3), axis=0)) == 1


def test_edges_of_a_sign_mix_with_what_is_behind() -> None:
    white = np.full((2, 2, 3), 255, dtype=np.uint8)
    scene = Surfaces((sign(white, 2.0, 0.5),))
    canvas = rendered(scene, (0.0, 0.03, 0.5), 0.0, 0.0, (161, 121), 60.0)
    focal, row = 161 / 2 / math.tan(math.radians(30)), colours(canvas)[60]
    width = ((row[:, 0].astype(float) - row[0, 0]) / (255 - row[0, 0])).sum()
    assert width == pytest.approx(focal * 0.5 / 2.0, abs=0.2)


def test_a_thing_in_front_hides_a_sign() -> None:
    white = np.full((2, 2, 3), 255, dtype=np.uint8)
    front = wall(1.0, -3.0, 1.0, 3.0, 2.0, (100, 0, 0))
    image = colours(rendered(Surfaces((front, sign(white, 2.0, 0.5))), (0.0, 0.0, 0.5), 0.0, 0.0, (40, 30)))
    assert not (image == 255).any()


def test_the_bytes_are_the_same_everywhere() -> None:
    random = np.random.default_rng(11)
    scene = random_surfaces(random, 200, 1.0)
    picture = random.integers(0, 256, (50, 50, 3), dtype=np.uint8)
    scene = scene._replace(faces=(*scene.faces, sign(picture, 2.0, 0.7)))
    canvas = rendered(scene, (0.1, 0.2, 1.0), 0.1, 0.2, (160, 120), 70.0, Floor((9, 8, 7), picture, 0.1, (0.0, 0.0)))
    found = hashlib.sha256(colours(canvas).tobytes() + canvas.inverse.astype("<f4").tobytes()).hexdigest()
    assert found[:16] == "07f5f59033d4a156"


def test_patches_are_drawn_alike_at_once_or_a_few_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = random_surfaces(np.random.default_rng(8), 300, 1.0)
    place: tuple[Eye, float, float, tuple[int, int]] = ((0.1, 0.2, 2.0), 0.1, 0.2, (160, 120))
    whole = depth_image(rendered(scene, *place))
    monkeypatch.setattr(drawing, "_ROWS", 500)
    np.testing.assert_array_equal(depth_image(rendered(scene, *place)), whole)
