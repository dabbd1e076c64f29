"""The verbs of images: a subscription that waits for pictures, and files of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from robolink.cli.shared.graph import matching_qos
from robolink.cli.shared.messages import message_type
from robolink.cli.shared.output import say, tell
from robolink.cli.shared.session import node_of, opened
from robolink.context import Context
from robolink.exceptions import RobolinkError, nearest
from robolink.executors import SingleThreadedExecutor
from robolink.image import to_array
from robolink.image.codecs import encoded, png_of
from robolink.image.conversion import Pixels, convert
from robolink.image.encodings import ImageError, encoding_of, encoding_of_array
from robolink.image.opencv import opencv
from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image
from robolink.system import clocks
from robolink.system.terminal import shown
from robolink.task import Future
from robolink.wire import EndpointKind

REPORTED_AFTER = 2.0
"""Delay until a note that a topic is waited for, in seconds."""


class NoImageError(RobolinkError, TimeoutError):
    """No image came in time, or the topic has none."""


def each_image(topic: str, count: int | None, timeout: float | None, take: Callable[[Any], None]) -> None:
    """Call a function with each image of a topic.

    Args:
        topic: Name of the topic.
        count: So many images; None until Ctrl-C.
        timeout: Longest time without an image, in seconds; None waits for ever.
        take: The function.

    Raises:
        NoImageError: if the topic is of another type, or no image came in time. What `take` raises ends it, too.
    """
    with opened() as context:
        node = node_of(context)
        name = node.resolve_topic_name(topic)
        _wait_for(context, name, timeout)
        msg_type = message_type(context, name)
        if msg_type not in (Image, CompressedImage):
            raise NoImageError(f"{name} is of {msg_type.__ros_type__}, and holds no images")
        taker = _Taker(count, take)
        node.create_subscription(msg_type, name, taker.on_image, matching_qos(context, name))
        with SingleThreadedExecutor(context=context) as executor:
            executor.add_node(node)
            while not taker.done.done():
                before = taker.taken
                executor.spin_until_future_complete(taker.next, timeout_sec=timeout)
                if taker.taken == before and not taker.done.done():
                    if not context.ok():
                        raise KeyboardInterrupt
                    raise NoImageError(f"no image on {name} within {timeout or 0:g} s")
            taker.done.result()


class _Taker:
    """Receiver of images; `next` is done at each, `done` at the last or an error."""

    def __init__(self, count: int | None, take: Callable[[Any], None]) -> None:
        self.count, self.take, self.taken = count, take, 0
        self.next, self.done = Future[None](), Future[None]()

    def on_image(self, message: Any) -> None:
        """Take an image, unless there were enough. An error ends the command, not only the callback."""
        if self.done.done():
            return
        self.taken += 1
        try:
            self.take(message)
            if self.taken == self.count:
                self.done.set_result(None)
        except (RobolinkError, OSError) as error:
            self.done.set_exception(error)
        ended, self.next = self.next, Future[None]()
        ended.set_result(None)


def _wait_for(context: Context, name: str, timeout: float | None) -> None:
    """Wait until somebody publishes the topic. Raises NoImageError after the timeout, and KeyboardInterrupt."""
    graph, begin, reported = context.graph, clocks.monotonic(), False

    def published() -> bool:
        return bool(graph.endpoints(EndpointKind.PUBLISHER, name=name)) or not context.ok()

    while not published():
        spent = clocks.monotonic() - begin
        if timeout is not None and spent >= timeout:
            near = nearest(name, {each.name for each in graph.endpoints(EndpointKind.PUBLISHER)})
            raise NoImageError(f"nobody publishes {name}{near}, and {timeout:g} s have passed")
        graph.wait_for(published, 0.5 if timeout is None else min(0.5, timeout - spent))
        if not reported and clocks.monotonic() - begin > REPORTED_AFTER:
            tell(f"waiting for somebody to publish {name}")
            reported = True
    if not context.ok():
        raise KeyboardInterrupt


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
