"""Images of messages as arrays that can be drawn on, arrays as messages, and what is not an image."""

from __future__ import annotations

from array import array
from typing import Any

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from robolink.image import ImageError, to_array, to_message
from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image, LaserScan
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import decode, encode
from tests.support.opencvs_conversions import ENCODINGS, GENERIC, parted, some_image

RED = np.zeros((4, 6, 3), np.uint8)
RED[..., 2] = 255


def sent(message: Any) -> Any:
    """The message as it arrives."""
    return decode(type(message), encode(message))


@given(st.sampled_from(ENCODINGS), st.integers(0, 2**32), st.integers(1, 9), st.integers(1, 9))
def test_an_image_comes_back_and_can_be_drawn_on(encoding: str, seed: int, height: int, width: int) -> None:
    image = some_image(encoding, np.random.default_rng(seed), height, width)
    for each in (image, image.astype(image.dtype.newbyteorder()), np.asfortranarray(image)):
        came = sent(to_message(each, encoding))
        again = to_array(came)
        assert_array_equal(again, image)
        assert again.dtype == image.dtype
        assert again.dtype.isnative
        assert again.flags.writeable
        again[0] = 0
        assert (came.encoding, came.height, came.width) == (encoding, height, width)
        assert came.step == width * parted(encoding)[2] * image.itemsize


def test_what_arrives_small_or_large_can_be_drawn_on() -> None:
    for picture in (RED, np.tile(RED, (200, 200, 1))):
        for encoding in ("passthrough", "", "bgr8", "rgb8"):
            seen = to_array(sent(to_message(picture)), encoding)
            cv2.circle(seen, (2, 2), 1, (0, 255, 0))
            assert seen[2, 3].tolist() == [0, 255, 0]


def test_the_readme_of_the_module() -> None:
    message = to_message(RED, "bgr8", Header(frame_id="camera"))
    assert (message.header.frame_id, message.encoding, message.step) == ("camera", "bgr8", 18)
    assert to_array(message, "rgb8")[0, 0].tolist() == [255, 0, 0]
    assert to_array(message, "mono8").tolist() == [[76] * 6] * 4


@pytest.mark.parametrize(
    ("shape", "kind", "encoding"),
    [
        ((2, 3), "uint8", "mono8"),
        ((2, 3, 1), "uint8", "mono8"),
        ((2, 3, 3), "uint8", "bgr8"),
        ((2, 3, 4), "uint8", "bgra8"),
        ((2, 3), "uint16", "16UC1"),
        ((2, 3, 3), "uint16", "bgr16"),
        ((2, 3), "float32", "32FC1"),
        ((2, 3, 2), "float64", "64FC2"),
    ],
)
def test_an_array_without_an_encoding(shape: tuple[int, ...], kind: str, encoding: str) -> None:
    assert to_message(np.zeros(shape, kind)).encoding == encoding


@pytest.mark.parametrize("pad", [0, 1, 5])
@pytest.mark.parametrize("big", [False, True])
def test_padded_rows_and_big_endian(pad: int, big: bool) -> None:
    rows = np.arange(12, dtype=np.uint16).reshape(3, 4) * 300
    order = ">u2" if big else "<u2"
    data = b"".join(row.astype(order).tobytes() + b"\xee" * pad for row in rows)
    message = Image(height=3, width=4, encoding="mono16", is_bigendian=big, step=8 + pad, data=data)
    assert_array_equal(to_array(message), rows)
    assert to_array(message).dtype == np.uint16
    assert_array_equal(to_array(sent(message), "mono8"), (rows + 128) // 257)


@pytest.mark.parametrize(
    "data",
    [
        bytes(6),
        bytearray(6),
        array("B", bytes(6)),
        [0] * 6,
        (0,) * 6,
        memoryview(bytes(6)),
        np.zeros(6, np.uint8),
        np.zeros(12, np.uint8)[::2],
    ],
)
def test_whatever_a_program_has_put_into_data(data: Any) -> None:
    image = to_array(Image(height=2, width=3, encoding="mono8", step=3, data=data))
    assert image.shape == (2, 3)
    image[:] = 1


def test_the_message_is_shared_as_in_rclpy() -> None:
    message = to_message(np.zeros((2, 3), np.uint8))
    to_array(message)[:] = 7
    assert set(message.data) == {7}


@pytest.mark.parametrize(
    "wrong",
    [
        {"step": 2},
        {"height": 3},
        {"width": 4},
        {"data": b""},
        {"data": bytes(5)},
        {"encoding": "bgr8"},
        {"encoding": "bgr9"},
        {"encoding": ""},
        {"encoding": "\x1b[2J"},
        {"encoding": "64FC512"},
        {"height": 2**31, "width": 2**31, "step": 2**31},
        {"height": -1},
        {"height": 1.5},
        {"height": "2"},
    ],
)
def test_an_image_that_contradicts_itself_is_one_line(wrong: dict[str, Any]) -> None:
    message = Image(height=2, width=3, encoding="mono8", step=3, data=bytes(6))
    for name, value in wrong.items():
        setattr(message, name, value)
    with pytest.raises(ImageError) as caught:
        to_array(message)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 300


def test_too_much_data_is_left_alone() -> None:
    message = Image(height=2, width=3, encoding="mono8", step=3, data=bytes(range(9)))
    assert to_array(message).tolist() == [[0, 1, 2], [3, 4, 5]]


def test_no_pixels() -> None:
    empty = to_array(Image(encoding="bgr8"))
    assert empty.shape == (0, 0, 3)
    assert sent(to_message(empty)).step == 0


@pytest.mark.parametrize(
    "image",
    [
        np.zeros(6, np.uint8),
        np.zeros((1, 2, 3, 4), np.uint8),
        np.zeros((2, 3), np.int64),
        np.zeros((2, 3), bool),
        np.zeros((2, 3), "f2"),
        np.zeros((2, 3), object),
        np.zeros((2, 3, 0), np.uint8),
        np.zeros((2, 3, 513), np.uint8),
        np.uint8(3),
        [[1, 2], [3, 4]],
        None,
    ],
)
def test_what_is_no_image_is_one_line(image: Any) -> None:
    with pytest.raises(ImageError) as caught:
        to_message(image)
    assert "\n" not in str(caught.value)


def test_the_encoding_of_another_type_is_refused() -> None:
    with pytest.raises(ImageError, match="encoding specified as mono8, but image has incompatible type 8UC3"):
        to_message(RED, "mono8")


@pytest.mark.parametrize("message", [None, LaserScan(), Image, 3])
def test_another_message_is_refused(message: Any) -> None:
    with pytest.raises(ImageError, match="expected a message of sensor_msgs/msg/Image, got "):
        to_array(message)


@pytest.mark.parametrize("encoding", GENERIC)
def test_every_type_has_its_own_encoding_without_colours(encoding: str) -> None:
    image = some_image(encoding, np.random.default_rng(3), 3, 4)
    found = to_message(image, encoding)
    assert_array_equal(to_array(found), image)


def test_a_compressed_image() -> None:
    data = cv2.imencode(".png", RED)[1].tobytes()
    came = sent(CompressedImage(format="png", data=data))
    assert to_array(came, "rgb8")[0, 0].tolist() == [255, 0, 0]
    assert_array_equal(to_array(came), RED)
    with pytest.raises(ImageError, match="are not a JPEG, PNG or other picture"):
        to_array(CompressedImage(data=b"no picture"))
