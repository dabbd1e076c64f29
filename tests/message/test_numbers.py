"""Number fields of large messages: views of the bytes received inside, rclpy's arrays outside."""

from __future__ import annotations

import copy
import pickle
import threading
from array import array
from concurrent.futures import ThreadPoolExecutor
from typing import Annotated, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink.exceptions import EncodeError
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.sensor_msgs.msg import Image, Imu, LaserScan
from robolink.interfaces.std_msgs.msg import Float64MultiArray
from robolink.message import Message, Sequence, Size, decode, encode, uint8
from robolink.message.numbers import VIEW_FROM

BYTES = bytes(range(256)) * (VIEW_FROM // 256)
SQUARE = memoryview(BYTES).cast("B", (256, VIEW_FROM // 256))


def received() -> Any:
    """An image that is as large as a view must be, as it arrives."""
    return decode(Image, encode(Image(height=1, width=len(BYTES), step=len(BYTES), data=BYTES)))


def stored(message: Any, name: str = "data") -> Any:
    return type(message).__dict__[name].stored(message)


@pytest.mark.parametrize("size", [VIEW_FROM - 1, VIEW_FROM])
def test_data_is_an_array_as_in_rclpy(size: int) -> None:
    image = decode(Image, encode(Image(data=(BYTES + BYTES)[:size])))
    assert type(image.data) is array
    assert image.data.typecode == "B"
    assert image.data is image.data
    image.data[0] = 7
    image.data.append(9)
    assert (image.data[0], image.data[-1], len(image.data)) == (7, 9, size + 1)


def test_programs_read_it_in_all_of_rclpys_ways() -> None:
    image = received()
    assert np.array_equal(np.frombuffer(image.data, np.uint8), np.frombuffer(BYTES, np.uint8))
    assert np.array_equal(np.array(image.data), np.frombuffer(BYTES, np.uint8))
    assert bytes(image.data) == image.data.tobytes() == BYTES
    assert image.data == array("B", BYTES)
    assert image.data[255] == 255
    assert isinstance(image.data, array)
    assert np.frombuffer(image.data, np.uint8).flags.writeable


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda each: pickle.loads(pickle.dumps(each))])
def test_a_message_received_is_copied_as_any_other(copied: Any) -> None:
    image = received()
    other = copied(image)
    assert other == image
    assert type(other.data) is array
    assert (other.data is image.data) == (copied is copy.copy)


def test_a_message_that_is_passed_on_is_not_copied() -> None:
    data = encode(Image(data=BYTES))
    image = decode(Image, data)
    assert encode(image) == data
    assert type(stored(image)) is memoryview
    assert stored(image).obj is data


def test_it_goes_to_another_message() -> None:
    image, other = received(), Image()
    other.data = image.data
    assert other.data is image.data
    assert encode(Image(data=image.data)) == encode(other)


def test_the_bytes_received_are_let_go_of_with_the_first_look() -> None:
    buffer = bytearray(encode(Image(data=BYTES)))
    image = Image()
    type(image).__dict__["data"].store(image, memoryview(buffer)[-len(BYTES) :])
    with pytest.raises(BufferError):
        buffer.append(0)  # a view holds it
    assert image.data == array("B", BYTES)
    buffer.append(0)


@pytest.mark.parametrize(
    ("message", "name"),
    [
        (OccupancyGrid(data=array("b", [-1, 0, 100]) * VIEW_FROM), "data"),
        (LaserScan(ranges=array("f", [0.5, 1.5]) * VIEW_FROM), "ranges"),
        (Float64MultiArray(data=array("d", [0.1]) * VIEW_FROM), "data"),
    ],
    ids=["int8", "float32", "float64"],
)
def test_numbers_of_all_sizes_are_views_until_they_are_looked_at(message: Any, name: str) -> None:
    data = encode(message)
    back = decode(type(message), data)
    assert type(stored(back, name)) is memoryview
    assert encode(back) == data
    assert getattr(back, name) == getattr(message, name)
    assert type(stored(back, name)) is array
    assert encode(back) == data


@given(st.binary(max_size=64), st.integers(0, 3))
@settings(max_examples=50)
def test_both_sides_of_the_threshold_decode_alike(tail: bytes, more: int) -> None:
    body = BYTES[: VIEW_FROM - 2 + more] + tail
    image = Image(encoding="mono8", data=body)
    back = decode(Image, encode(image))
    assert back == image
    assert back.data.tobytes() == body


def test_threads_that_look_at_once_get_the_same_array() -> None:
    with ThreadPoolExecutor(8) as pool:
        for _ in range(20):
            image = received()
            arrays = list(pool.map(lambda _, image=image: image.data, range(8)))
            assert all(each is arrays[0] for each in arrays)


def test_an_assignment_is_not_undone_by_a_thread_that_looks_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    image, numbers = received(), Image.__dict__["data"]
    assigning = threading.Thread(target=lambda: setattr(image, "data", b"new"))
    settle = numbers._filled

    def assign_meanwhile(view: Any) -> Any:
        monkeypatch.undo()
        assigning.start()
        assigning.join(0.1)  # it waits for this look, or else is done by now
        return settle(view)

    monkeypatch.setattr(numbers, "_filled", assign_meanwhile)
    assert image.data.tobytes() == BYTES
    assigning.join()
    assert image.data.tobytes() == b"new"


@pytest.mark.parametrize("value", [memoryview(BYTES), np.frombuffer(BYTES, np.uint8)])
def test_what_is_assigned_is_copied(value: Any) -> None:
    image = Image()
    image.data = value
    assert type(image.data) is array
    assert image.data.tobytes() == BYTES


@pytest.mark.parametrize("square", [SQUARE, np.zeros((3, 1), np.uint8), np.uint8(3)])
def test_a_sequence_takes_no_array_of_other_dimensions_as_in_rclpy(square: Any) -> None:
    with pytest.raises(TypeError, match=r"Image\.data: .*shape \(.*\): give its elements in a row"):
        Image().data = square
    with pytest.raises(EncodeError, match=r"Image\.data"):
        encode(Image(data=square))


def test_a_sequence_takes_an_empty_array_of_any_dimensions() -> None:
    assert len(Image(data=np.zeros((0, 3), np.uint8)).data) == 0


@pytest.mark.parametrize("matrix", [np.arange(9.0).reshape(3, 3), np.arange(9.0).reshape(3, 3).T, [[1, 2, 3]] * 3])
def test_a_fixed_array_takes_a_matrix_row_by_row(matrix: Any) -> None:
    flat = np.asarray(matrix, float).ravel().tolist()
    imu: Any = Imu(orientation_covariance=matrix)
    assigned: Any = Imu()
    assigned.orientation_covariance = matrix
    for each in (imu, assigned, decode(Imu, encode(Imu(orientation_covariance=matrix)))):
        assert each.orientation_covariance.shape == (9,)
        assert each.orientation_covariance.tolist() == flat


def test_a_matrix_of_another_size_is_refused() -> None:
    with pytest.raises(EncodeError, match=r"Imu.orientation_covariance: expected float64\[9\], got 36 elements"):
        Imu().orientation_covariance = np.eye(6)  # type: ignore[assignment]


@pytest.mark.parametrize(
    "numbers",
    [
        np.arange(12, dtype=np.uint8)[::2],
        np.arange(0, 12, 2, dtype=">u2"),
        memoryview(bytes(range(12)))[::2],
    ],
)
def test_a_view_of_any_layout_is_taken(numbers: Any) -> None:
    view: Any = memoryview(numbers)
    assigned = Image()
    assigned.data = view
    for image in (Image(data=view), assigned, decode(Image, encode(Image(data=view)))):
        assert list(image.data) == [0, 2, 4, 6, 8, 10]


@pytest.mark.parametrize("other", [memoryview(b"abc").cast("c"), np.array([1, 300], ">u2")])
def test_a_view_of_something_else_is_an_encode_error(other: Any) -> None:
    view: Any = memoryview(other)
    with pytest.raises(EncodeError, match=r"Image\.data"):
        Image().data = view


def test_a_view_of_nothing_is_an_empty_array() -> None:
    image: Any = Image()
    for nothing in (memoryview(b""), np.zeros((0, 3), np.uint8)):
        image.data = nothing
        assert image.data == array("B")


@pytest.mark.parametrize("value", [[256], [-1], np.array([300])])
def test_a_number_out_of_range_is_an_overflow_error_as_in_rclpy(value: Any) -> None:
    with pytest.raises(OverflowError, match=r"Image\.data: expected uint8\[\]") as caught:
        Image().data = value
    assert isinstance(caught.value, EncodeError)


def test_large_bytes_are_neither_copied_when_assigned_nor_when_sent() -> None:
    image: Any = Image()
    made = Image(data=BYTES)
    image.data = BYTES
    assert encode(image) == encode(made) == encode(Image(data=array("B", BYTES)))
    assert type(stored(image)) is memoryview
    assert stored(made) is BYTES
    image.data[0] = 7  # an array of its own, once it is asked for
    assert (image.data[0], type(image.data), BYTES[0]) == (7, array, 0)
    assert decode(Image, encode(image)).data == image.data


class Block(Message):
    """A message with large numbers of a fixed size."""

    numbers: Annotated[Sequence[uint8], Size(len(BYTES))]


def test_large_bytes_for_an_array_of_a_fixed_size_are_refused_at_once() -> None:
    block: Any = Block()
    with pytest.raises(EncodeError, match="expected"):
        block.numbers = BYTES + b"0"
