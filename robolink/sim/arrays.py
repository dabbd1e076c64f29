"""Type aliases of numpy arrays, and of poses as plain tuples."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

Array: TypeAlias = "npt.NDArray[np.float64]"
Indices: TypeAlias = "npt.NDArray[np.intp]"

Place: TypeAlias = "tuple[float, float, float]"
"""A pose (x, y, heading in the world) as a plain tuple, where many are made at each step."""
