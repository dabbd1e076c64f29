"""Arithmetic of float32 arrays, beside that of doubles."""

from __future__ import annotations

import numpy as np
import pytest

from robolink.navigation.singles import cos_and_sin, decayed, summed


def test_cosines_and_sines() -> None:
    angles = np.linspace(-30.0, 30.0, 100_001).astype(np.float32)
    cos, sin = cos_and_sin(angles)
    assert np.abs(cos - np.cos(angles.astype(float))).max() < 3e-6
    assert np.abs(sin - np.sin(angles.astype(float))).max() < 3e-6


def test_sums_of_rows() -> None:
    steps = np.arange(12, dtype=np.float32).reshape(4, 3)
    expected = steps.cumsum(axis=0) + 5
    assert summed(steps, 5.0).tolist() == expected.tolist()


def test_weights_fall_as_the_exponential_function() -> None:
    costs = np.array([0.0, 0.1, 1.0, 5.0, 19.0, 50.0, 1e6], np.float32)
    assert decayed(costs).tolist() == pytest.approx(np.exp(-costs).tolist(), rel=0.2, abs=1e-8)
