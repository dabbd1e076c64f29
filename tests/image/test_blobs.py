"""Blobs: areas of one hue in an image, against OpenCV's connected components."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from robolink.image.blobs import HUES, LEAST_SHARE, find_blobs

GRAY = (140, 145, 150)
COLOURS = np.array([GRAY, (220, 20, 20), (210, 210, 10), (20, 200, 30), (10, 200, 200), (20, 20, 230), (220, 10, 220)])


def test_things_are_found_with_their_boxes_and_colours() -> None:
    image = np.full((240, 320, 3), GRAY, np.uint8)
    cv2.circle(image, (100, 100), 30, (220, 20, 20), -1)
    cv2.rectangle(image, (200, 50), (240, 119), (20, 200, 30), -1)
    cv2.rectangle(image, (241, 50), (260, 119), (20, 20, 230), -1)  # touches the green one
    green, red, blue = find_blobs(image)
    assert green == ("green", 200, 50, 41, 70, 41 * 70, (20.0, 200.0, 30.0))
    assert (red.hue, red.centre, red.width, red.height) == ("red", (100, 100), 61, 61)
    assert (blue.hue, blue.left, blue.area) == ("blue", 241, 20 * 70)


@pytest.mark.parametrize("number", range(6))
def test_hues_have_their_names(number: int) -> None:
    image = np.full((4, 4, 3), COLOURS[number + 1], np.uint8)
    (blob,) = find_blobs(image)
    assert (blob.hue, blob.area) == (HUES[number], 16)


@given(arrays.arrays(np.uint8, st.tuples(st.integers(1, 12), st.integers(1, 12)), elements=st.integers(0, 6)))
def test_areas_are_those_that_opencv_connects(picture: np.ndarray) -> None:
    found = sorted(
        (each.hue, each.left, each.top, each.width, each.height, each.area)
        for each in find_blobs(COLOURS[picture].astype(np.uint8))
    )
    wanted = []
    for number, hue in enumerate(HUES, 1):
        boxes = cv2.connectedComponentsWithStats((picture == number).astype(np.uint8), connectivity=4)[2][1:]
        wanted += [(hue, *box) for box in boxes.tolist() if box[4] > LEAST_SHARE * picture.size]
    assert found == sorted(wanted)


@pytest.mark.parametrize("shape", [(0, 0, 3), (1, 1, 3), (0, 5, 3)])
def test_an_image_without_colours_has_none(shape: tuple[int, int, int]) -> None:
    assert find_blobs(np.zeros(shape, np.uint8)) == []
