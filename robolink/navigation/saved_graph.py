"""Files of pose graphs: what a mapper knows, to go on with later (a zip of numpy's .npy files, which run no code).

| array        | type and shape   | is                                                                          |
|--------------|------------------|-----------------------------------------------------------------------------|
| format       | int64, 1         | 1                                                                           |
| poses        | float64, n x 3   | pose of each keyframe in the map: x, y (metres), heading (radians)          |
| steps        | float64, n-1 x 3 | measured pose of each keyframe as seen from the one before                  |
| spreads      | float64, n-1 x 3 x 3 | covariances of the steps                                                |
| loop_ends    | int64, m x 2     | the two keyframes of each loop                                              |
| loop_steps   | float64, m x 3   | measured pose of the second as seen from the first                          |
| loop_spreads | float64, m x 3 x 3 | covariances of these                                                      |
| loop_weights | float64, m       | how much each is believed, from 0 to 1                                      |
| counts       | int64, n x 2     | beams of each keyframe, and how many of them ended at something             |
| origins      | float64, n x 2   | place of the lidar on the robot for each keyframe                           |
| ends         | float32, k x 2   | ends of all beams, one keyframe after the other, in the frame of the robot  |
"""

from __future__ import annotations

import contextlib
import os
import struct
import tokenize
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from robolink.exceptions import RobolinkError
from robolink.geometry.plane import Pose
from robolink.navigation.mapper import Mapper, Options, keyframe_of
from robolink.navigation.occupancy import Beams
from robolink.navigation.pose_graph import Loop

ENDING = ".posegraph"
FORMAT = 1
_SHAPES: dict[str, tuple[str, tuple[int | str, ...]]] = {
    "format": ("int64", (1,)),
    "poses": ("float64", ("keyframes", 3)),
    "steps": ("float64", ("steps", 3)),
    "spreads": ("float64", ("steps", 3, 3)),
    "loop_ends": ("int64", ("loops", 2)),
    "loop_steps": ("float64", ("loops", 3)),
    "loop_spreads": ("float64", ("loops", 3, 3)),
    "loop_weights": ("float64", ("loops",)),
    "counts": ("int64", ("keyframes", 2)),
    "origins": ("float64", ("keyframes", 2)),
    "ends": ("float32", ("beams", 2)),
}
_DAMAGED = (
    *(ArithmeticError, EOFError, KeyError, MemoryError, RuntimeError, SyntaxError, TypeError, ValueError),
    *(struct.error, tokenize.TokenError, zipfile.BadZipFile, zipfile.LargeZipFile, zlib.error),
)
"""Exceptions of zipfile and numpy for files that are damaged, or something else."""
_LARGEST = 2_000_000_000
"""Bytes that an array of a file may have."""


class SavedGraphError(RobolinkError, ValueError):
    """A file of a pose graph that cannot be read, or a graph that cannot be saved."""


def path_of(name: str) -> Path:
    """Return the file of a name, which has or lacks the ending `.posegraph`; `~` is the home folder."""
    path = Path(name).expanduser() if name.startswith("~") else Path(name)
    return path if path.suffix == ENDING else path.with_name(path.name + ENDING)


def save(path: Path, mapper: Mapper) -> None:
    """Write the map of a mapper, with its scans, into a file, which is there as a whole or not at all.

    Args:
        path: The file; one that is there is replaced.
        mapper: Mapper with at least one keyframe.

    Raises:
        SavedGraphError: if there is nothing to save yet.
        OSError: if the file cannot be written.
    """
    if not mapper.keyframes:
        raise SavedGraphError("no scan has become a part of the map yet: there is nothing to save")
    partial = path.with_name(f"{path.name}.{os.getpid()}.partial")
    try:
        with partial.open("wb") as file:
            np.savez_compressed(file, **_arrays(mapper))
            file.flush()
            os.fsync(file.fileno())
        partial.replace(path)
    except OSError:
        with contextlib.suppress(OSError):
            partial.unlink()
        raise


def _arrays(mapper: Mapper) -> dict[str, Any]:
    steps, spreads = mapper.graph.steps
    beams, loops = [each.beams for each in mapper.keyframes], mapper.graph.loops
    return {
        "format": np.array([FORMAT], np.int64),
        "poses": mapper.graph.poses,
        "steps": steps,
        "spreads": spreads,
        "loop_ends": np.array([each[:2] for each in loops], np.int64).reshape(-1, 2),
        "loop_steps": np.array([each.relative for each in loops], np.float64).reshape(-1, 3),
        "loop_spreads": np.array([each.covariance for each in loops], np.float64).reshape(-1, 3, 3),
        "loop_weights": np.array([each.weight for each in loops], np.float64),
        "counts": np.array([(len(each.ends), each.hits) for each in beams], np.int64),
        "origins": np.array([each.origin for each in beams], np.float64),
        "ends": np.concatenate([each.ends for each in beams]).astype(np.float32),
    }


def load(path: Path, options: Options | None = None) -> Mapper:
    """Return a mapper that goes on with the map of a file; call its `begin_at` before the next scan.

    Args:
        path: The file.
        options: How it goes on.

    Raises:
        SavedGraphError: if the file cannot be read, or is not one that `save` wrote.
    """
    try:
        arrays = _read(path)
    except OSError as error:
        raise SavedGraphError(f"{path}: {error.strerror or error}") from None
    except _DAMAGED as error:
        known = "expected a pose graph that robolink's slam_toolbox has saved (ROS's own cannot be read)"
        raise SavedGraphError(f"{path}: {known}: {error}") from None
    return _mapper(arrays, options)


def _read(path: Path) -> dict[str, Any]:
    """Return the arrays of a file, when all of them are as they should be. Raises OSError, ValueError and KeyError."""
    with zipfile.ZipFile(path) as archive:
        sizes = {each.filename: each.file_size for each in archive.infolist()}
    for name in _SHAPES:
        if sizes.get(f"{name}.npy", 0) > _LARGEST:
            raise ValueError(f"{name}: {sizes[f'{name}.npy']} bytes are too many")
    with np.load(path, allow_pickle=False) as file:
        arrays = {name: _checked(name, file[name]) for name in _SHAPES}
    if int(arrays["format"][0]) != FORMAT:
        raise ValueError(f"format: expected {FORMAT}, got {int(arrays['format'][0])}: it is of another robolink")
    _check_sizes(arrays)
    _check_values(arrays)
    return arrays


def _checked(name: str, array: Any) -> Any:
    kind, shape = _SHAPES[name]
    if array.dtype != np.dtype(kind) or array.ndim != len(shape):
        raise ValueError(f"{name}: expected {kind} with {len(shape)} axes, got {array.dtype} with {array.ndim}")
    if any(isinstance(size, int) and size != found for size, found in zip(shape, array.shape, strict=True)):
        raise ValueError(f"{name}: expected the shape {shape}, got {array.shape}")
    if kind.startswith("float") and not np.isfinite(array).all():
        raise ValueError(f"{name}: not all numbers are finite")
    return array


def _check_sizes(arrays: dict[str, Any]) -> None:
    count = len(arrays["poses"])
    sizes = {"keyframes": count, "steps": count - 1, "loops": len(arrays["loop_ends"])}
    sizes["beams"] = int(arrays["counts"].sum(axis=0)[0]) if count else 0
    for name, (_, shape) in _SHAPES.items():
        if isinstance(shape[0], str) and len(arrays[name]) != sizes[shape[0]]:
            raise ValueError(f"{name}: expected {sizes[shape[0]]} rows ({shape[0]}), got {len(arrays[name])}")
    if count < 1:
        raise ValueError("poses: expected one or more")


def _check_values(arrays: dict[str, Any]) -> None:
    ends, hits = arrays["counts"].T
    if (ends < 0).any() or (hits < 0).any() or (hits > ends).any():
        raise ValueError("counts: expected hits from 0 to the number of beams")
    if ((arrays["loop_ends"] < 0) | (arrays["loop_ends"] >= len(ends))).any():
        raise ValueError(f"loop_ends: expected numbers from 0 to {len(ends) - 1}")
    for name in ("spreads", "loop_spreads"):
        if len(arrays[name]) and np.linalg.eigvalsh(arrays[name])[:, 0].min() <= 0.0:
            raise ValueError(f"{name}: expected covariances, whose eigenvalues are above 0")
    if max(np.abs(arrays["poses"]).max(), np.abs(arrays["ends"]).max(initial=0.0)) > 1e12:
        raise ValueError("poses, ends: expected less than 1e12 metres")


def _mapper(arrays: dict[str, Any], options: Options | None) -> Mapper:
    mapper = Mapper(options)
    columns = (arrays[each] for each in ("loop_ends", "loop_steps", "loop_spreads", "loop_weights"))
    loops = [
        Loop(int(ends[0]), int(ends[1]), Pose(*step.tolist()), spread, float(weight))
        for ends, step, spread, weight in zip(*columns, strict=True)
    ]
    mapper.graph.restore(arrays["poses"], arrays["steps"], arrays["spreads"], loops)
    parts = np.split(arrays["ends"].astype(np.float64), np.cumsum(arrays["counts"][:-1, 0]))
    for ends, hits, origin in zip(parts, arrays["counts"][:, 1].tolist(), arrays["origins"].tolist(), strict=True):
        mapper.keyframes.append(keyframe_of(Beams(ends, hits, (origin[0], origin[1]))))
    mapper.begin_at(mapper.graph.pose(0))
    return mapper
