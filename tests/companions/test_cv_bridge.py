"""cv_bridge: its class, its functions, and the names that programs import."""

from __future__ import annotations

import sys
from array import array
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from robolink.companions import cv_bridge
from robolink.companions import cv_bridge as core
from robolink.companions import cv_bridge as functions
from robolink.companions.cv_bridge import CvBridge, CvBridgeError, cvtColorForDisplay, getCvType
from robolink.image import ImageError
from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import decode, encode
from tests.support.opencvs_conversions import DEPTHS, ENCODINGS, by_opencv, parted, some_image

BRIDGE = CvBridge()
PICTURE = some_image("8UC3", np.random.default_rng(4), 8, 10)


def test_its_names() -> None:
    assert cv_bridge.CvBridge is core.CvBridge
    assert core.CvBridgeError is CvBridgeError is ImageError
    assert issubclass(CvBridgeError, TypeError)
    assert issubclass(CvBridgeError, ValueError)


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_numbers_of_types_are_those_of_the_installed_opencv(encoding: str) -> None:
    _, depth, channels = parted(encoding)
    name = f"{depth}C{channels}"
    number = getattr(cv2, f"CV_{name}")
    assert BRIDGE.encoding_to_cvtype2(encoding) == getCvType(encoding) == number
    assert BRIDGE.cvtype_to_name[number] == name
    dtype, many = BRIDGE.encoding_to_dtype_with_channels(encoding)
    assert BRIDGE.cvtype2_to_dtype_with_channels(number) == (dtype, many)
    assert BRIDGE.dtype_with_channels_to_cvtype2(np.dtype(dtype), many) == name


def test_tables() -> None:
    assert BRIDGE.cvdepth_to_numpy_depth == {getattr(cv2, f"CV_{d}"): BRIDGE.numpy_type_to_cvtype[d] for d in DEPTHS}
    assert BRIDGE.numpy_type_to_cvtype["uint8"] == "8U"
    assert len(BRIDGE.cvtype_to_name) == 28
    assert getCvType("8UC17") == cv2.CV_8UC(17)
    assert BRIDGE.cvtype2_to_dtype_with_channels(cv2.CV_32FC(17)) == ("float32", 17)


def test_tables_without_opencv(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    bridge = CvBridge()
    assert bridge.encoding_to_dtype_with_channels("bgr8") == ("uint8", 3)
    assert bridge.dtype_with_channels_to_cvtype2(np.dtype("float32"), 1) == "32FC1"
    for ask in (lambda: bridge.cvtype_to_name, lambda: getCvType("bgr8"), lambda: bridge.cvdepth_to_numpy_depth):
        with pytest.raises(CvBridgeError, match="needs OpenCV"):
            ask()
    assert bridge.imgmsg_to_cv2(bridge.cv2_to_imgmsg(PICTURE, "rgb8"), "mono8").shape == (8, 10)


@pytest.mark.parametrize("encoding", ["8UC3", "bgr8", "rgb8"])
def test_there_and_back(encoding: str) -> None:
    message = BRIDGE.cv2_to_imgmsg(PICTURE, encoding, Header(frame_id="camera"))
    assert (message.encoding, message.header.frame_id, message.step) == (encoding, "camera", 30)
    assert isinstance(message.data, array)
    came = decode(Image, encode(message))
    seen = BRIDGE.imgmsg_to_cv2(came)
    assert_array_equal(seen, PICTURE)
    cv2.rectangle(seen, (0, 0), (3, 3), (1, 2, 3))


def test_passthrough_names_the_type_alone() -> None:
    assert BRIDGE.cv2_to_imgmsg(PICTURE).encoding == "8UC3"
    assert BRIDGE.cv2_to_imgmsg(PICTURE[..., 0]).encoding == "8UC1"
    assert BRIDGE.cv2_to_imgmsg(PICTURE, encoding="passthrough").header == Header()


def test_desired_encoding() -> None:
    message = BRIDGE.cv2_to_imgmsg(PICTURE, "rgb8")
    for wanted in ("bgr8", "mono8", "bgra16", "rgb8"):
        assert_array_equal(BRIDGE.imgmsg_to_cv2(message, desired_encoding=wanted), by_opencv(PICTURE, "rgb8", wanted))


@pytest.mark.parametrize("form", ["png", "jpg", "bmp"])
def test_compressed(form: str) -> None:
    came = decode(CompressedImage, encode(BRIDGE.cv2_to_compressed_imgmsg(PICTURE, form)))
    assert came.format == form
    expected: Any = cv2.imdecode(np.frombuffer(bytes(came.data), np.uint8), cv2.IMREAD_UNCHANGED)
    assert_array_equal(BRIDGE.compressed_imgmsg_to_cv2(came), expected)
    assert_array_equal(BRIDGE.compressed_imgmsg_to_cv2(came, "rgb8"), expected[..., ::-1])
    assert BRIDGE.cv2_to_compressed_imgmsg(PICTURE).format == "jpg"


def test_compressed_grey_of_sixteen_bits_is_converted() -> None:
    deep = some_image("16UC1", np.random.default_rng(5), 4, 6)
    came = BRIDGE.cv2_to_compressed_imgmsg(deep, "png")
    assert_array_equal(BRIDGE.compressed_imgmsg_to_cv2(came), deep)
    assert_array_equal(BRIDGE.compressed_imgmsg_to_cv2(came, "mono8"), by_opencv(deep, "mono16", "mono8"))


def refusals() -> dict[str, Any]:
    compressed = CompressedImage(format="jpeg", data=b"no picture")
    return {
        "of sensor_msgs/msg/Image, got sensor_msgs/msg/CompressedImage: compressed_imgmsg_to_cv2 reads it": lambda: (
            BRIDGE.imgmsg_to_cv2(compressed)  # type: ignore[arg-type]
        ),
        "got NoneType": lambda: BRIDGE.imgmsg_to_cv2(None),  # type: ignore[arg-type]
        "expected a message of sensor_msgs/msg/CompressedImage, got sensor_msgs/msg/Image": lambda: (
            BRIDGE.compressed_imgmsg_to_cv2(Image())  # type: ignore[arg-type]
        ),
        "Your input type is not a numpy array, but list": lambda: BRIDGE.cv2_to_imgmsg([[1]]),  # type: ignore[arg-type]
        "Your input type is not a numpy array, but NoneType": lambda: BRIDGE.cv2_to_compressed_imgmsg(None),  # type: ignore[arg-type]
        "encoding specified as bgr8, but image has incompatible type 8UC1": lambda: BRIDGE.cv2_to_imgmsg(
            PICTURE[..., 0], "bgr8"
        ),
        "no encoding has values of int64": lambda: BRIDGE.cv2_to_imgmsg(np.zeros((2, 2), np.int64)),
        "no encoding has values of bool": lambda: BRIDGE.dtype_with_channels_to_cvtype2(np.dtype(bool), 1),
        "not a JPEG, PNG or other picture": lambda: BRIDGE.compressed_imgmsg_to_cv2(compressed),
        "is not a type of images": lambda: BRIDGE.cvtype2_to_dtype_with_channels(cv2.CV_8UC2 - 1),
        "Unrecognized image encoding [bgr9]": lambda: BRIDGE.encoding_to_cvtype2("bgr9"),
    }


@pytest.mark.parametrize("said", refusals())
def test_refusals_are_one_line(said: str) -> None:
    with pytest.raises(CvBridgeError) as caught:
        refusals()[said]()
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_depth_is_shown_in_shades() -> None:
    depth = np.array([[0.5, 1.0, np.inf], [1.5, np.nan, 2.5]], np.float32)
    shown = cvtColorForDisplay(depth, "32FC1", "mono8", do_dynamic_scaling=True)
    assert shown.tolist() == [[0, 64, 255], [128, 0, 255]]
    fixed = cvtColorForDisplay(depth, "32FC1", "bgr8", min_image_value=0, max_image_value=5)
    assert fixed[0, 1].tolist() == [51, 51, 51]
    coloured = cvtColorForDisplay(depth, "32FC1", "rgb8", True, colormap=cv2.COLORMAP_JET)
    jet = cv2.applyColorMap(np.array([[64]], np.uint8), cv2.COLORMAP_JET)
    assert coloured[0, 1].tolist() == jet[0, 0, ::-1].tolist()
    assert coloured[1, 1].tolist() == [0, 0, 0]


def test_display_of_other_images() -> None:
    assert_array_equal(cvtColorForDisplay(PICTURE, "rgb8", "bgr8"), PICTURE[..., ::-1])
    assert_array_equal(cvtColorForDisplay(PICTURE, "8UC3"), PICTURE)
    grey = cvtColorForDisplay(np.full((2, 2), 514, np.uint16), "16UC1", "mono8")
    assert grey.tolist() == [[2, 2], [2, 2]]
    even = cvtColorForDisplay(np.ones((2, 2), np.float32), "32FC1", "mono8", True)
    assert even.tolist() == [[127, 127], [127, 127]]
    labels = cvtColorForDisplay(np.array([[-1, 0, 1, 7]], np.int32), "32SC1", "bgr8")
    assert labels[0, 0].tolist() == [0, 0, 0]
    assert labels[0, 1:].tolist() == [[255, 248, 240], [215, 235, 250], [0, 0, 0]]  # the first colours by their names
    many = cvtColorForDisplay(np.arange(12, dtype=np.int32).reshape(3, 4), "32SC1", "bgr8")
    assert (str(many.dtype), many.min(), many.max()) == ("uint8", 0, 255)
    assert cvtColorForDisplay(np.array([[146]], np.int32), "32SC1", "bgr8").tolist() == [[[255, 248, 240]]]


@pytest.mark.parametrize(
    ("source", "encodings"),
    [
        (PICTURE, ("bgr8", "mono16")),
        (PICTURE, ("bgr8", "32FC1")),
        (np.ones((2, 2), np.float32), ("32FC1", "bgr8")),
    ],
)
def test_what_cannot_be_displayed_is_one_line(source: Any, encodings: tuple[str, str]) -> None:
    with pytest.raises(CvBridgeError) as caught:
        cvtColorForDisplay(source, *encodings)
    assert "\n" not in str(caught.value)
    with pytest.raises(CvBridgeError, match="scales images of one channel, and bgr8 has 3"):
        cvtColorForDisplay(PICTURE, "bgr8", "bgr8", True)


def test_the_module_below_boost() -> None:
    assert functions.CV_MAT_CNWrap(cv2.CV_16SC3) == 3
    assert functions.CV_MAT_DEPTHWrap(cv2.CV_16SC3) == cv2.CV_16S
    assert_array_equal(functions.cvtColor2(PICTURE, "bgr8", "mono8"), by_opencv(PICTURE, "bgr8", "mono8"))
