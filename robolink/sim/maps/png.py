"""Reader of PNG images: every colour type and depth, all five filters, no interlacing.

The format is W3C's Portable Network Graphics (third edition).
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.sim.maps.image import Image, ImageError, Shades, check_size, eight_bits, in_blocks

SIGNATURE = b"\x89PNG\r\n\x1a\n"
LUMA = (77, 150, 29)
"""Weights of red, green and blue in luma, of 256 (ITU-R BT.601: 0.299, 0.587, 0.114), as map_server's library."""

MOST_CHUNKS = 100_000
"""Most chunks of a file: 50 MB usually have 6,000."""

_GRAY, _RGB, _PALETTE, _GRAY_ALPHA, _RGBA = 0, 2, 3, 4, 6
_CHANNELS = {_GRAY: 1, _RGB: 3, _PALETTE: 1, _GRAY_ALPHA: 2, _RGBA: 4}
_DEPTHS = {_GRAY: (1, 2, 4, 8, 16), _PALETTE: (1, 2, 4, 8)}
_SOME_DEPTHS = (8, 16)
_PAETH = 4
_NOTHING = memoryview(b"")


class _Header(NamedTuple):
    width: int
    height: int
    depth: int
    colour: int
    compression: int
    filtering: int
    interlacing: int

    @property
    def line(self) -> int:
        """Number of bytes of a line of pixels."""
        return (self.width * _CHANNELS[self.colour] * self.depth + 7) // 8


class _Content(NamedTuple):
    """A PNG file: samples of each pixel (line, column, channel), the palette, and what of them is transparent."""

    header: _Header
    samples: npt.NDArray[Any]
    palette: memoryview
    clear: npt.NDArray[np.uint8]


def _content(raw: bytes) -> _Content:
    chunks: dict[bytes, list[memoryview]] = {}
    for kind, body in _chunks(memoryview(raw)):
        chunks.setdefault(kind, []).append(body)
    header = _header(chunks.get(b"IHDR", [_NOTHING])[0])
    samples = _samples(header, _lines(header, chunks.get(b"IDAT", [])))
    clear = np.frombuffer(chunks.get(b"tRNS", [_NOTHING])[0], np.uint8)
    return _Content(header, samples, chunks.get(b"PLTE", [_NOTHING])[0], clear)


def read_png(raw: bytes) -> Image:
    """Read a PNG file's bytes as shades of gray. Raises `ImageError`."""
    header, samples, palette, clear = _content(raw)
    if header.colour == _PALETTE:
        return _from_palette(samples[..., 0], palette, clear)
    transparent = None
    if header.colour in (_GRAY_ALPHA, _RGBA):
        transparent = samples[..., -1] < 2**header.depth - 1
        samples = samples[..., :-1]
    elif len(clear) == 2 * samples.shape[2]:  # one colour that stands for nothing
        transparent = np.all(samples == clear.view(">u2"), axis=2)
    largest = 2**header.depth - 1
    return Image(in_blocks(lambda block: _shades(eight_bits(block, largest)), samples), transparent)


def read_png_colours(raw: bytes) -> Shades:
    """Read a PNG file's bytes as red, green and blue (line, column, channel), on white where it is transparent.

    Raises `ImageError`.
    """
    header, samples, palette, clear = _content(raw)
    if header.colour == _PALETTE:
        painted: Shades = _coloured(palette, clear)[_index(samples[..., 0], palette)]
        return painted
    largest = 2**header.depth - 1
    seen = None
    if header.colour in (_GRAY_ALPHA, _RGBA):
        seen, samples = eight_bits(samples[..., -1], largest), samples[..., :-1]
    elif len(clear) == 2 * samples.shape[2]:
        seen = np.where(np.all(samples == clear.view(">u2"), axis=2), 0, 255).astype(np.uint8)
    colours = np.broadcast_to(eight_bits(samples, largest), (header.height, header.width, 3))
    return np.ascontiguousarray(colours) if seen is None else on_white(colours, seen[..., None])


def on_white(colours: Shades, seen: Shades) -> Shades:
    """Return colours as they are on white, where `seen` is 0 for transparent to 255 for opaque."""
    opaque = seen.astype(np.uint16)
    mixed: Shades = ((colours * opaque + 255 * (255 - opaque) + 127) // 255).astype(np.uint8)
    return mixed


def _coloured(palette: memoryview, clear: npt.NDArray[np.uint8]) -> Shades:
    """Return the colours of a palette, on white."""
    colours = np.frombuffer(palette, np.uint8, count=len(palette) // 3 * 3).reshape(-1, 3)
    seen = np.full((len(colours), 1), 255, np.uint8)
    seen[: len(clear), 0] = clear[: len(colours)]
    return on_white(colours, seen)


def _index(index: npt.NDArray[Any], palette: memoryview) -> npt.NDArray[Any]:
    """Return the places of pixels in a palette, all of which there are."""
    if int(index.max()) >= len(palette) // 3:
        raise ImageError(f"it is damaged: colour {index.max()} of a palette of {len(palette) // 3}")
    return index


def _chunks(raw: memoryview) -> Iterator[tuple[bytes, memoryview]]:
    """Yield the parts of the file, each with its kind."""
    at = len(SIGNATURE)
    for _ in range(MOST_CHUNKS):
        if bytes(raw[at + 4 : at + 8]) == b"IEND":
            return
        if len(raw) < at + 12 or len(raw) < (end := at + 12 + int.from_bytes(raw[at : at + 4], "big")):
            raise ImageError("it ends too early")
        if zlib.crc32(raw[at + 4 : end - 4]) != int.from_bytes(raw[end - 4 : end], "big"):
            raise ImageError(f"it is damaged: a wrong checksum at byte {at}")
        yield bytes(raw[at + 4 : at + 8]), raw[at + 8 : end - 4]
        at = end
    raise ImageError(f"more than {MOST_CHUNKS:,} chunks")


def _header(body: memoryview) -> _Header:
    if len(body) != 13:
        raise ImageError("a PNG without its header")
    header = _Header(*struct.unpack(">IIBBBBB", body))
    known = header.colour in _CHANNELS and header.depth in _DEPTHS.get(header.colour, _SOME_DEPTHS)
    check_size(header.width, header.height, header.depth * _CHANNELS[header.colour] if known else 1)
    if not known or header.compression or header.filtering:
        raise ImageError(f"no kind of PNG that there is: {header.depth} bits of colour type {header.colour}")
    if header.interlacing:
        raise ImageError("an interlaced PNG: save it without interlacing")
    return header


def _unpacked(packed: Sequence[memoryview], size: int) -> bytes:
    """Unpack at most `size` bytes, however much is packed there."""
    reader, parts, left = zlib.decompressobj(), [], size
    try:
        for each in packed:
            if left > 0:
                parts.append(reader.decompress(each, left))
                left -= len(parts[-1])
    except zlib.error as error:
        raise ImageError(f"it is damaged: {error}") from None
    return parts[0] if len(parts) == 1 else b"".join(parts)


def _lines(header: _Header, packed: Sequence[memoryview]) -> npt.NDArray[np.uint8]:
    """Unpack the lines of pixels, as bytes, and undo their filters."""
    size = header.height * (header.line + 1)
    unpacked = _unpacked(packed, size)
    if len(unpacked) < size:
        raise ImageError(f"it ends too early: {len(unpacked) // (header.line + 1)} of {header.height} lines")
    lines = np.frombuffer(unpacked, np.uint8).reshape(header.height, header.line + 1)
    if lines[:, 0].max() > _PAETH:
        raise ImageError(f"it is damaged: no filter has the number {lines[:, 0].max()}")
    pixel = max(1, _CHANNELS[header.colour] * header.depth // 8)
    return unfiltered(lines[:, 0], lines[:, 1:].reshape(header.height, -1, pixel)).reshape(header.height, -1)


def unfiltered(kinds: npt.NDArray[np.uint8], lines: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Undo the filters: add to each byte (line, column, byte) the prediction of its line's filter.

    A pixel needs those at its left, above and in the corner between. So each step does one pixel of each line, and
    each line is one column behind the line above it.
    """
    if not kinds.any():
        return lines
    height, width, size = lines.shape
    result = np.empty_like(lines)
    last = np.zeros((height + 1, size), np.int16)  # the pixel of each line in the step before; above the first is 0
    before = last.copy()  # and in the step before that
    for step in range(width + height - 1):
        first, end = max(0, step - width + 1), min(height, step + 1)
        rows = np.arange(first, end)
        foretold = _foretold(kinds[first:end, None], last[first + 1 : end + 1], last[first:end], before[first:end])
        pixels = lines[rows, step - rows] + foretold & 255
        result[rows, step - rows] = pixels
        before, last = last, last.copy()
        last[first + 1 : end + 1] = pixels
    return result


def _foretold(kinds: npt.NDArray[Any], left: npt.NDArray[Any], up: npt.NDArray[Any], corner: npt.NDArray[Any]) -> Any:
    """Return the predictions of filters 0 to 4: none, left, up, their average, and Paeth's choice of three."""
    to_left, to_up, to_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
    nearer = np.where(to_up <= to_corner, up, corner)
    paeth = np.where((to_left <= to_up) & (to_left <= to_corner), left, nearer)
    return np.choose(kinds, (np.zeros_like(left), left, up, (left + up) >> 1, paeth))


def _samples(header: _Header, lines: npt.NDArray[np.uint8]) -> npt.NDArray[Any]:
    """Split the lines' bytes into the samples of each pixel (line, column, channel)."""
    shape = (header.height, header.width, _CHANNELS[header.colour])
    if header.depth == 16:
        return np.ascontiguousarray(lines).view(">u2").reshape(shape)
    if header.depth == 8:
        return lines.reshape(shape)
    bits = np.unpackbits(lines, axis=1).reshape(header.height, -1, header.depth)[:, : header.width]
    weights = 1 << np.arange(header.depth - 1, -1, -1)
    values: npt.NDArray[Any] = (bits @ weights.astype(np.uint8)).reshape(shape)
    return values


def _from_palette(index: npt.NDArray[Any], palette: memoryview, clear: npt.NDArray[np.uint8]) -> Image:
    colours = np.frombuffer(palette, np.uint8, count=len(palette) // 3 * 3).reshape(-1, 3)
    index = _index(index, palette)
    opaque = np.full(256, 255, np.uint8)
    opaque[: len(clear)] = clear[:256]
    shades = _shades(colours)
    transparent = in_blocks(lambda block: opaque[block], index) < 255 if len(clear) else None
    return Image(in_blocks(lambda block: shades[block], index), transparent)


def _shades(colours: Shades) -> Shades:
    """Convert colours, whose channels come last, to shades of gray."""
    if colours.shape[-1] == 1:
        return colours[..., 0]
    red, green, blue = (colours[..., channel].astype(np.uint16) * weight for channel, weight in enumerate(LUMA))
    shades: Shades = ((red + green + blue + 128) >> 8).astype(np.uint8)
    return shades
