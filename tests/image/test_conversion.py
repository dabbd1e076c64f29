"""Conversions of images are OpenCV's bit for bit, between every two encodings."""

from __future__ import annotations

import hashlib
import itertools
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from robolink.image.conversion import convert
from robolink.image.encodings import COLOURED, ImageError, encoding_of
from tests.support.opencvs_conversions import BAYER, ENCODINGS, GENERIC, ORDERS, NoSenseError, by_opencv, some_image


def is_the_same(source: str, target: str, rng: np.random.Generator, height: int, width: int) -> bool:
    """Compare a conversion, or a refusal, with OpenCV's; return True if it was a conversion."""
    image = some_image(source, rng, height, width)
    before = image.copy()
    try:
        expected = by_opencv(image, source, target)
    except NoSenseError:
        with pytest.raises(ImageError) as caught:
            convert(image, source, target)
        assert "\n" not in str(caught.value)
        return False
    converted = convert(image, source, target)
    assert (converted.dtype, converted.shape) == (expected.dtype, expected.shape), (source, target)
    assert_array_equal(converted, expected, f"{source} to {target}")
    assert_array_equal(image, before)
    assert not np.shares_memory(converted, image)
    assert converted.flags.c_contiguous
    assert converted.flags.writeable
    return True


@pytest.mark.slow
def test_every_two_encodings() -> None:
    rng = np.random.default_rng(17)
    done = sum(is_the_same(*each, rng, 6, 8) for each in itertools.product(ENCODINGS, ENCODINGS))
    colours = len(ORDERS) ** 2 + len(BAYER) * 7 + 2 * 11
    assert done > colours


@pytest.mark.slow
@given(
    st.sampled_from(ENCODINGS),
    st.sampled_from(ENCODINGS),
    st.integers(0, 2**32),
    st.integers(2, 20),
    st.integers(1, 20),
)
@settings(max_examples=300, deadline=None)
def test_random_images(source: str, target: str, seed: int, half_height: int, half_width: int) -> None:
    is_the_same(source, target, np.random.default_rng(seed), 2 * half_height, 2 * half_width + 2)


@pytest.mark.parametrize(
    ("source", "target"), [("mono16", "mono8"), ("mono8", "mono16"), ("16SC1", "8SC1"), ("8SC1", "16UC1")]
)
def test_every_value_of_eight_and_sixteen_bits(source: str, target: str) -> None:
    kind = encoding_of(source).dtype
    values = np.arange(2 ** (8 * kind.itemsize)).astype(kind).reshape(16, -1)
    assert_array_equal(convert(values, source, target), by_opencv(values, source, target))


def test_shades_of_every_64th_colour() -> None:
    colours = np.arange(0, 2**24, 61, dtype=np.uint32)
    image = np.stack([colours & 255, (colours >> 8) & 255, colours >> 16], axis=-1).astype(np.uint8)[None]
    assert_array_equal(convert(image, "rgb8", "mono8"), by_opencv(image, "rgb8", "mono8"))
    deep = (image.astype(np.uint16) << 8) | np.roll(image, 7, axis=1)
    assert_array_equal(convert(deep, "bgr16", "mono16"), by_opencv(deep, "bgr16", "mono16"))


def test_the_bytes_are_these_on_every_machine() -> None:
    """Stored results of OpenCV 4.14 and 5.0: where OpenCV is of another make, this still holds."""
    values = (np.arange(20 * 30 * 3, dtype=np.uint32) * 2654435761 >> 13).astype(np.uint8).reshape(20, 30, 3)
    made = b"".join(convert(values, "bgr8", each).tobytes() for each in ("mono8", "rgba16", "mono16", "bgra8"))
    assert hashlib.sha256(made).hexdigest()[:16] == "29fea978777ac2fc"


def test_numbers_are_not_made_colours() -> None:
    depth = np.ones((2, 2), np.float32)
    with pytest.raises(
        ImageError, match=r"^\[32FC1\] is not a color format\. but \[bgr8\] is\. .* ask for 'passthrough'"
    ):
        convert(depth, "32FC1", "bgr8")
    with pytest.raises(
        ImageError, match=r"^\[bgr8\] is a color format but \[8UC1\] do not have the same number of chan"
    ):
        convert(np.ones((2, 2, 3), np.uint8), "bgr8", "8UC1")
    with pytest.raises(ImageError, match="an image of bgr8 is 8UC3, and this one is 32FC1"):
        convert(depth, "bgr8", "rgb8")


@pytest.mark.parametrize(
    "name", ["BGR8", "bgr", "8UC0", "8UC513", "32U", "", "8UC", " 8UC1", "rgb8\n", "\x1b[2J", "8UC\u0663"]
)
def test_unknown_encodings_are_one_line(name: str) -> None:
    with pytest.raises(ImageError, match=r"^Unrecognized image encoding") as caught:
        encoding_of(name)
    assert str(caught.value).isprintable()


def test_a_misspelt_encoding_is_recognised() -> None:
    with pytest.raises(ImageError, match=r"did you mean 'mono16'"):
        encoding_of("mono_16")


@pytest.mark.parametrize("name", [*COLOURED, *GENERIC])
def test_the_same_encoding_is_a_copy(name: str) -> None:
    image = some_image("8UC2" if name in ("uyvy", "yuyv") else name, np.random.default_rng(1), 4, 6)
    for target in (name, "", "passthrough"):
        again = convert(image, name, target)
        assert_array_equal(again, image)
        assert not np.shares_memory(again, image)


def test_what_opencv_refuses_is_one_line() -> None:
    with pytest.raises(ImageError, match=r"^OpenCV could not convert 3 x 3 pixels from yuv422 to bgr8: ") as caught:
        convert(np.zeros((3, 3, 2), np.uint8), "yuv422", "bgr8")
    assert "\n" not in str(caught.value)


def test_a_pattern_without_opencv_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(ImageError, match=r"^bayer_rggb8 to bgr8 needs OpenCV, .* pip install opencv-python$"):
        convert(np.zeros((4, 4), np.uint8), "bayer_rggb8", "bgr8")
    assert convert(np.zeros((4, 4), np.uint8), "mono8", "bgr8").shape == (4, 4, 3)
