"""image_tools: pictures of a camera, or drawn ones, and their window."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from robolink.counterparts import image_tools
from robolink.counterparts.image_tools import BACKGROUND, Cam2Image, ShowImage, bounced, render
from robolink.exceptions import RobolinkError
from robolink.image import ImageError, to_array
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import Bool
from robolink.qos import ReliabilityPolicy
from robolink.testing import System


class OpenCV:
    """A stand-in for OpenCV: a camera that may be there, and windows."""

    CAP_PROP_FRAME_WIDTH, CAP_PROP_FRAME_HEIGHT = 3, 4

    def __init__(self, has_camera: bool = True) -> None:
        self.has_camera, self.released, self.set_to = has_camera, False, dict[int, float]()
        self.shown: dict[str, Any] = {}

    def VideoCapture(self, device: int) -> OpenCV:
        return self

    def isOpened(self) -> bool:
        return self.has_camera

    def set(self, what: int, value: float) -> None:
        self.set_to[what] = value

    def read(self) -> tuple[bool, Any]:
        return True, np.arange(18, dtype=np.uint8).reshape(2, 3, 3)

    def release(self) -> None:
        self.released = True

    def imshow(self, title: str, picture: Any) -> None:
        self.shown[title] = picture

    def waitKey(self, delay: int) -> int:
        return -1


@pytest.fixture
def cv2(monkeypatch: pytest.MonkeyPatch) -> OpenCV:
    made = OpenCV()
    monkeypatch.setattr(image_tools, "opencv", lambda purpose: made)
    return made


def test_burgers_fly_about() -> None:
    first, second = (render(64, 48, number) for number in (0, 5))
    assert first.shape == (48, 64, 3)
    assert (first != second).any()
    assert 0.05 < (first != BACKGROUND).any(axis=2).mean() < 0.8
    assert render(1, 1, 10**9).shape == (1, 1, 3)
    assert all(0 <= bounced(each * 0.37) <= 1 for each in range(20))


def test_drawn_pictures_are_published(system: System) -> None:
    parameters = {"burger_mode": True, "width": 40, "height": 30, "frequency": 10.0, "reliability": "best_effort"}
    system.start("image_tools cam2image", parameters=parameters)
    heard = system.messages("/image", Image)
    system.run(1.05)
    assert len(heard) == 10
    assert (heard[0].width, heard[0].height, heard[0].encoding, heard[0].header.frame_id) == (
        40,
        30,
        "bgr8",
        "camera_frame",
    )
    assert to_array(heard[0], "bgr8").tolist() == render(40, 30, 0).tolist()
    (end,) = system.node.get_publishers_info_by_topic("/image")
    assert end.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT
    system.expect_log("Publishing image #1")
    system.publish("/flip_image", Bool(data=True))
    system.expect_log("Set flip mode to: on")
    flipped = to_array(system.expect("/image"), "bgr8")
    assert any((flipped == render(40, 30, number)[:, ::-1]).all() for number in range(20))


def test_a_camera_is_read(system: System, cv2: OpenCV) -> None:
    node = system.start(Cam2Image, parameters={"show_camera": True, "width": 64})
    assert to_array(system.expect("/image"), "bgr8").tolist() == cv2.read()[1].tolist()
    assert cv2.set_to == {3: 64.0, 4: 240.0}
    assert "cam2image" in cv2.shown
    system.stop(node)
    assert cv2.released


def test_where_there_is_no_camera_pictures_are_drawn(system: System, cv2: OpenCV) -> None:
    cv2.has_camera = False
    system.start(Cam2Image)
    system.expect_log("Could not open video stream 0: drawn pictures are published")
    assert to_array(system.expect("/image"), "bgr8").shape == (240, 320, 3)


def test_pictures_are_shown(system: System, cv2: OpenCV) -> None:
    system.start(ShowImage)
    system.start("image_tools cam2image", parameters={"burger_mode": True})
    system.expect_log("Received image #camera_frame")
    assert list(cv2.shown) == ["/image"]
    system.publish("/image", Image(width=5, height=5, encoding="bgr8"))
    system.expect_log("it cannot be shown: ")


def test_without_opencv_it_goes_on(system: System, monkeypatch: pytest.MonkeyPatch) -> None:
    def lacking(purpose: str) -> Any:
        raise ImageError(f"{purpose} needs OpenCV")

    monkeypatch.setattr(image_tools, "opencv", lacking)
    system.start(ShowImage)
    system.start(Cam2Image)
    system.expect_log("a window needs OpenCV; 'robolink image show' draws in the terminal", within=0.0)
    system.expect_log("a camera needs OpenCV; drawn pictures are published", within=0.0)
    system.expect_log("Received image #camera_frame")


def test_other_qualities_of_service_are_one_line(system: System) -> None:
    with pytest.raises(RobolinkError, match="reliability: expected reliable or best_effort, got 'reliabel'"):
        system.start("image_tools showimage", parameters={"reliability": "reliabel"})
