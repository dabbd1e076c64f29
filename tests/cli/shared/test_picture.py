"""topic echo --image: pixels of every encoding as half blocks, and one line about what cannot be shown."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node
from robolink.cli.main import main
from robolink.cli.shared.picture import PictureError, check_terminal, drawn, pixels_of
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import String
from tests.support.seen_by_commands import a_node_that_commands_see, latch

RED, BLUE = [255, 0, 0], [0, 0, 255]


def image(encoding: str, rows: Any, kind: str = "u1", **fields: Any) -> Image:
    array = np.asarray(rows, kind)
    height, width = array.shape[:2]
    values = {"step": array.nbytes // height, "data": array.tobytes(), **fields}
    return Image(height=height, width=width, encoding=encoding, **values)


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


@pytest.mark.parametrize(
    ("encoding", "rows", "kind", "pixels"),
    [
        ("rgb8", [[RED, BLUE]], "u1", [[RED, BLUE]]),
        ("bgr8", [[RED, BLUE]], "u1", [[BLUE, RED]]),
        ("rgba8", [[[*RED, 9]]], "u1", [[RED]]),
        ("bgra8", [[[*RED, 9]]], "u1", [[BLUE]]),
        ("mono8", [[7, 200]], "u1", [[[7] * 3, [200] * 3]]),
        ("16UC1", [[100, 300]], "<u2", [[[0] * 3, [255] * 3]]),
        ("32FC1", [[1.0, np.nan, 3.0]], "<f4", [[[0] * 3, [0] * 3, [255] * 3]]),
    ],
)
def test_encodings(encoding: str, rows: Any, kind: str, pixels: Any) -> None:
    assert pixels_of(image(encoding, rows, kind)).tolist() == pixels


def test_rows_may_be_padded_and_numbers_big_endian() -> None:
    padded = image("mono8", [[1, 2, 0, 0], [3, 4, 0, 0]])
    padded.width = 2
    assert pixels_of(padded)[..., 0].tolist() == [[1, 2], [3, 4]]
    big = image("mono16", [[0, 256]], ">u2", is_bigendian=1)
    assert pixels_of(big)[0, :, 0].tolist() == [0, 255]


@pytest.mark.parametrize(
    ("message", "says"),
    [
        (Image(), "encoding '' cannot be shown"),
        (Image(encoding="rgb8"), "the image is empty: 0 x 0"),
        (image("rgb8", [[RED]], step=1), "need 3 bytes a row: the image says 1 and has 3"),
        (image("rgb8", [[RED], [RED]], data=b"\0"), "has 1 bytes"),
        (String(), "shows sensor_msgs/msg/Image, not std_msgs/msg/String"),
    ],
)
def test_what_cannot_be_shown_is_said(message: Any, says: str) -> None:
    with pytest.raises(PictureError, match=says):
        drawn(message)


@given(
    st.integers(0, 5),
    st.integers(0, 5),
    st.integers(0, 20),
    st.sampled_from(["rgb8", "mono16", "32FC1", "bayer"]),
    st.binary(max_size=60),
)
def test_any_image_is_drawn_or_refused(height: int, width: int, step: int, encoding: str, data: bytes) -> None:
    message = Image(height=height, width=width, step=step, encoding=encoding, data=data)
    with contextlib.suppress(PictureError):
        assert drawn(message)


def test_two_pixels_are_one_character(
    node: Node, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLORTERM", "truecolor")
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    latch(node, "/image", image("rgb8", [[RED], [BLUE]]))
    assert main(["topic", "echo", "/image", "--once", "--image"]) == 0
    out = capsys.readouterr().out
    assert "\x1b[38;2;255;0;0;48;2;0;0;255m\u2580\x1b[0m\n1 x 2 rgb8\n" in out


def test_a_terminal_without_colours_is_told_which_have_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("COLORTERM", raising=False)
    monkeypatch.delenv("WT_SESSION", raising=False)
    with pytest.raises(PictureError, match="kitty"):
        check_terminal(True)
    with pytest.raises(PictureError, match="the output is none"):
        check_terminal(False)
