"""Topics of a camera: its images, taken in a thread of their own, and their compression."""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Callable, Iterator
from queue import SimpleQueue
from typing import Any, TypeAlias

from robolink.exceptions import InvalidHandle
from robolink.image import ImageError, to_message
from robolink.image.codecs import encoded
from robolink.image.conversion import convert
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.sensor_msgs.msg import CameraInfo, CompressedImage, Image
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import encode
from robolink.publisher import Publisher
from robolink.sim import Shot
from robolink.sim.sensors import Camera
from robolink.system import waits
from robolink.world_node.messages import camera_info_message, camera_transforms
from robolink.world_node.prepared import PreparedImage, Stamp


class Compression:
    """Makes compressed images; if that fails, it says so once, and makes none.

    Args:
        warn: Function that is called with the one line.
    """

    def __init__(self, warn: Callable[[str], object]) -> None:
        self._warn, self._works = warn, True

    def message(self, image: Any, encoding: str, header: Header) -> CompressedImage | None:
        """Return an image as a JPEG, with the format that image_transport names; None if that cannot be done.

        Args:
            image: Pixels (rows, columns) or (rows, columns, channels).
            encoding: Encoding of the pixels.
            header: Stamp and frame.
        """
        if not self._works:
            return None
        grey = encoding == "mono8"
        try:
            data = encoded(image if grey else convert(image, encoding, "bgr8"), "jpg")
        except ImageError as error:
            self._works = False
            self._warn(f"no compressed images: {error}")
            return None
        form = f"{encoding}; jpeg compressed {'mono8' if grey else 'bgr8'}"
        return CompressedImage(header=header, format=form, data=data)


MOST = 10
"""Number of jobs with one key that may wait: a short stall loses nothing."""


class Darkroom:
    """Works off jobs in their order, on one thread, which begins with the first.

    Args:
        warn: Function that is called with a line about what went wrong.
    """

    def __init__(self, warn: Callable[[str], object]) -> None:
        self._warn = warn
        self._jobs: SimpleQueue[tuple[object, Callable[[], object]] | None] = SimpleQueue()
        self._waiting: Counter[object] = Counter()
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None

    def submit(self, key: object, job: Callable[[], object]) -> bool:
        """Put a job in the queue; return False, and do nothing, if `MOST` with this key are waiting."""
        with self._lock:
            if self._waiting[key] >= MOST:
                return False
            self._waiting[key] += 1
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name="robolink images", daemon=True)
            self._thread.start()
        self._jobs.put((key, job))
        return True

    def close(self) -> None:
        """Do what has been submitted, and end the thread. Safe to call twice."""
        thread, self._thread = self._thread, None
        if thread is not None:
            self._jobs.put(None)
            waits.join(thread)

    def _work(self) -> None:
        while (found := self._jobs.get()) is not None:
            key, job = found
            try:
                job()
            except (InvalidHandle, ConnectionError):
                pass  # the robot has left, or the network, since the shot was taken
            except Exception as error:  # noqa: BLE001 - whatever it is, it is told, and later images are rendered
                self._warn(f"an image could not be published: {type(error).__name__}: {error}")
            finally:
                with self._lock:
                    self._waiting[key] -= 1


MakePublisher: TypeAlias = "Callable[[type[Any], str], Publisher[Any]]"

_HEAD, _STAMP = 4, 8
"""Sizes in bytes of the encapsulation header of a payload and of a stamp."""


class CameraTopics:
    """The topics of one camera.

    Args:
        camera: The camera.
        prefix: Prefix of its frames.
        publisher: Function that makes a publisher of a type and a topic.
        always: True: render also what nobody listens to, but for compressed images.
        compression: Compression of images.
    """

    def __init__(
        self, camera: Camera, prefix: str, publisher: MakePublisher, *, always: bool, compression: Compression
    ) -> None:
        self._camera, self._always, self._prefix, self._compression = camera, always, prefix, compression
        self.frame = f"{prefix}{camera.topic}_optical_frame"
        self._info_begin = encode(camera_info_message(Header(frame_id=self.frame), camera))[_HEAD + _STAMP :]
        self._image = publisher(Image, f"{camera.topic}/image_raw")
        self._compressed = publisher(CompressedImage, f"{camera.topic}/image_raw/compressed")
        self._infos = [publisher(CameraInfo, f"{camera.topic}/camera_info")]
        self._depth: Publisher[Any] | None = None
        if camera.depth:
            self._depth = publisher(Image, f"{camera.topic}/depth/image_raw")
            self._infos.append(publisher(CameraInfo, f"{camera.topic}/depth/camera_info"))
        self._prepared: dict[str, PreparedImage] = {}

    def publish_infos(self, stamp: Stamp) -> None:
        """Publish the calibration, heard or not."""
        for each in self._infos:
            each.publish(stamp.beginning + self._info_begin)

    @property
    def is_needed(self) -> bool:
        """True if an image, compressed or of depths, is to be rendered."""
        return self._wants(self._image) or self._wants(self._depth) or self._wants_compressed

    @property
    def _wants_compressed(self) -> bool:
        return self._compressed.get_subscription_count() > 0  # not what only records: OpenCV's versions differ

    def _wants(self, publisher: Publisher[Any] | None) -> bool:
        return publisher is not None and (self._always or publisher._is_heard_)

    def publish(self, shot: Shot, stamp: Stamp) -> None:
        """Publish what a shot shows to those who listen; this may be done on any thread."""
        if self._wants(self._image) or self._wants_compressed:
            encoding = self._camera.encoding
            image = shot.image()
            if self._wants(self._image):
                self._image.publish(self._payload(image, encoding, stamp))
            if self._wants_compressed:
                message = self._compression.message(image, encoding, Header(stamp=stamp.message, frame_id=self.frame))
                if message is not None:
                    self._compressed.publish(message)
        if self._depth is not None and self._wants(self._depth):
            self._depth.publish(self._payload(shot.depths(), "32FC1", stamp))

    def _payload(self, pixels: Any, encoding: str, stamp: Stamp) -> bytes:
        prepared = self._prepared.get(encoding)
        if prepared is None:
            message = to_message(pixels, encoding, Header(frame_id=self.frame))
            prepared = self._prepared[encoding] = PreparedImage(message)
        return prepared.payload(stamp, pixels)

    def transforms(self, stamp: Time, base: str) -> Iterator[TransformStamped]:
        """Yield the transforms of the camera on the robot's frame `base`, and of its optical frame."""
        link = f"{self._prefix}{self._camera.topic}_link"
        yield from camera_transforms(stamp, base, link, self.frame, self._camera)
