"""Triangles of outlines and painted lines: they cover what is painted, and nothing else."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.sim.description import FloorSettings, Paint, Shape, signed_area
from robolink.sim.quantities import Point, Pose
from robolink.sim.scene.floor import painted_floor
from robolink.sim.scene.triangles import Triangle, of_paint, of_polygon

SIDE = 0.01


def covered(
    triangles: Iterable[Triangle], corner: Point, size: tuple[int, int], edge: float = -1e-9
) -> npt.NDArray[np.int32]:
    """Return the number of triangles over the middle of each pixel, but with a positive `edge` not on their edges."""
    rows, columns = size
    x = corner[0] + (np.arange(columns) + 0.5) * SIDE
    y = corner[1] + (np.arange(rows) + 0.5)[:, None] * SIDE
    count = np.zeros(size, np.int32)
    for a, b, c in triangles:
        sides = [(q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) for p, q in ((a, b), (b, c), (c, a))]
        inside = np.all([each > edge for each in sides], axis=0) | np.all([each < -edge for each in sides], axis=0)
        count += inside
    return count


@st.composite
def stars(draw: st.DrawFn) -> list[Point]:
    """Polygons around the origin, most of them concave."""
    count = draw(st.integers(3, 12))
    radii = draw(st.lists(st.floats(0.2, 2.0), min_size=count, max_size=count))
    return [(r * math.cos(2 * math.pi * n / count), r * math.sin(2 * math.pi * n / count)) for n, r in enumerate(radii)]


@given(stars())
def test_a_polygons_triangles_have_its_area_and_do_not_overlap(corners: list[Point]) -> None:
    found = list(of_polygon(Shape(polygon=tuple(corners)).corners()))
    assert all(signed_area(each) >= 0.0 for each in found)
    assert sum(map(signed_area, found)) == pytest.approx(signed_area(corners), abs=1e-9)
    assert covered(found, (-2.0, -2.0), (400, 400), 1e-9)[::7, ::7].max() <= 1


PAINTS = {
    "line": Paint(line=((0.5, 0.5), (2.5, 1.0)), width=0.2),
    "sharp": Paint(line=((0.5, 0.5), (2.5, 0.5), (1.0, 2.0)), width=0.2),
    "rounded": Paint(line=((0.5, 0.5), (2.5, 0.5), (2.5, 2.5), (0.5, 2.5)), width=0.1, radius=0.5, closed=True),
    "ring": Paint(line=((0.5, 0.5), (2.5, 0.5), (1.5, 2.5)), width=0.2, closed=True),
    "dashes": Paint(line=((0.5, 0.5), (2.5, 0.5), (2.5, 2.5)), width=0.1, dashes=(0.3, 0.2)),
    "back": Paint(line=((0.5, 0.5), (2.5, 0.5), (1.0, 0.5)), width=0.2),
    "disc": Paint(circle=0.6, pose=Pose(1.0, 1.0)),
    "box": Paint(box=(1.0, 0.5), pose=Pose(1.0, 1.0, 0.4)),
    "polygon": Paint(polygon=((0, 0), (1, 0), (0.2, 0.2), (0, 1)), pose=Pose(1.0, 1.0, 1.0)),
}


@pytest.mark.parametrize("name", PAINTS)
def test_triangles_cover_what_the_floors_image_has(name: str) -> None:
    paint = PAINTS[name]
    floor = painted_floor(FloorSettings(colour="black", resolution=SIDE), [paint])
    assert floor.image is not None
    painted, found = floor.image[..., 0], covered(of_paint(paint), floor.origin, floor.image.shape[:2]) > 0
    whole = painted == 255
    assert whole.sum() > 500
    assert np.mean(found[whole]) > 0.995
    assert np.mean(painted[found] > 0) > 0.99


POINTS = st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=2, max_size=8, unique=True)


@given(st.floats(0.01, 0.5), st.floats(0.0, 1.0), st.booleans(), POINTS)
def test_any_line_has_triangles_within_its_reach(
    width: float, radius: float, closed: bool, line: list[tuple[int, int]]
) -> None:
    paint = Paint(line=tuple(line), width=width, radius=radius, closed=closed)
    for x, y in (corner for each in of_paint(paint) for corner in each):
        assert -width <= x <= 5 + width
        assert -width <= y <= 5 + width
