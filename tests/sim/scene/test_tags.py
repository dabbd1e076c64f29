"""Fiducial markers: every one of every family as OpenCV draws it, and names that are none."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.sim.scene.tags import Tag, families, plate_size, tag_of, tag_picture

DICTIONARIES = {
    "16h5": "DICT_APRILTAG_16h5",
    "25h9": "DICT_APRILTAG_25h9",
    "36h11": "DICT_APRILTAG_36h11",
    "4x4_50": "DICT_4X4_50",
    "5x5_100": "DICT_5X5_100",
    "6x6_250": "DICT_6X6_250",
    "aruco_original": "DICT_ARUCO_ORIGINAL",
}


def test_the_families_are_these() -> None:
    assert list(families()) == list(DICTIONARIES)


@pytest.mark.parametrize("family", DICTIONARIES)
def test_every_tag_is_as_opencv_draws_it(family: str) -> None:
    aruco = pytest.importorskip("cv2").aruco
    dictionary = aruco.getPredefinedDictionary(getattr(aruco, DICTIONARIES[family]))
    side, codes = families()[family]
    assert (side, len(codes)) == (dictionary.markerSize, len(dictionary.bytesList))
    for number in range(len(codes)):
        drawn = aruco.generateImageMarker(dictionary, number, side + 2, borderBits=1)
        picture = tag_picture(Tag(family, number))
        for channel in range(3):
            np.testing.assert_array_equal(picture[1:-1, 1:-1, channel], drawn, err_msg=f"{family}/{number}")


def test_a_picture_has_a_white_margin_of_a_cell() -> None:
    picture = tag_picture(Tag("36h11", 3))
    assert picture.shape == (10, 10, 3)
    assert (picture[0] == 255).all()
    assert (picture[:, -1] == 255).all()
    assert (picture[1, 1:-1] == 0).all()
    assert not picture.flags.writeable
    assert tag_picture(Tag("36h11", 3)) is picture


def test_the_size_is_that_of_the_black_square() -> None:
    assert plate_size(Tag("36h11", 0), 0.16) == pytest.approx(0.2)
    assert plate_size(Tag("16h5", 0), 0.12) == pytest.approx(0.16)


@pytest.mark.parametrize(
    ("text", "tag"),
    [
        ("36h11/3", ("36h11", 3)),
        ("36H11/586", ("36h11", 586)),
        ("6X6_250/0", ("6x6_250", 0)),
        ("16h5/007", ("16h5", 7)),
    ],
)
def test_a_tag_has_a_family_and_a_number(text: str, tag: tuple[str, int]) -> None:
    assert tag_of(text) == tag


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("36h11", "'36h11' is not a tag of 36h11: expected 36h11/0 to 36h11/586"),
        ("36h11/587", "'36h11/587' is not a tag of 36h11: expected 36h11/0 to 36h11/586"),
        ("36h11/-1", "'36h11/-1' is not a tag of 36h11: expected 36h11/0 to 36h11/586"),
        ("36h11/3.0", "'36h11/3.0' is not a tag of 36h11"),
        ("36h11/\u0663", "is not a tag of 36h11"),
        ("36h12/3", "'36h12/3' has no known family (did you mean '36h11'?): expected one of 16h5, 25h9,"),
        ("", "'' has no known family"),
    ],
)
def test_what_is_no_tag_is_told_what_there_is(text: str, expected: str) -> None:
    with pytest.raises(ValueError, match=re.escape(expected)):
        tag_of(text)


@given(st.text() | st.builds("{}/{}".format, st.sampled_from([*DICTIONARIES, "x"]), st.integers() | st.text()))
def test_any_text_is_a_tag_or_a_value_error_of_one_line(text: str) -> None:
    try:
        tag = tag_of(text)
    except ValueError as error:
        refused = str(error)
    else:
        refused = ""
        assert 0 <= tag.number < len(families()[tag.family].codes)
    assert refused.isprintable()
