"""The canvas of a camera: for each pixel the inverse depth and the colour of what is nearest so far."""

from __future__ import annotations

import numpy as np

from robolink.sim.rendering.arrays import Floats, Packed
from robolink.sim.rendering.pinhole import Pinhole


class Canvas:
    """Buffers of (rows, columns): `inverse` depth in 1/m, 0 where nothing is, and packed `colours`."""

    def __init__(self, pinhole: Pinhole) -> None:
        shape = pinhole.height, pinhole.width
        self.inverse: Floats = np.zeros(shape, dtype=np.float32)
        self.colours: Packed = np.zeros(shape, dtype=np.uint32)

    def clear(self, sky: int) -> None:
        """Make all pixels sky, a packed colour, without an end."""
        self.inverse.fill(0.0)
        self.colours.fill(sky)
