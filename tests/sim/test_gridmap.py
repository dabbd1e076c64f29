"""Maps of ROS's map_server: what pixels mean, which walls there are, and what broken ones are told."""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from robolink.documents.foreign import FileWarning
from robolink.exceptions import DocumentError
from robolink.sim import Pose, World, load_world
from robolink.sim.maps import gridmap as room
from robolink.sim.maps.formats import read_image
from robolink.sim.maps.gridmap import GridMap, MapFile, cell_edges, load_map, map_walls, occupancy
from robolink.sim.maps.image import Image, ImageError
from robolink.sim.worldfile import check_world

OFFICE = Path(__file__).parents[2] / "configs" / "worlds" / "maps" / "office.yaml"

KEYS = {
    "image": "map.pgm",
    "resolution": "0.5",
    "origin": "[0, 0, 0]",
    "negate": "0",
    "occupied_thresh": "0.65",
    "free_thresh": "0.25",
}
ROOM = b"P5 4 3 255\n" + bytes([0, 0, 0, 0, 0, 254, 205, 0, 0, 0, 0, 0])
Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write a map: an image's bytes, and the keys of its YAML file that differ from `KEYS`; None leaves one out."""

    def write(pixels: bytes = ROOM, **keys: str | None) -> Path:
        (tmp_path / "map.pgm").write_bytes(pixels)
        lines = [f"{key}: {value}" for key, value in {**KEYS, **keys}.items() if value is not None]
        (tmp_path / "map.yaml").write_text("\n".join(lines))
        return tmp_path / "map.yaml"

    return write


# --- what pixels mean -----------------------------------------------------------------------------------------


def meant(shades: list[int], **keys: Any) -> list[int]:
    file = MapFile("", 1.0, (0.0, 0.0, 0.0), **{"occupied_thresh": 0.65, "free_thresh": 0.25, "negate": False, **keys})
    cells: list[int] = occupancy(Image(np.array([shades], np.uint8)), file)[0].tolist()
    return cells


def test_shades_mean_what_map_server_says() -> None:
    assert meant([0, 89, 90, 191, 192, 205, 255]) == [100, 100, -1, -1, 0, 0, 0]
    assert meant([205, 206], free_thresh=0.196) == [-1, 0]  # map_saver's gray is unknown by map_saver's own threshold
    assert meant([0, 63, 64, 165, 166, 255], negate=1) == [0, 0, -1, -1, 100, 100]
    assert meant([0, 90, 141, 191, 192], mode="scale") == [100, 99, 49, 0, 0]
    assert meant([0, 65, 100, 101, 255], mode="raw") == [0, 65, 100, -1, -1]


def test_what_can_be_seen_through_is_unknown() -> None:
    file = MapFile("", 1.0, (0.0, 0.0, 0.0), occupied_thresh=0.65, free_thresh=0.25, negate=False)
    image = Image(np.zeros((1, 2), np.uint8), np.array([[False, True]]))
    assert occupancy(image, file).tolist() == [[100, -1]]


def test_raw_cells_are_occupied_from_the_threshold_on(write: Write) -> None:
    grid = load_map(write(b"P5 4 1 255\n" + bytes([64, 65, 100, 255]), mode="raw"))
    assert grid.occupied.tolist() == [[False, True, True, False]]


# --- walls ----------------------------------------------------------------------------------------------------


def test_a_room_is_two_rings_of_walls(write: Write) -> None:
    walls = load_map(write()).walls()
    outside = {(0.0, 0.0, 0.0, 1.5), (2.0, 0.0, 2.0, 1.5), (0.0, 0.0, 2.0, 0.0), (0.0, 1.5, 2.0, 1.5)}
    inside = {(0.5, 0.5, 0.5, 1.0), (1.5, 0.5, 1.5, 1.0), (0.5, 0.5, 1.5, 0.5), (0.5, 1.0, 1.5, 1.0)}
    assert {tuple(each) for each in walls.tolist()} == outside | inside


def test_the_image_is_upright_and_turned_by_the_origin(write: Write) -> None:
    corner = b"P5 2 2 255\n" + bytes([0, 255, 255, 255])  # the upper left pixel
    plain, turned = load_map(write(corner)), load_map(write(corner, origin="[3, 4, 1.5707963267948966]"))
    assert plain.walls()[0].tolist() == [0.0, 0.5, 0.0, 1.0]
    assert turned.walls()[0] == pytest.approx([2.5, 4.0, 2.0, 4.0])
    assert (plain.is_occupied(0.25, 0.75), plain.is_occupied(0.25, 0.25), plain.is_occupied(-1, 9)) == (
        True,
        False,
        False,
    )
    assert (turned.is_occupied(2.25, 4.25), turned.is_occupied(2.75, 4.25)) == (True, False)


def edges_one_by_one(occupied: npt.NDArray[np.bool_]) -> set[tuple[float, ...]]:
    """Every edge of a cell that parts an occupied from another, found the slow way."""
    height, width = occupied.shape
    at = {(x, y): bool(occupied[y, x]) for y in range(height) for x in range(width)}
    found = set[tuple[float, ...]]()
    for x in range(width + 1):
        for y in range(height + 1):
            if at.get((x, y), False) != at.get((x - 1, y), False):
                found.add((x, y, x, y + 1))
            if at.get((x, y), False) != at.get((x, y - 1), False):
                found.add((x, y, x + 1, y))
    return found


@given(arrays.arrays(np.bool_, st.tuples(st.integers(1, 7), st.integers(1, 7))))
@settings(deadline=None)
def test_walls_are_all_edges_of_cells_each_once_and_as_long_as_they_go(occupied: npt.NDArray[np.bool_]) -> None:
    walls = [tuple(each) for each in cell_edges(occupied).tolist()]
    pieces = []
    for x1, y1, x2, y2 in walls:
        steps = int(x2 - x1 + y2 - y1)
        dx, dy = (x2 - x1) / steps, (y2 - y1) / steps
        pieces += [(x1 + n * dx, y1 + n * dy, x1 + (n + 1) * dx, y1 + (n + 1) * dy) for n in range(steps)]
    assert len(pieces) == len(set(pieces))
    assert set(pieces) == edges_one_by_one(occupied)
    ends = [(x1 == x2, x2, y2) for x1, y1, x2, y2 in walls]
    assert not set(ends) & {(x1 == x2, x1, y1) for x1, y1, x2, y2 in walls}  # none goes on where another ends


def test_a_scan_sees_the_walls_of_a_map(write: Write) -> None:
    path = write(
        b"P5 20 20 255\n" + bytes(0 if y in (0, 19) or x in (0, 19) else 255 for y in range(20) for x in range(20))
    )
    world_file = path.parent / "world.yaml"
    world_file.write_text(
        "map: {yaml: map.yaml}\nrobots: [{name: r, pose: [5, 5], sensors: [{lidar: scan, beams: 4}]}]"
    )
    (wall,) = load_world(world_file).walls
    assert len(wall.segments()) == 8
    assert World(load_world(world_file)).robots["r"].scan().ranges == pytest.approx([4.5, 4.5, 4.5, 4.5])


@pytest.mark.parametrize(("x", "inside"), [(1.0, True), (0.1, True), (0.4, True), (2.6, False), (1.33, False)])
def test_nothing_free_may_start_in_what_is_occupied(write: Write, x: float, inside: bool) -> None:
    path = write(b"P5 4 1 255\n" + bytes([0, 0, 255, 255]), resolution="0.5").parent / "world.yaml"
    path.write_text(f"map: {{yaml: map.yaml}}\nrobots: [{{name: r, pose: [{x}, 0.25], shape: {{box: [0.5, 0.4]}}}}]")
    errors = [str(each).partition(": ")[2] for each in check_world(path).errors]
    wrong = "robots[0].pose: this starts inside of the map's walls: move it out of there"
    assert errors == ([wrong] if inside else [])


def test_a_robot_in_the_midst_of_a_block_is_noticed(write: Write) -> None:
    path = write(b"P5 9 9 255\n" + bytes(81)).parent / "world.yaml"
    path.write_text("map: {yaml: map.yaml}\nobstacles: [{circle: 0.1, pose: [2.2, 2.2], mass: 1}]")
    with pytest.raises(DocumentError, match=r"world\.yaml:2:33: obstacles\[0\]\.pose: this starts inside of the map"):
        load_world(path)


def test_the_office_that_comes_along() -> None:
    grid = load_map(OFFICE)
    assert grid.cells.shape == (180, 280)
    assert 100 < len(map_walls(grid).segments()) < 300
    assert not grid.is_occupied(1.2, 4.0)


# --- what broken maps are told --------------------------------------------------------------------------------

BAD = [
    ({"image": None}, "map.yaml:1:1: missing key 'image'"),
    ({"negate": None}, "map.yaml:1:1: missing key 'negate'"),
    ({"resolution": "0"}, "map.yaml:2:13: resolution: expected float >= 0.0001, got '0'"),
    ({"origin": "[0, 0]"}, "map.yaml:3:9: origin: expected list of length 3, got 2"),
    ({"negate": "maybe"}, "map.yaml:4:9: negate: expected"),
    ({"negate": "0.5"}, "map.yaml:4:9: negate: expected"),
    ({"image": "''"}, "map.yaml:1:8: image: expected"),
    (
        {"mode": "trinay"},
        "map.yaml:7:7: mode: expected one of trinary, scale, raw, got 'trinay' (did you mean 'trinary'?)",
    ),
    ({"image": "mapp.pgm"}, "mapp.pgm' (did you mean 'map.pgm'?)"),
    ({"image": "."}, "map.yaml:1:8: image: '.' cannot be read: "),
]
DOUBTED = [
    ({"map_type": "occupancy"}, "map.yaml:7:1: map_type: unknown key 'map_type': ignored"),
    ({"resolutoin": "1"}, "7:1: resolutoin: unknown key 'resolutoin' (did you mean 'resolution'?): ignored"),
    ({"origin": "[0, 0, 90]"}, "3:16: origin[2]: the yaw is in radians, and 90 is more than a turn"),
    ({"occupied_thresh": "65"}, "5:18: occupied_thresh: 65 is not a share from 0 to 1"),
    ({"free_thresh": "0.7"}, "6:14: free_thresh: 0.7 is not less than occupied_thresh, 0.65"),
]
"""Values that nav2's map_io loads, and nobody means."""
BROKEN = [
    (b"", "neither PGM (P2, P5) nor PNG: save it as one of these"),
    (b"GIF89a....", "neither PGM (P2, P5) nor PNG: save it as one of these"),
    (b"P5 4", "after P5 a PGM has its width, height and largest value"),
    (b"P5 0 4 255\n", "0 x 4 pixels: expected 1 to 25 million"),
    (b"P5 65536 1 255\n", "65536 x 1 pixels: at most 65,535 along a side"),
    (b"P5 99999 99999 255\n", "99999 x 99999 pixels: expected 1 to 25 million"),
    (b"P5 2 2 0\nabcd", "the largest value is 0: expected 1 to 65535"),
    (b"P5 2 2 255\nabc", "it ends too early: 3 of 4 pixels"),
    (b"P5 2 2 65535\nabcd", "it ends too early: 2 of 4 pixels"),
    (b"P5 2 1 7\nab", "a value of 98, where the largest is 7"),
    (b"P2 2 2 255\n1 2 x 3", "something else among the numbers"),
    (b"P2 2 2 255\n1 2 3", "it ends too early: 3 of 4 pixels"),
    (b"P2 1 1 255\n" + b"9" * 30, "a value of 9223372036854775807, where the largest is 255"),
]


@pytest.mark.parametrize(("keys", "report"), BAD)
def test_a_wrong_map_is_reported_in_one_line_with_its_place(
    write: Write, keys: dict[str, str | None], report: str
) -> None:
    with pytest.raises(DocumentError) as caught:
        load_map(write(**keys))
    assert report in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("keys", "report"), DOUBTED)
def test_what_map_io_takes_is_taken_with_a_warning(write: Write, keys: dict[str, str | None], report: str) -> None:
    with pytest.warns(FileWarning) as caught:
        assert load_map(write(**keys)).cells.size
    assert [report in str(each.message) for each in caught] == [True]


@pytest.mark.parametrize(
    ("keys", "same_as"),
    [
        ({"mode": "Trinary"}, {}),
        ({"mode": "RAW"}, {"mode": "raw"}),
        ({"negate": "no"}, {}),
        ({"negate": "Yes"}, {"negate": "1"}),
        ({"negate": "true"}, {"negate": "1"}),
        ({"negate": "7"}, {"negate": "1"}),
        ({"resolution": "'0.5'", "occupied_thresh": "'.65'", "origin": "['0', 0, '0.0']"}, {}),
    ],
)
def test_values_are_converted_as_map_io_does(
    write: Write, keys: dict[str, str | None], same_as: dict[str, str | None]
) -> None:
    found, plain = load_map(write(**keys)), load_map(write(**same_as))
    assert found.cells.tolist() == plain.cells.tolist()
    assert found._replace(cells=plain.cells, occupied=plain.occupied) == plain


def test_thresholds_that_cross_leave_nothing_between(write: Write) -> None:
    with pytest.warns(FileWarning):
        cells = load_map(write(mode="scale", free_thresh="0.65")).cells
    assert set(cells.ravel().tolist()) == {0, 100}


@pytest.mark.parametrize(("image", "report"), BROKEN)
def test_a_broken_image_is_reported_at_the_key_that_names_it(write: Write, image: bytes, report: str) -> None:
    with pytest.raises(DocumentError) as caught:
        load_map(write(image))
    assert f"map.yaml:1:8: image: 'map.pgm' cannot be read: {report[:10]}" in str(caught.value)
    assert report in str(caught.value)


def test_a_map_of_noise_is_refused(write: Write, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "MOST_PIECES", 7)
    path = write().parent / "world.yaml"
    path.write_text("world: {}\nmap: {yaml: map.yaml}")
    with pytest.raises(DocumentError, match=r"world\.yaml:2:6: map: 8 pieces of wall, at most 7: is the map all noise"):
        load_world(path)


def test_a_map_that_is_a_folder_is_reported_at_the_key_that_names_it(write: Write) -> None:
    path = write().parent / "world.yaml"
    path.write_text("map: {yaml: ''}")
    with pytest.raises(DocumentError, match=r"world\.yaml:1:13: map\.yaml: .*cannot be read: it is a folder"):
        load_world(path)


def test_what_is_wrong_with_a_map_is_told_beside_the_rest(write: Write) -> None:
    path = write(b"P5 0 0 255\n").parent / "world.yaml"
    path.write_text("map: {yaml: map.yaml}\nrobots: [{name: 7, pose: [0, 0]}]\nworld: {rtf: fast}")
    assert len(check_world(path).errors) == 2
    path.write_text("map: {yaml: map.yaml}\nrobots: [{name: '7', pose: [0, 0]}]")
    first, second = check_world(path).errors
    assert "map.yaml:1:8: image:" in str(first)
    assert "world.yaml:2:17: robots[0].name: '7' is not a name" in str(second)


# --- images ---------------------------------------------------------------------------------------------------


def read(tmp_path: Path, image: bytes) -> Image:
    (tmp_path / "image").write_bytes(image)
    return read_image(tmp_path / "image")


@pytest.mark.parametrize(
    "image",
    [
        b"P5 3 1 255 \x00\x80\xff",
        b"P5\n# by hand\n3 1\n# largest\n255\n\x00\x80\xff",
        b"P5 3 1 255 # a comment that ends the header\n\x00\x80\xff",
        b"P5 3 1 65535\n\x00\x00\x80\x80\xff\xff",
        b"P2 3 1 255\n0 128 255\n",
        b"P2\n3 1 255\n# row\n0 # none\n128 255 7 7",
        b"P2 3 1 65535 0 32896 65535",
    ],
)
def test_pgm_images_of_each_kind(tmp_path: Path, image: bytes) -> None:
    assert read(tmp_path, image).shades.tolist() == [[0, 128, 255]]


def test_the_bytes_after_a_header_are_pixels_even_if_they_look_like_spaces(tmp_path: Path) -> None:
    assert read(tmp_path, b"P5 3 1 255\n\n #").shades.tolist() == [[10, 32, 35]]


def chunk(kind: bytes, body: bytes) -> bytes:
    return len(body).to_bytes(4, "big") + kind + body + zlib.crc32(kind + body).to_bytes(4, "big")


def png(width: int, height: int, depth: int, colour: int, lines: bytes, *more: bytes, interlaced: int = 0) -> bytes:
    header = width.to_bytes(4, "big") + height.to_bytes(4, "big") + bytes([depth, colour, 0, 0, interlaced])
    packed = zlib.compress(lines)
    parts = [chunk(b"IHDR", header), *more, chunk(b"IDAT", packed[:5]), chunk(b"IDAT", packed[5:]), chunk(b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


PALETTE = chunk(b"PLTE", bytes([0, 0, 0, 255, 255, 255, 255, 0, 0]))


@pytest.mark.parametrize(
    ("image", "shades", "clear"),
    [
        (png(3, 1, 8, 0, b"\0\x00\x80\xff"), [0, 128, 255], None),
        (png(3, 1, 1, 0, b"\0\xa0"), [255, 0, 255], None),
        (png(3, 1, 2, 0, b"\0\x1b"), [0, 85, 170], None),
        (png(3, 1, 4, 0, b"\0\x0f\x70"), [0, 255, 119], None),
        (png(2, 1, 16, 0, b"\0\x80\x80\xff\xff"), [128, 255], None),
        (png(2, 1, 8, 2, b"\0\xff\x00\x00\x07\x07\x07"), [77, 7], None),
        (png(2, 1, 8, 4, b"\0\x05\xff\x06\xfe"), [5, 6], [False, True]),
        (png(2, 1, 8, 6, b"\0\x05\x05\x05\xff\x06\x06\x06\x00"), [5, 6], [False, True]),
        (png(2, 1, 16, 4, b"\0\x05\x05\xff\xff\x06\x06\xff\xfe"), [5, 6], [False, True]),
        (png(3, 1, 8, 3, b"\0\x00\x01\x02", PALETTE), [0, 255, 77], None),
        (png(3, 1, 2, 3, b"\0\x18", PALETTE, chunk(b"tRNS", b"\xff\x00")), [0, 255, 77], [False, True, False]),
        (png(2, 1, 8, 0, b"\0\x05\x06", chunk(b"tRNS", b"\x00\x06")), [5, 6], [False, True]),
    ],
)
def test_png_images_of_each_kind(tmp_path: Path, image: bytes, shades: list[int], clear: list[bool] | None) -> None:
    found = read(tmp_path, image)
    assert found.shades.tolist() == [shades]
    assert (None if found.transparent is None else found.transparent.tolist()) == (None if clear is None else [clear])


def paeth(left: int, up: int, corner: int) -> int:
    return min((left, up, corner), key=lambda each: abs(left + up - corner - each))


def filtered(kinds: list[int], image: npt.NDArray[np.uint8], size: int) -> bytes:
    """Filter lines of bytes as a PNG writer would, byte by byte; line n by the filter kinds[n]."""
    height, width = image.shape
    at = {(y, x): int(image[y, x]) for y in range(height) for x in range(width)}
    lines = b""
    for y, kind in enumerate(kinds):
        line = bytearray()
        for x in range(width):
            left, up, corner = at.get((y, x - size), 0), at.get((y - 1, x), 0), at.get((y - 1, x - size), 0)
            line.append((at[y, x] - (0, left, up, (left + up) // 2, paeth(left, up, corner))[kind]) % 256)
        lines += bytes([kind, *line])
    return lines


@given(st.data(), st.integers(1, 6), st.integers(1, 6), st.sampled_from([(0, 8, 1), (2, 8, 3), (6, 8, 4), (0, 16, 2)]))
@settings(deadline=None)
def test_all_filters_are_undone(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject, width: int, height: int, kind: tuple[int, int, int]
) -> None:
    colour, depth, size = kind
    image = data.draw(arrays.arrays(np.uint8, (height, width * size)))
    kinds = data.draw(st.lists(st.integers(0, 4), min_size=height, max_size=height))
    folder = tmp_path_factory.getbasetemp()
    plain = read(folder, png(width, height, depth, colour, filtered([0] * height, image, size)))
    again = read(folder, png(width, height, depth, colour, filtered(kinds, image, size)))
    assert again.shades.tolist() == plain.shades.tolist()
    if size == 1:
        assert plain.shades.tolist() == image.tolist()


@pytest.mark.parametrize(
    ("image", "report"),
    [
        (png(2, 1, 8, 0, b"\0\x01\x02", interlaced=1), "an interlaced PNG: save it without interlacing"),
        (png(2, 1, 3, 0, b"\0\x01\x02"), "no kind of PNG that there is: 3 bits of colour type 0"),
        (png(2, 1, 8, 1, b"\0\x01\x02"), "no kind of PNG that there is: 8 bits of colour type 1"),
        (png(2, 1, 8, 0, b"\5\x01\x02"), "no filter has the number 5"),
        (png(2, 2, 8, 0, b"\0\x01\x02\0"), "it ends too early: 1 of 2 lines"),
        (png(20_000, 20_000, 8, 0, b""), "20000 x 20000 pixels"),
        (png(1, 1, 8, 3, b"\0\x03", PALETTE), "colour 3 of a palette of 3"),
        (png(1, 1, 8, 3, b"\0\x03"), "colour 3 of a palette of 0"),
        (png(2, 1, 8, 0, b"\0\x01\x02")[:-20], "it ends too early"),
        (png(2, 1, 8, 0, b"\0\x01\x02").replace(b"IDAT", b"IDAX", 1), "a wrong checksum at byte 33"),
        (b"\x89PNG\r\n\x1a\n" + chunk(b"IEND", b""), "a PNG without its header"),
    ],
)
def test_broken_png_images_are_reported(tmp_path: Path, image: bytes, report: str) -> None:
    with pytest.raises(ImageError) as caught:
        read(tmp_path, image)
    assert report in str(caught.value)


SOME = [png(3, 2, 8, 2, bytes(20)), png(9, 2, 1, 3, bytes(6), PALETTE), b"P5 3 2 255\n" + bytes(6), b"P2 2 1 9\n1 2\n"]


@given(
    st.sampled_from(SOME),
    st.lists(st.tuples(st.integers(0, 200), st.integers(0, 255)), max_size=4),
    st.integers(0, 200),
)
@settings(deadline=None)
def test_damaged_images_are_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, image: bytes, changes: list[tuple[int, int]], length: int
) -> None:
    damaged = bytearray(image)
    for at, value in changes:
        damaged[at % len(damaged)] = value
    try:
        found = read(tmp_path_factory.getbasetemp(), bytes(damaged[: length or None]))
    except ImageError:
        return
    assert found.shades.dtype == np.uint8


def test_a_grid_knows_its_cells_at_any_yaw() -> None:
    rng = np.random.default_rng(5)
    cells = rng.random((6, 4)) < 0.5
    grid = GridMap(cells.astype(np.int8), cells, 0.25, Pose(1.0, -2.0, 0.7))
    for row, column in np.ndindex(6, 4):
        x, y = (column + 0.5) * 0.25, (row + 0.5) * 0.25
        cos, sin = math.cos(0.7), math.sin(0.7)
        assert grid.is_occupied(1.0 + cos * x - sin * y, -2.0 + sin * x + cos * y) == cells[row, column]
