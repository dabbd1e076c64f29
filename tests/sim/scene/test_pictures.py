"""Picture files: read as colours, and refused with a reason if they are none."""

from __future__ import annotations

import os
import struct
import sys
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.image.codecs import png_of
from robolink.sim.maps.image import ImageError
from robolink.sim.scene import pictures
from robolink.sim.scene.pictures import cached_picture, read_picture

GREEN = np.tile(np.array([10, 200, 30], np.uint8), (3, 4, 1))


@pytest.fixture
def saved(tmp_path: Path) -> str:
    """Path of a picture of 4 x 3 green pixels."""
    path = tmp_path / "green.png"
    path.write_bytes(png_of(GREEN))
    return str(path)


def read(tmp_path: Path, content: bytes) -> np.ndarray:
    (tmp_path / "p").write_bytes(content)
    return read_picture(str(tmp_path / "p"))


def chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def png(width: int, height: int, kind: int, rows: bytes, *chunks: tuple[bytes, bytes], depth: int = 8) -> bytes:
    """A PNG file made by hand."""
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, 0))
    middle = b"".join(chunk(*each) for each in chunks)
    return b"\x89PNG\r\n\x1a\n" + head + middle + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def test_a_png_is_read_as_red_green_and_blue(saved: str) -> None:
    picture = read_picture(saved)
    np.testing.assert_array_equal(picture, GREEN)
    assert not picture.flags.writeable
    assert read_picture(saved) is picture


def test_a_changed_file_is_read_again(saved: str) -> None:
    before = read_picture(saved)
    Path(saved).write_bytes(png_of(GREEN + 1))
    os.utime(saved, ns=(1, 1))
    assert (read_picture(saved) == before + 1).all()


def test_a_picture_whose_file_has_gone_is_kept_for_the_world_that_runs(saved: str) -> None:
    with pytest.raises(FileNotFoundError):
        cached_picture(saved + "x")
    before = read_picture(saved)
    Path(saved).write_bytes(b"no picture")
    with pytest.raises(ImageError):
        read_picture(saved)
    assert cached_picture(saved) is before
    Path(saved).unlink()
    assert cached_picture(saved) is before


def test_few_pictures_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pictures, "MOST_CACHED", 2)
    paths = [str(tmp_path / f"{each}.png") for each in range(3)]
    for path in paths:
        Path(path).write_bytes(png_of(GREEN))
    first, *_ = (read_picture(each) for each in paths)
    assert set(pictures._known) == set(paths[1:])
    assert read_picture(paths[0]) is not first
    assert read_picture(paths[2]) is read_picture(paths[2])


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("channels", [1, 3, 4])
def test_every_kind_of_png_is_read(tmp_path: Path, dtype: type, channels: int) -> None:
    largest = np.iinfo(dtype).max
    numbers = np.random.default_rng(0).integers(0, largest, (5, 7, channels), endpoint=True)
    image: np.ndarray = numbers.astype(dtype)
    if channels == 4:
        image[..., 3] = largest
    picture = read(tmp_path, png_of(image[..., 0] if channels == 1 else image))
    expected = np.round(image[..., : min(channels, 3)] * (255.0 / largest))
    np.testing.assert_array_equal(picture, np.broadcast_to(expected, (5, 7, 3)))


def test_what_is_transparent_is_white(tmp_path: Path) -> None:
    image = np.array([[[255, 0, 0, 255], [255, 0, 0, 0], [255, 0, 0, 128]]], np.uint8)
    assert read(tmp_path, png_of(image)).tolist() == [[[255, 0, 0], [255, 255, 255], [255, 127, 127]]]


def test_a_palette_has_colours_and_transparent_ones(tmp_path: Path) -> None:
    palette = (b"PLTE", bytes([1, 2, 3, 40, 50, 60]))
    content = png(2, 1, 3, b"\0\0\1", palette, (b"tRNS", b"\xff\0"))
    assert read(tmp_path, content).tolist() == [[[1, 2, 3], [255, 255, 255]]]
    with pytest.raises(ImageError, match="it is damaged: colour 2 of a palette of 2"):
        read(tmp_path, png(2, 1, 3, b"\0\0\2", palette))


def test_one_colour_can_be_transparent(tmp_path: Path) -> None:
    content = png(2, 1, 0, b"\0\7\x09", (b"tRNS", b"\0\7"))
    assert read(tmp_path, content).tolist() == [[[255] * 3, [9] * 3]]


def test_gray_is_read_from_pgm(tmp_path: Path) -> None:
    assert read(tmp_path, b"P5 2 1 255\n\x00\x80").tolist() == [[[0] * 3, [128] * 3]]


def test_jpeg_is_read_by_opencv(tmp_path: Path) -> None:
    cv2 = pytest.importorskip("cv2")
    large = np.tile(np.array([10, 200, 30], np.uint8), (32, 48, 1))
    _, encoded = cv2.imencode(".jpg", large[:, :, ::-1])
    picture = read(tmp_path, encoded.tobytes())
    assert picture.shape == large.shape
    assert np.abs(picture.astype(int) - large).max() < 4


JPEG = b"\xff\xd8\xff\xe0\x00\x04ab\xff\xc0\x00\x0b\x08%s\x01\x01\x11\x00"


def test_jpeg_without_opencv_tells_what_to_do(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(ImageError, match="JPEG needs OpenCV: pip install opencv-python-headless, or save it as PNG"):
        read(tmp_path, JPEG % b"\x00\x10\x00\x10")


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "no PNG, JPEG or PGM: save it as PNG"),
        (b"GIF89a", "no PNG, JPEG or PGM: save it as PNG"),
        (png_of(GREEN)[:-20], "it ends too early"),
        (png_of(GREEN).replace(b"IHDR", b"IHDX"), "it is damaged: a wrong checksum"),
        (png(3000, 3000, 2, b""), "3000 x 3000 pixels: at most 8 million"),
        (png(2**31, 2**31, 2, b""), "pixels: at most 8 million"),
        (b"P5 4000 3000 255\n" + bytes(12_000_000), "4000 x 3000 pixels: at most 8 million"),
        (JPEG % b"\xff\xff\xff\xff", "65535 x 65535 pixels: at most 8 million"),
        (b"\xff\xd8\xff\xe0\x00\x00", "it is damaged: a JPEG without its size"),
        (b"\xff\xd8\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff", "it is damaged: a JPEG without its size"),
    ],
)
def test_what_is_no_picture_is_refused_with_a_reason(tmp_path: Path, content: bytes, reason: str) -> None:
    with pytest.raises(ImageError, match=reason):
        read(tmp_path, content)


def test_a_damaged_jpeg_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("cv2")
    with pytest.raises(ImageError, match="it is damaged: OpenCV cannot decode this JPEG"):
        read(tmp_path, JPEG % b"\x00\x10\x00\x10")


@given(st.binary(max_size=60), st.sampled_from([b"", b"\x89PNG\r\n\x1a\n", b"P5", b"\xff\xd8\xff", JPEG[:8]]))
def test_any_bytes_are_a_picture_or_an_image_error(content: bytes, start: bytes) -> None:
    try:
        picture = pictures._decoded(start + content)
    except ImageError:
        return
    assert picture.ndim == 3
