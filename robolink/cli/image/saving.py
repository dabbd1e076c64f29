"""Files of images for `robolink image save`: PNG by robolink itself, JPEG by OpenCV, compressed images as they came."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from robolink.cli.shared.output import say
from robolink.exceptions import RobolinkError
from robolink.image import to_array
from robolink.image.codecs import encoded
from robolink.image.conversion import Pixels, convert
from robolink.image.encodings import ImageError, encoding_of, encoding_of_array
from robolink.image.opencv import opencv
from robolink.image.png import png_of
from robolink.interfaces.sensor_msgs.msg import CompressedImage
from robolink.system.terminal import shown

PNG, JPEG = (".png",), (".jpg", ".jpeg")
_STARTS = {PNG: b"\x89PNG", JPEG: b"\xff\xd8"}
_DEEPEST = 65535
_MILLIMETRES = 1000


class SaveError(RobolinkError, ValueError):
    """An image that cannot be saved under such a name."""


class Files:
    """Files to be written, one after the other.

    Args:
        pattern: Path of a file, in which {} stands for the number, from 1.
        count: Number of files.

    Raises:
        SaveError: if the name is not an image's, lacks {} for several, or its folder is not there.
        ImageError: for a .jpg without OpenCV.
    """

    def __init__(self, pattern: str, count: int) -> None:
        suffix = Path(pattern).suffix.lower()
        if suffix not in PNG + JPEG:
            raise SaveError(f"'{pattern}' is not an image that can be saved: end its name in .png or .jpg")
        if count > 1 and "{}" not in pattern:
            raise SaveError(f"'{pattern}' is one file, not {count}: write {{}} where the number shall be")
        folder = Path(pattern).absolute().parent
        if "{}" not in str(folder) and not folder.is_dir():
            raise SaveError(f"no folder '{folder}' to write '{Path(pattern).name}' to")
        self.kind = PNG if suffix in PNG else JPEG
        if self.kind is JPEG:
            opencv("JPEG")
        self.pattern, self.written = pattern, 0

    def save(self, message: Any) -> None:
        """Write an image to the next file, and name it.

        Args:
            message: An Image or a CompressedImage.

        Raises:
            SaveError: if the file cannot be written.
            ImageError: for an image that contradicts itself, or that no file can hold.
        """
        self.written += 1
        path = Path(self.pattern.replace("{}", f"{self.written:04d}"))
        data = _file_of(message, self.kind)
        try:
            path.write_bytes(data)
        except OSError as error:
            raise SaveError(f"{path}: cannot be written: {error.strerror or error}") from None
        say(str(path))


def _file_of(message: Any, kind: tuple[str, ...]) -> bytes:
    if isinstance(message, CompressedImage):
        data = bytes(message.data)
        if data.startswith(_STARTS[kind]):
            return data
        image = to_array(message)
        encoding = {1: "mono", 3: "bgr", 4: "bgra"}[encoding_of_array(image).channels] + str(8 * image.itemsize)
    else:
        image, encoding = to_array(message), message.encoding
    if not image.size:
        raise ImageError("the image is empty")
    return png_of(_for_png(image, encoding)) if kind is PNG else encoded(_for_jpeg(image, encoding), "jpg")


def _for_png(image: Pixels, encoding: str) -> Pixels:
    """Return an image with red first, of 8 or 16 bits; metres as millimetres, and 0 for what is not finite."""
    found = encoding_of(encoding)
    if found.colours:
        if found.colours in ("mono", "rgb", "rgba"):
            return image
        deep = found.bits if "bayer" not in found.colours else 8
        return convert(image, encoding, f"{'rgba' if found.colours == 'bgra' else 'rgb'}{deep}")
    if found.cv_type == "32FC1":
        metres = np.where(np.isfinite(image), image, np.float32(0.0))
        near = np.clip(metres, np.float32(0.0), np.float32(_DEEPEST / _MILLIMETRES + 1))  # 3e38 would overflow
        whole: Pixels = np.clip(np.rint(near * np.float32(_MILLIMETRES)), 0, _DEEPEST).astype(np.uint16)
        return whole
    if found.depth in ("8U", "16U") and found.channels in (1, 3, 4):
        return image if found.channels == 1 else image[..., [2, 1, 0, 3][: found.channels]]
    raise ImageError(f"no image file holds {shown(encoding, 40)}: convert it in a program (robolink.image)")


def _for_jpeg(image: Pixels, encoding: str) -> Pixels:
    found = encoding_of(encoding)
    if not found.colours and found.cv_type in ("8UC1", "8UC3"):
        return image
    if not found.colours:
        raise ImageError(f"a JPEG holds no {shown(encoding, 40)}: save it as .png")
    return convert(image, encoding, "mono8" if found.colours == "mono" else "bgr8")
