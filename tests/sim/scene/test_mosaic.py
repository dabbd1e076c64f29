"""Pictures as coloured rectangles: each cell once, in a colour of the picture, and never too many."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from robolink.sim.scene.mosaic import Mosaic, mosaic
from robolink.sim.scene.solids import Picture
from robolink.sim.scene.tags import tag_of, tag_picture

COLOURS = np.array([(255, 255, 255), (0, 0, 0), (200, 30, 30), (30, 80, 180)], np.uint8)


def image(made: Mosaic) -> tuple[Picture, Picture]:
    """The picture that a mosaic shows, and how often each of its cells is covered by a patch."""
    shown = np.empty((made.rows, made.columns, 3), np.uint8)
    shown[:] = made.background
    covered = np.zeros((made.rows, made.columns), np.uint8)
    for left, top, right, bottom, colour in made.patches:
        assert left < right
        assert top < bottom
        shown[top:bottom, left:right] = colour
        covered[top:bottom, left:right] += 1
    return shown, covered


@given(arrays(np.uint8, st.tuples(st.integers(1, 12), st.integers(1, 12)), elements=st.integers(0, 3)))
@settings(max_examples=200)
def test_a_picture_of_few_colours_stays_as_it_is_and_no_patches_overlap(numbers: Picture) -> None:
    picture = COLOURS[numbers]
    shown, covered = image(mosaic(picture, 1_000))
    assert np.array_equal(shown, picture)
    assert covered.max() <= 1


@given(
    arrays(np.uint8, st.tuples(st.integers(1, 40), st.integers(1, 40), st.just(3)), elements=st.integers(0, 255)),
    st.integers(1, 50),
)
def test_any_picture_becomes_at_most_that_many_rectangles_within_it(picture: Picture, most: int) -> None:
    made = mosaic(picture, most)
    assert len(made.patches) <= max(most, 1)
    assert image(made)[1].max() <= 1


def test_a_tag_keeps_every_cell() -> None:
    picture = tag_picture(tag_of("36h11/5"))
    assert np.array_equal(image(mosaic(picture, 1_000))[0], picture)


def test_smoothed_edges_are_no_colours_of_their_own() -> None:
    picture = np.full((64, 64, 3), 255, np.uint8)
    picture[20:40, 20:40] = (200, 30, 30)
    picture[20:40, 19] = picture[20:40, 40] = (228, 142, 142)
    made = mosaic(picture, 100)
    assert {made.background, *(each.colour for each in made.patches)} == {(255, 255, 255), (200, 30, 30)}


def test_a_photograph_is_shown_coarsely() -> None:
    noise = np.random.default_rng(1).integers(0, 256, (300, 400, 3), dtype=np.uint8)
    made = mosaic(noise, 2_000)
    assert len(made.patches) <= 2_000
    assert made.columns < 400
