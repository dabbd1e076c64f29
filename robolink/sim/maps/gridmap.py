"""Occupancy grid maps of ROS's map_server: reads the YAML file with its image, and finds the walls.

Pixels have the meaning of nav2_map_server: a shade becomes an occupancy of 0 to 1 (black is 1, or white with
`negate`); at `occupied_thresh` and above it is occupied, at `free_thresh` and below free, between them unknown. With
the mode `scale` those between have a number, with `raw` the shade itself is the percentage.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import msgspec
import numpy as np
import numpy.typing as npt
from msgspec import Meta, Struct

from robolink.documents import yamlfile
from robolink.documents.foreign import warn, warn_of_unknown_keys
from robolink.exceptions import DocumentError, nearest
from robolink.sim.description import MapWalls
from robolink.sim.maps.formats import read_image
from robolink.sim.maps.image import Image, ImageError
from robolink.sim.quantities import Coordinate, Pose
from robolink.system.terminal import shown

MOST_PIECES = 200_000
"""Most pieces of wall of a map: a building has about ten thousand, and noise has millions."""

TRUE_WORDS, FALSE_WORDS = frozenset({"y", "yes", "true", "on"}), frozenset({"n", "no", "false", "off"})
"""Words that yaml-cpp reads as booleans, in any case."""
_NUMBERS = ("resolution", "occupied_thresh", "free_thresh")

FREE, OCCUPIED, UNKNOWN = 0, 100, -1
"""Values of cells, as in nav_msgs/OccupancyGrid."""


class MapFile(Struct, frozen=True):
    """A map's YAML file: `resolution` in metres per pixel, `origin` the pose of the image's lower left corner."""

    image: Annotated[str, Meta(min_length=1)]
    resolution: Annotated[float, Meta(ge=0.0001, le=1000.0)]
    origin: tuple[Coordinate, Coordinate, float]
    occupied_thresh: float
    free_thresh: float
    negate: bool
    mode: Literal["trinary", "scale", "raw"] = "trinary"


class GridMap(NamedTuple):
    """An occupancy grid: `cells` by row from the bottom, column from the left; 0 free to 100 occupied, -1 unknown."""

    cells: npt.NDArray[np.int8]
    occupied: npt.NDArray[np.bool_]
    resolution: float
    origin: Pose

    def is_occupied(self, x: float, y: float) -> bool:
        """True if a point of the world, in metres, lies in an occupied cell."""
        dx, dy, cos, sin = (
            x - self.origin.x,
            y - self.origin.y,
            math.cos(self.origin.theta),
            math.sin(self.origin.theta),
        )
        column = math.floor((cos * dx + sin * dy) / self.resolution)
        row = math.floor((cos * dy - sin * dx) / self.resolution)
        height, width = self.occupied.shape
        return 0 <= row < height and 0 <= column < width and bool(self.occupied[row, column])

    def walls(self) -> npt.NDArray[np.float64]:
        """Return the edges of the occupied cells, joined where they go on, as rows x1, y1, x2, y2 in metres.

        Raises ValueError if they are too many.
        """
        x, y = (cell_edges(self.occupied) * self.resolution).reshape(-1, 2).T
        cos, sin = math.cos(self.origin.theta), math.sin(self.origin.theta)
        # Not as a product of matrices, whose last bits are those of the machine's library.
        turned = np.column_stack((x * cos - y * sin + self.origin.x, x * sin + y * cos + self.origin.y))
        return turned.reshape(-1, 4)


def load_map(path: Path) -> GridMap:
    """Read a map's YAML file and its image as nav2's map_io does.

    What that reader ignores or takes as it is, though it can hardly be meant, is told in a `FileWarning`.

    Raises:
        DocumentError: for a mistake, with file:line:column.
    """
    document = yamlfile.read(path, dict[str, Any])
    file = document.convert(_as_map_io_reads(document.value), MapFile)
    warn_of_unknown_keys(document, document.data, [each.name for each in msgspec.structs.fields(MapFile)])
    for each in _doubts(document, file):
        warn(each)
    try:
        image = read_image(path.parent / file.image)
    except FileNotFoundError:
        near = nearest(Path(file.image).name, yamlfile.siblings(path.parent / file.image))
        raise document.error("$.image", f"no file '{shown(str(path.parent / file.image))}'{near}") from None
    except (ImageError, OSError, ValueError) as error:
        reason = str(error.strerror if isinstance(error, OSError) else error)
        raise document.error("$.image", f"'{shown(file.image)}' cannot be read: {reason}") from None
    cells = occupancy(image, file)
    occupied = cells >= (100 * file.occupied_thresh if file.mode == "raw" else OCCUPIED)
    return GridMap(cells, occupied, file.resolution, Pose(*file.origin))


def _as_map_io_reads(data: dict[str, Any]) -> dict[str, Any]:
    """Return the values as nav2 converts them: numbers in quotes, words for `negate`, `mode` in any case."""
    found = {key: _number(data[key]) for key in _NUMBERS if key in data}
    if isinstance(data.get("origin"), list):
        found["origin"] = [_number(each) for each in data["origin"]]
    if isinstance(mode := data.get("mode"), str):
        found["mode"] = mode.lower()
    if "negate" in data:
        found["negate"] = _truth(data["negate"])
    if isinstance(image := data.get("image"), int | float) and not isinstance(image, bool):
        found["image"] = str(image)
    return {**data, **found}


def _number(value: Any) -> Any:
    """Return the number that a text spells; anything else as it is."""
    try:
        return float(value) if isinstance(value, str) else value
    except ValueError:
        return value


def _truth(value: Any) -> Any:
    """Return a whole number or a word of YAML 1.1 as a boolean; anything else as it is."""
    if isinstance(value, str) and value.lower() in TRUE_WORDS | FALSE_WORDS:
        return value.lower() in TRUE_WORDS
    number = _number(value)
    return bool(number) if isinstance(number, int | float) and number == int(number) else value


def _doubts(document: yamlfile.Document[dict[str, Any]], file: MapFile) -> Iterator[DocumentError]:
    """Yield the faults that nav2 loads without a word."""
    for key in ("occupied_thresh", "free_thresh"):
        if not 0.0 <= getattr(file, key) <= 1.0:
            yield document.error([key], f"{getattr(file, key):g} is not a share from 0 to 1")
    if file.free_thresh >= file.occupied_thresh:
        reason = f"{file.free_thresh:g} is not less than occupied_thresh, {file.occupied_thresh:g}"
        yield document.error(["free_thresh"], reason)
    if abs(file.origin[2]) > math.tau:
        yield document.error(["origin", 2], f"the yaw is in radians, and {file.origin[2]:g} is more than a turn")


def map_walls(grid: GridMap, height: float | None = None, colour: str | None = None) -> MapWalls:
    """Return a map's walls as a part of a world. Raises ValueError if they are too many.

    Args:
        grid: The map.
        height: Height of the walls in metres.
        colour: Colour of the walls, as in a world file.
    """
    segments = grid.walls()
    if len(segments) > MOST_PIECES:
        raise ValueError(_too_many(len(segments)))
    return MapWalls(tuple((x, y) for x, y in segments.reshape(-1, 2).tolist()), height=height, colour=colour)


def occupancy(image: Image, file: MapFile) -> npt.NDArray[np.int8]:
    """Return the occupancy of an image's pixels, the first row at the bottom."""
    shade = np.arange(256)
    if file.mode == "raw":
        return _looked_up(image, np.where(shade <= OCCUPIED, shade, UNKNOWN))[::-1]
    share = shade.astype(np.float32) / np.float32(255)
    if not file.negate:
        share = np.float32(1) - share
    free, occupied = np.float32(file.free_thresh), np.float32(file.occupied_thresh)
    between: Any = UNKNOWN
    if file.mode == "scale" and free < occupied:  # else nothing lies between
        between = np.round((share - free) / (occupied - free) * 100).clip(UNKNOWN, OCCUPIED)
    cells = _looked_up(image, np.where(share >= occupied, OCCUPIED, np.where(share <= free, FREE, between)))
    if image.transparent is not None:
        cells[image.transparent] = UNKNOWN
    return cells[::-1]


def _looked_up(image: Image, meaning: npt.NDArray[Any]) -> npt.NDArray[np.int8]:
    """Replace each shade by its meaning, byte by byte: indexing by an array would take eight bytes for each."""
    cells = bytearray(image.shades.tobytes().translate(meaning.astype(np.int8).tobytes()))
    return np.frombuffer(cells, np.int8).reshape(image.shades.shape)


def cell_edges(occupied: npt.NDArray[np.bool_]) -> npt.NDArray[np.float64]:
    """Return the edges between occupied cells and others as rows x1, y1, x2, y2 in cells, joined where straight."""
    padded = np.pad(occupied, 1)
    upright = _runs((padded[1:-1, 1:] != padded[1:-1, :-1]).T)
    level = _runs(padded[1:, 1:-1] != padded[:-1, 1:-1])
    x, bottom, top = upright.T
    y, left, right = level.T
    rows = np.concatenate((np.column_stack((x, bottom, x, top)), np.column_stack((left, y, right, y))))
    return rows.astype(np.float64)


def _too_many(count: int) -> str:
    return f"{count} pieces of wall, at most {MOST_PIECES}: is the map all noise?"


def _runs(lines: npt.NDArray[np.bool_]) -> npt.NDArray[np.int64]:
    """Find the runs of True along each line: rows of line, start, end. Raises ValueError if they are too many."""
    padded = np.pad(lines, ((0, 0), (1, 1)))
    differ = padded[:, 1:] != padded[:, :-1]
    if (count := np.count_nonzero(differ) // 2) > MOST_PIECES:
        raise ValueError(_too_many(count))
    changes = np.flatnonzero(differ)
    line, place = np.divmod(changes, lines.shape[1] + 1)
    return np.column_stack((line[::2], place[::2], place[1::2]))
