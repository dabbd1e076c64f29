"""Publishers of a simulated camera: images, depths and calibration; an image is rendered only if somebody wants it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeAlias

from robolink.image import to_message
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.sensor_msgs.msg import CameraInfo, CompressedImage, Image
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import encode
from robolink.publisher import Publisher
from robolink.sim import Shot
from robolink.sim.sensors import Camera
from robolink.world_node.compression import Compression
from robolink.world_node.messages import camera_info_message, camera_transforms
from robolink.world_node.prepared import PreparedImage, Stamp

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
    def is_wanted(self) -> bool:
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
