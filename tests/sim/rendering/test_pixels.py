"""Pixels of messages: encodings as OpenCV has them, depths as REP 118 has them, and noise that repeats."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robolink.image.conversion import convert
from robolink.sim.rendering.canvas import CHANNELS, ImageNoise, channels, write_colours, write_depths
from robolink.sim.rendering.pinhole import packed

COLOURS = np.random.default_rng(1).integers(0, 256, (30, 40, 3), dtype=np.uint8)


@pytest.mark.parametrize("encoding", CHANNELS)
def test_colours_are_those_of_opencv_in_every_encoding(encoding: str) -> None:
    image = np.empty((30, 40, channels(encoding)), dtype=np.uint8)
    write_colours(packed(COLOURS), encoding, image)
    expected = COLOURS if encoding == "rgb8" else convert(COLOURS, "rgb8", encoding)
    np.testing.assert_array_equal(image, expected.reshape(image.shape))


def test_depths_out_of_range_are_infinite() -> None:
    inverse = np.array([0.0, 1 / 20.0, 1 / 9.0, 1 / 0.2, 1 / 0.05], dtype=np.float32)
    found = np.empty(5, dtype=np.float32)
    write_depths(inverse, 0.1, 10.0, found)
    assert found.tolist() == pytest.approx([math.inf, math.inf, 9.0, 0.2, -math.inf])


def test_noise_has_the_asked_standard_deviation_and_no_bias() -> None:
    image = np.full((300, 400, 3), 128, dtype=np.uint8)
    ImageNoise(5.0, "7/robot/camera").disturb(image, 3)
    assert image.std() == pytest.approx(5.0, abs=0.03)
    assert image.mean() == pytest.approx(128.0, abs=0.03)


def test_noise_ends_at_black_and_white() -> None:
    for value in (0, 255):
        image = np.full((50, 50), value, dtype=np.uint8)
        ImageNoise(20.0, "").disturb(image, 0)
        assert abs(float(np.median(image)) - value) <= 1.0


def test_noise_depends_on_the_key_and_the_number_alone() -> None:
    def noisy(key: str, number: int) -> bytes:
        image = np.full((5, 7, 3), 100, dtype=np.uint8)
        ImageNoise(5.0, key).disturb(image, number)
        return image.tobytes()

    assert noisy("7/a/camera", 10) == noisy("7/a/camera", 10)
    assert len({noisy("7/a/camera", 10), noisy("7/a/camera", 20), noisy("7/b/camera", 10)}) == 3
