"""Painted floors: where the paint lies, how pixels at its edges are mixed, and what is too much."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from robolink.sim.colours import colour_of
from robolink.sim.description import FloorSettings, Paint
from robolink.sim.looks import FLOOR
from robolink.sim.quantities import Pose
from robolink.sim.scene.floor import painted_floor
from robolink.sim.scene.solids import Floor
from robolink.sim.scene.strokes import too_much

BLACK = FloorSettings(colour="black", resolution=0.01)


def covered(floor: Floor, channel: int = 0) -> float:
    """Area in m² that white paint covers on a black floor."""
    assert floor.image is not None
    return float(floor.image[..., channel].sum() / 255) * floor.resolution**2


def at(floor: Floor, x: float, y: float) -> tuple[int, ...]:
    """Colour of the floor at a point."""
    if floor.image is None:
        return floor.colour
    column = math.floor((x - floor.origin[0]) / floor.resolution)
    row = math.floor((y - floor.origin[1]) / floor.resolution)
    rows, columns = floor.image.shape[:2]
    return tuple(floor.image[row, column].tolist()) if 0 <= row < rows and 0 <= column < columns else floor.colour


def painted(**paint: Any) -> Floor:
    return painted_floor(BLACK, [Paint(**paint)])


def test_a_floor_without_paint_has_no_image() -> None:
    assert painted_floor(FloorSettings(), []) == Floor(FLOOR)
    assert painted_floor(FloorSettings(colour="red"), []).colour == (255, 0, 0)


def test_paint_lies_where_it_should() -> None:
    floor = painted(line=((1.0, 2.0), (3.0, 2.0)), width=0.1, colour="yellow")
    assert at(floor, 2.0, 2.04) == at(floor, 1.01, 1.96) == (255, 255, 0)
    assert at(floor, 2.0, 2.06) == at(floor, 0.94, 2.0) == at(floor, 3.06, 2.0) == (0, 0, 0)
    assert floor.resolution == 0.01
    assert floor.image is not None
    assert floor.image.shape[:2] == (10, 210)
    assert not floor.image.flags.writeable


@pytest.mark.parametrize(
    ("paint", "area"),
    [
        ({"line": ((1.0, 2.0), (3.0, 2.0)), "width": 0.1}, 0.2),
        ({"line": ((0.0, 0.0), (3.0, 2.0)), "width": 0.05}, 0.05 * math.sqrt(13)),
        ({"line": ((0.003, 0.0), (3.003, 0.0)), "width": 0.004}, 0.012),
        ({"circle": 0.5, "pose": Pose(1.003, 1.0)}, math.pi / 4),
        ({"box": (0.4, 0.3), "pose": Pose(1.0, 1.0, 0.5)}, 0.12),
        ({"polygon": ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 0.2), (0.0, 1.0)), "pose": Pose(0.0, 0.0, 1.0)}, 0.6),
        ({"line": ((0.0, 0.0), (3.0, 0.0)), "width": 0.1, "dashes": (0.2, 0.1)}, 0.2),
    ],
)
def test_as_much_is_covered_as_should_be(paint: dict[str, Any], area: float) -> None:
    assert covered(painted(colour="white", **paint)) == pytest.approx(area, rel=0.01)


def test_a_rounded_ring_is_as_long_as_its_sides_and_arcs() -> None:
    square = ((1.0, 1.0), (4.0, 1.0), (4.0, 4.0), (1.0, 4.0))
    floor = painted(line=square, closed=True, radius=1.0, width=0.05, colour="white")
    assert covered(floor) == pytest.approx((4 * 1.0 + 2 * math.pi) * 0.05, rel=0.002)
    corner = 1.0 - math.sqrt(0.5)
    assert at(floor, 1.0 + corner, 1.0 + corner) == (255, 255, 255)
    assert at(floor, 1.0, 1.0) == (0, 0, 0)


def test_an_arc_that_does_not_fit_is_as_large_as_it_can_be() -> None:
    floor = painted(line=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)), closed=True, radius=9.0, width=0.05)
    assert covered(floor) == pytest.approx(math.pi * 0.05, rel=0.01)


def test_a_line_that_turns_straight_back_is_painted() -> None:
    floor = painted(line=((0.0, 0.0), (1.0, 0.0), (0.5, 0.0)), radius=0.2, width=0.1, colour="white")
    assert at(floor, 0.5, 0.0) == (255, 255, 255)


def test_shapes_that_share_an_edge_leave_no_seam() -> None:
    corners = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.013, 0.517), (0.0, 2.0))
    image = painted(polygon=corners, colour="white").image
    assert image is not None
    assert (image[:40, 5:195] == 255).all()


def test_half_covered_pixels_are_half_mixed() -> None:
    floor = painted_floor(FloorSettings(colour="#000064", resolution=0.1), [Paint(box=(1.0, 0.9), colour="#640000")])
    assert at(floor, 0.0, 0.42) == (50, 0, 50)


def test_later_paint_lies_over_earlier_paint() -> None:
    both = [Paint(circle=0.5, colour="red"), Paint(circle=0.2, colour="blue")]
    assert at(painted_floor(BLACK, both), 0.0, 0.0) == colour_of("blue")
    assert at(painted_floor(BLACK, both[::-1]), 0.0, 0.0) == colour_of("red")


def test_a_picture_lies_with_its_last_row_at_its_origin() -> None:
    picture = np.arange(24, dtype=np.uint8).reshape(2, 4, 3)
    settings = FloorSettings(image="p.png", resolution=0.5, origin=(1.0, -1.0))
    floor = painted_floor(settings, [], picture)
    assert floor.origin == (1.0, -1.0)
    assert at(floor, 1.1, -0.9) == (12, 13, 14)
    assert at(floor, 2.9, -0.1) == (9, 10, 11)
    around = painted_floor(settings, [Paint(circle=0.2, colour="white", pose=Pose(4.0, 3.0))], picture)
    assert at(around, 1.1, -0.9) == (12, 13, 14)
    assert at(around, 3.2, 1.0) == FLOOR


def test_the_same_paint_gives_the_same_bytes() -> None:
    first, second = (painted(line=((0.0, 0.1), (2.0, 1.7), (3.0, 0.2)), radius=0.3).image for _ in range(2))
    assert first is not None
    np.testing.assert_array_equal(first, second)
    assert digest(first) == 789037978


def digest(image: npt.NDArray[np.uint8]) -> int:
    import zlib

    return zlib.crc32(image.tobytes())


@pytest.mark.parametrize(
    ("paint", "reason"),
    [
        ([Paint(circle=50.0)], "100 x 100 m at 0.005 m are 400 million pixels, at most 16 million: take 0.026"),
        ([Paint(circle=1.0, pose=Pose(-1e5, 0.0)), Paint(circle=1.0, pose=Pose(1e5, 0.0))], "million pixels"),
        ([Paint(circle=9.0)] * 20, "too much is painted over each other"),
        ([Paint(line=((0.0, 0.0), (9.0, 0.0)), dashes=(0.001, 0.001))] * 20, "more than 50,000 pieces"),
        ([Paint(line=tuple((1e-3 * each, each % 2.0) for each in range(9000)), width=2.0)], "too much is painted over"),
        ([Paint(circle=9.0)], ""),
    ],
)
def test_too_much_paint_is_refused(paint: list[Paint], reason: str) -> None:
    said = too_much(FloorSettings(), paint)
    assert reason in said
    assert bool(said) == bool(reason)


def test_a_resolution_that_is_advised_will_do() -> None:
    paint = [Paint(circle=50.0)]
    assert too_much(FloorSettings(resolution=0.026), paint) == ""
