"""Files of maps: occupancy grids from YAML files with their images, and into these, as nav2_map_server has them."""

from __future__ import annotations

import math
import re
from enum import IntEnum
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import unquote, urlparse

import numpy as np
import numpy.typing as npt

from robolink.documents.yamlfile import DocumentNotFoundError
from robolink.exceptions import DocumentError, RobolinkError, nearest
from robolink.image.codecs import png_of
from robolink.interfaces.geometry_msgs.msg import Point, Pose, Quaternion
from robolink.interfaces.nav_msgs.msg import MapMetaData, OccupancyGrid
from robolink.sim.maps.gridmap import load_map

MODES, FORMATS = ("trinary", "scale", "raw"), ("pgm", "png")
FREE, OCCUPIED, UNKNOWN = 254, 0, 205
"""Shades of cells in the mode `trinary`."""
FREE_SHARE = 0.196
"""Largest free_thresh with which `UNKNOWN` is read as unknown."""


class LoadResult(IntEnum):
    """Results of loading a map, as nav2_msgs/srv/LoadMap numbers them."""

    SUCCESS = 0
    MAP_DOES_NOT_EXIST = 1
    INVALID_MAP_DATA = 2
    INVALID_MAP_METADATA = 3


class MapSaveError(RobolinkError, ValueError):
    """A map cannot be saved as it is asked for."""


class Saving(NamedTuple):
    """Choices for saving a map: `path` without its ending, `form` pgm or png, thresholds from 0 to 1."""

    path: str
    form: str = ""
    mode: str = "trinary"
    occupied: float = 0.65
    free: float = 0.25


def grid_of(path: Path) -> OccupancyGrid:
    """Return the map of a YAML file, without header and time. Raises DocumentError with file:line:column."""
    found = load_map(path)
    height, width = found.cells.shape
    half = found.origin.theta / 2
    origin = Pose(
        position=Point(x=found.origin.x, y=found.origin.y), orientation=Quaternion(z=math.sin(half), w=math.cos(half))
    )
    information = MapMetaData(resolution=found.resolution, width=width, height=height, origin=origin)
    return OccupancyGrid(info=information, data=found.cells.ravel())


def result_of(error: DocumentError) -> LoadResult:
    """Return the number for the error of a file."""
    if isinstance(error, DocumentNotFoundError):
        return LoadResult.MAP_DOES_NOT_EXIST
    return LoadResult.INVALID_MAP_DATA if error.message.startswith("image:") else LoadResult.INVALID_MAP_METADATA


def path_of(url: str) -> Path:
    """Return the path of a map's URL, which may be a path; `~` is the home folder, as nav2 has it."""
    if not url.startswith("file://"):
        return Path(url).expanduser() if url == "~" or url.startswith("~/") else Path(url)
    path = unquote(urlparse(url).path)
    # file:///C:/maps/a.yaml is C:/maps/a.yaml; a URL has a slash before the drive, which is not a part of the path
    return Path(path[1:] if re.match(r"/[A-Za-z]:(/|$)", path) else path)


def checked(given: Saving) -> Saving:
    """Return the same with its format and defaults filled in. Raises MapSaveError."""
    form = given.form or ("png" if given.mode == "scale" else "pgm")
    for what, value, known in (("mode", given.mode, MODES), ("format", form, FORMATS)):
        if value not in known:
            raise MapSaveError(f"{what}: expected {' or '.join(known)}, got '{value}'{nearest(value, known)}")
    if form == "pgm" and given.mode == "scale":
        raise MapSaveError("the mode scale has unknown cells transparent: its format is png")
    if not 0.0 <= given.free < given.occupied <= 1.0:
        raise MapSaveError(f"thresholds: expected 0 <= free < occupied <= 1, got {given.free:g} and {given.occupied:g}")
    return given._replace(form=form)


def save(grid: OccupancyGrid, given: Saving) -> None:
    """Write a map's image and its YAML file. Raises MapSaveError, and OSError from writing the files."""
    how = checked(given)
    cells = np.asarray(grid.data, np.int8).astype(np.int16)
    height, width = grid.info.height, grid.info.width
    if cells.size != width * height or not cells.size:
        raise MapSaveError(f"a map of {width} x {height} cells has {cells.size}")
    image = shades(cells.reshape(height, width)[::-1], how)
    path = Path(f"{how.path}.{how.form}")
    path.write_bytes(png_of(image) if how.form == "png" else b"P5\n%d %d\n255\n" % (width, height) + image.tobytes())
    Path(f"{how.path}.yaml").write_text(description(grid.info, how), encoding="utf-8")


def shades(cells: npt.NDArray[np.int16], how: Saving) -> npt.NDArray[np.uint8]:
    """Return the pixels of cells; in the mode `scale` four channels, of which the last says what is known."""
    known = (cells >= 0) & (cells <= 100)
    if how.mode == "raw":
        return np.where(known, cells, 255).astype(np.uint8)
    if how.mode == "scale":
        grey = np.where(known, np.round((100 - cells) / 100 * 255), 0)
        return np.stack([grey, grey, grey, np.where(known, 255, 0)], axis=-1).astype(np.uint8)
    free, occupied = round(100 * how.free), round(100 * how.occupied)
    certain = np.where(cells >= occupied, OCCUPIED, UNKNOWN)
    return np.where(known, np.where(cells <= free, FREE, certain), UNKNOWN).astype(np.uint8)


def description(information: Any, how: Saving) -> str:
    """Return the text of a map's YAML file."""
    origin = information.origin
    turn = origin.orientation
    yaw = math.atan2(2.0 * (turn.w * turn.z + turn.x * turn.y), 1.0 - 2.0 * (turn.y**2 + turn.z**2))
    free = min(how.free, FREE_SHARE) if how.mode == "trinary" else how.free
    return (
        f"image: {Path(how.path).name}.{how.form}\n"
        f"mode: {how.mode}\n"
        f"resolution: {float(np.float32(information.resolution).astype(str)):g}\n"
        f"origin: [{origin.position.x:.6g}, {origin.position.y:.6g}, {yaw:.6g}]\n"
        "negate: 0\n"
        f"occupied_thresh: {how.occupied:g}\n"
        f"free_thresh: {free:g}\n"
    )
