"""OpenCV's windows where there is no window system: programs go on, and their images are on topics."""

from __future__ import annotations

import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import robolink
from robolink import Node
from robolink.companions.opencv import prepare, windows
from robolink.companions.opencv.windows import ShownImages, _shades, lack_of_windows
from robolink.image import to_array
from robolink.image.encodings import ImageError
from robolink.interfaces.sensor_msgs.msg import Image
from tests.support.waits import wait_until

PICTURE = np.arange(60, dtype=np.uint8).reshape(4, 5, 3)


class Error(Exception):
    """The class cv2.error."""


def opencv(framework: str = "", file: str = "/nowhere/cv2/__init__.py") -> Any:
    """A module like cv2, whose functions with windows return their names."""
    made: Any = ModuleType("cv2")
    made.__file__, made.__version__, made.error, made.WND_PROP_VISIBLE = file, "5.0.0", Error, 4
    made.currentUIFramework = lambda: framework
    for name in (*windows._OWN, *windows._NOTHING, "waitKeyEx"):
        setattr(made, name, lambda *args, name=name, **kwargs: name)
    return made


@pytest.fixture
def cv2(caplog: pytest.LogCaptureFixture) -> Any:
    """One without windows, prepared."""
    made = opencv()
    prepare(made)
    return made


@pytest.fixture(autouse=True)
def _no_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)


# Whether there are windows


@contextmanager
def x_server(number: int) -> Iterator[None]:
    """Answer at the socket of an X server's display."""
    if sys.platform != "linux":
        raise NotImplementedError
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(f"\0/tmp/.X11-unix/X{number}")
        server.listen()
        yield


linux_only = pytest.mark.skipif(sys.platform != "linux", reason="X11 and Wayland")


def test_headless_has_none() -> None:
    assert lack_of_windows(opencv()) == "opencv-python-headless has none"


@pytest.mark.parametrize(("text", "has"), [("  GUI:   GTK3\n", True), ("  GUI:  NONE\n", False), ("", False)])
def test_an_old_opencv_tells_by_its_build(text: str, has: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    old: Any = SimpleNamespace(getBuildInformation=lambda: text)
    assert (lack_of_windows(old) == "") is has if has else lack_of_windows(old)


@pytest.mark.parametrize("platform", ["win32", "darwin"])
def test_windows_and_macos_have_a_screen(platform: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", platform)
    assert lack_of_windows(opencv("WIN32")) == ""


@linux_only
def test_no_display_at_all() -> None:
    assert lack_of_windows(opencv("QT")) == "there is no DISPLAY"


@linux_only
@pytest.mark.parametrize("display", [":93", "unix:93.0", "127.0.0.1:9399"])
def test_a_display_that_nobody_serves(display: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DISPLAY", display)
    assert lack_of_windows(opencv("QT")) == f"nobody answers at DISPLAY={display}"


@linux_only
def test_a_display_that_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    with x_server(94):
        monkeypatch.setenv("DISPLAY", ":94.0")
        made = opencv("GTK3")
        assert lack_of_windows(made) == ""
        imshow = made.imshow
        prepare(made)
        assert made.imshow is imshow


@linux_only
def test_what_no_rule_knows_is_left_to_opencv(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DISPLAY", "/private/tmp/com.apple.launchd/org.xquartz:0")
    assert lack_of_windows(opencv("QT")) == ""


@linux_only
def test_wayland_serves_what_can_speak_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("WAYLAND_DISPLAY", "wayland-0")
    assert lack_of_windows(opencv("GTK3")) == ""
    plugins = tmp_path / "qt" / "plugins" / "platforms"
    plugins.mkdir(parents=True)
    (plugins / "libqxcb.so").touch()
    bundled = opencv("QT", str(tmp_path / "__init__.py"))
    assert lack_of_windows(bundled) == "there is no DISPLAY"
    monkeypatch.setenv("QT_QPA_PLATFORM", "offscreen")
    assert lack_of_windows(bundled) == "its Qt has no platform 'offscreen', which QT_QPA_PLATFORM names"
    (plugins / "libqoffscreen.so").touch()
    assert lack_of_windows(bundled) == ""


@linux_only
def test_a_display_that_comes_later_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    made = opencv("GTK3")
    prepare(made)
    with x_server(95):
        monkeypatch.setenv("DISPLAY", ":95")
        assert made.imshow("a", PICTURE) == "imshow"


# What the functions do


def test_keys_are_never_pressed_and_time_passes(cv2: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    slept: list[int] = []
    monkeypatch.setattr(windows, "get_defaults", lambda: SimpleNamespace(time=SimpleNamespace(sleep=slept.append)))
    assert (cv2.waitKey(30), cv2.waitKey(), cv2.waitKeyEx(1), cv2.waitKey(delay=-5), cv2.pollKey()) == (-1,) * 5
    assert slept == [30_000_000, 50_000_000, 1_000_000, 50_000_000]


def test_trackbars_keep_their_values(cv2: Any) -> None:
    changes: list[int] = []
    cv2.namedWindow("mask", 1)
    cv2.createTrackbar("low", "mask", 20, 179, changes.append)
    assert (cv2.getTrackbarPos("low", "mask"), cv2.getTrackbarPos("low", "other")) == (20, -1)
    cv2.setTrackbarPos("low", "mask", 500)
    cv2.setTrackbarPos("low", "mask", 179)
    assert (cv2.getTrackbarPos("low", "mask"), changes) == (179, [179])
    cv2.setTrackbarMax("low", "mask", 100)
    cv2.setTrackbarMin("low", "mask", 5)
    cv2.setTrackbarPos("low", "mask", -1)
    assert (cv2.getTrackbarPos("low", "mask"), changes) == (5, [179, 100, 5])
    cv2.destroyAllWindows()
    assert cv2.getTrackbarPos("low", "mask") == -1


def test_windows_are_there_until_they_are_closed(cv2: Any) -> None:
    assert cv2.getWindowProperty("a", cv2.WND_PROP_VISIBLE) == -1
    cv2.imshow("a", PICTURE)
    assert cv2.getWindowProperty("a", cv2.WND_PROP_VISIBLE) == 1
    assert cv2.getWindowImageRect("a") == (0, 0, 5, 4)
    cv2.destroyWindow("a")
    cv2.destroyWindow("a")
    assert cv2.getWindowProperty("a", cv2.WND_PROP_VISIBLE) == -1


def test_what_only_changes_a_window_does_nothing(cv2: Any) -> None:
    assert [getattr(cv2, name)("a", 1, 2) for name in windows._NOTHING] == [None] * len(windows._NOTHING)
    assert cv2.selectROI("a", PICTURE) == (0, 0, 0, 0)
    assert cv2.selectROIs("a", PICTURE) == ()


@pytest.mark.parametrize("image", [None, np.zeros((0, 3), np.uint8), "picture.png"])
def test_no_image_is_the_program_s_mistake_as_ever(cv2: Any, image: Any) -> None:
    with pytest.raises(Error, match="the image for window 'a' is empty"):
        cv2.imshow("a", image)


def test_one_line_says_what_to_do(cv2: Any, capfd: pytest.CaptureFixture[str]) -> None:
    cv2.destroyAllWindows()
    cv2.waitKey(1)
    assert capfd.readouterr().err == ""
    for _ in range(3):
        cv2.imshow("a", PICTURE)
        cv2.namedWindow("b")
    (line,) = capfd.readouterr().err.splitlines()
    assert line.endswith(
        "cv2.imshow: no windows (opencv-python-headless has none). The program goes on;"
        " cv2.imwrite writes images into files"
    )


def test_names_that_opencv_has_no_more(cv2: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(AttributeError, match=r"has no CascadeClassifier any more, and this is 5\.0\.0: pip install"):
        _ = cv2.CascadeClassifier
    with pytest.raises(AttributeError, match=r"'cv2' has no attribute 'imsho'$"):
        _ = cv2.imsho
    assert not hasattr(cv2, "face")
    monkeypatch.setitem(sys.modules, "cv2_of_test", cv2)
    with pytest.raises(ImportError, match="OpenCV 5 has no HOGDescriptor"):
        exec("from cv2_of_test import HOGDescriptor")


def test_names_of_aruco_before_opencv_4_7() -> None:
    made = opencv()
    made.aruco = ModuleType("cv2.aruco")
    prepare(made)
    with pytest.raises(
        AttributeError, match=r"no more since 4\.7, and this is 5\.0\.0: write .*getPredefinedDictionary"
    ):
        _ = made.aruco.Dictionary_get
    with pytest.raises(AttributeError, match=r"'cv2\.aruco' has no attribute 'CascadeClassifier'$"):
        _ = made.aruco.CascadeClassifier


# Topics


@pytest.fixture
def node() -> Iterator[Node]:
    robolink.init(args=[])
    try:
        yield Node("detector", namespace="robot")
    finally:
        robolink.shutdown()


@pytest.fixture(autouse=True)
def _in_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory")


def heard_on(node: Node, topic: str) -> list[Image]:
    found: list[Image] = []
    node.create_subscription(Image, topic, found.append, 1)
    return found


def spin_until_heard(node: Node, found: list[Image], count: int) -> None:
    def heard() -> bool:
        robolink.spin_once(node, timeout_sec=0.05)
        return len(found) >= count

    wait_until(heard)


def test_images_are_on_a_topic_of_the_node(cv2: Any, node: Node) -> None:
    found = heard_on(node, "/robot/detector/imshow/Red_mask_HSV")
    cv2.imshow("Red mask (HSV)", PICTURE)
    spin_until_heard(node, found, 1)
    assert_array_equal(to_array(found[0], "bgr8"), PICTURE)
    assert found[0].header.stamp.sec > 0


def test_who_comes_later_sees_the_last_image(cv2: Any, node: Node) -> None:
    cv2.imshow("frame", PICTURE)
    cv2.imshow("frame", PICTURE + 1)
    found = heard_on(node, "/robot/detector/imshow/frame")
    assert cv2.waitKey(1) == -1
    spin_until_heard(node, found, 1)
    cv2.waitKey(1)
    robolink.spin_once(node, timeout_sec=0.05)
    assert [each.data[0] for each in found] == [1]


def test_windows_have_topics_of_their_own(node: Node) -> None:
    shown = ShownImages()
    for name in ("a b", "a-b", "1", "", "ü", "a b"):
        shown.show(name, PICTURE)
    topics = sorted(each.topic_name for each in node.publishers if "imshow" in each.topic_name)
    prefix = "/robot/detector/imshow/"
    assert topics == [f"{prefix}{each}" for each in ("a_b", "a_b_2", "window", "window_1", "window_2")]
    shown.close("a b")
    shown.close("a b")
    assert f"{prefix}a_b" not in {each.topic_name for each in node.publishers}


def test_the_end_of_a_node_or_context_is_no_error(cv2: Any, node: Node) -> None:
    heard_on(node, "/robot/detector/imshow/frame")
    cv2.imshow("frame", PICTURE)
    node.destroy_node()
    cv2.imshow("frame", PICTURE)
    cv2.destroyAllWindows()
    other = Node("other")
    cv2.imshow("frame", PICTURE)
    assert "/other/imshow/frame" in {each.topic_name for each in other.publishers}
    robolink.shutdown()
    cv2.imshow("frame", PICTURE)
    assert cv2.waitKey(1) == -1
    robolink.init(args=[])


@pytest.mark.parametrize(
    ("value", "kind", "shade"),
    [(200, "u1", 200), (0x1234, "u2", 0x12), (-128, "i1", 0), (0.5, "f4", 128), (7.0, "f8", 255), (np.nan, "f4", 0)],
)
def test_shades_are_those_of_a_window(value: float, kind: str, shade: int) -> None:
    assert _shades(np.full((2, 2), value, kind)).tolist() == [[shade] * 2] * 2


@pytest.mark.parametrize("kind", ["i4", "?", "O"])
def test_what_a_window_does_not_show_is_not_sent(kind: str, cv2: Any, node: Node) -> None:
    heard_on(node, "/robot/detector/imshow/frame")
    cv2.imshow("frame", np.zeros((2, 2), kind))
    with pytest.raises(ImageError, match="imshow shows no images of"):
        _shades(np.zeros((2, 2), kind))
