"""Tags as OpenCV finds them in rendered images: where their corners are, and how far away."""

from __future__ import annotations

import numpy as np
import pytest

from tests.support.tag_views import tag_errors


@pytest.mark.slow
def test_corners_of_tags_are_where_they_ought_to_be() -> None:
    errors = tag_errors((640, 480), 0.7, 60)
    assert errors.missed == 0
    assert np.abs(errors.corners.mean(axis=(0, 1))).max() < 0.05
    assert np.sqrt((errors.corners**2).mean()) < 0.4


@pytest.mark.slow
def test_a_tag_a_metre_away_is_found_within_four_millimetres() -> None:
    errors = tag_errors((640, 480), 1.0, 60)
    assert errors.missed == 0
    assert np.median(errors.places) < 0.004
