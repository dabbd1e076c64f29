"""Publishers of a simulated camera: images, depths and calibration; an image is rendered only if somebody wants it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeAlias

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.sensor_msgs.msg import CameraInfo, Image
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import encode
from robolink.publisher import Publisher
from robolink.sim import Shot
from robolink.sim.sensors import Camera
from robolink.world_node.messages import camera_info_message, camera_transforms, depth_message, image_message
from robolink.world_node.prepared import Stamp

MakePublisher: TypeAlias = "Callable[[type[Any], str], Publisher[Any]]"

_HEAD, _STAMP, _COUNT = 4, 8, 4
"""Sizes in bytes: the encapsulation header of a payload, a stamp, the count of a sequence."""


class CameraTopics:
    """The topics of one camera.

    Args:
        camera: The camera.
        prefix: What goes before its frames.
        publisher: Function that makes a publisher of a type and a topic.
        always: True: render also what nobody listens to.
    """

    def __init__(self, camera: Camera, prefix: str, publisher: MakePublisher, *, always: bool) -> None:
        self._camera, self._always, self._prefix = camera, always, prefix
        self.frame = f"{prefix}{camera.topic}_optical_frame"
        self._info_begin = encode(camera_info_message(Header(frame_id=self.frame), camera))[_HEAD + _STAMP :]
        self._image = publisher(Image, f"{camera.topic}/image_raw")
        self._infos = [publisher(CameraInfo, f"{camera.topic}/camera_info")]
        self._depth: Publisher[Any] | None = None
        if camera.depth:
            self._depth = publisher(Image, f"{camera.topic}/depth/image_raw")
            self._infos.append(publisher(CameraInfo, f"{camera.topic}/depth/camera_info"))

    def publish(self, shot: Shot, stamp: Stamp) -> None:
        """Publish what a shot shows, to those who listen."""
        for each in self._infos:
            each.publish(stamp.beginning + self._info_begin)
        header = Header(stamp=stamp.message, frame_id=self.frame)
        if self._always or self._image._is_heard_:
            self._image.publish(image_message(shot, header, self._camera))
        if self._depth is not None and (self._always or self._depth._is_heard_):
            self._depth.publish(depth_message(shot.depths(), header))

    def transforms(self, stamp: Time, base: str) -> Iterator[TransformStamped]:
        """Yield the transforms of the camera on the robot's frame `base`, and of its optical frame."""
        link = f"{self._prefix}{self._camera.topic}_link"
        yield from camera_transforms(stamp, base, link, self.frame, self._camera)
