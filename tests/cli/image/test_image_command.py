"""robolink image: what it saves can be read again bit for bit, and what cannot be saved is one line."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from robolink import Node
from robolink.cli.main import main
from robolink.image import to_message
from robolink.image.codecs import encoded, png_of
from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image
from robolink.interfaces.std_msgs.msg import String
from tests.support.opencvs_conversions import some_image
from tests.support.seen_by_commands import a_node_that_commands_see, latch

PICTURE = some_image("8UC3", np.random.default_rng(6), 6, 8)


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Node]:
    monkeypatch.chdir(tmp_path)
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


def read(path: str) -> Any:
    return cv2.imdecode(np.frombuffer(Path(path).read_bytes(), np.uint8), cv2.IMREAD_UNCHANGED)


@pytest.mark.parametrize(
    ("encoding", "expected"),
    [("bgr8", PICTURE), ("rgb8", PICTURE[..., ::-1]), ("8UC3", PICTURE)],
)
def test_a_png_holds_every_bit(
    node: Node, encoding: str, expected: Any, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    latch(node, "/image", to_message(PICTURE, encoding))
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "cv2", None)
        assert main(["image", "save", "/image"]) == 0
    assert capsys.readouterr().out == "image_0001.png\n"
    assert_array_equal(read("image_0001.png"), expected)


@pytest.mark.parametrize("shape", [(5, 7), (5, 7, 3), (5, 7, 4)])
@pytest.mark.parametrize("kind", ["uint8", "uint16"])
def test_pngs_of_our_own_are_read_by_opencv(shape: tuple[int, ...], kind: str) -> None:
    image = np.random.default_rng(7).integers(0, np.iinfo(kind).max, shape, kind)
    again: Any = cv2.imdecode(np.frombuffer(png_of(image), np.uint8), cv2.IMREAD_UNCHANGED)
    order = [2, 1, 0, 3][: shape[2]] if len(shape) == 3 else slice(None)
    assert_array_equal(again[..., order], image)


def test_distances_become_millimetres(node: Node) -> None:
    metres = np.array([[0.5, np.inf, np.nan], [1.2345, 70.0, -np.inf]], np.float32)
    latch(node, "/depth", to_message(metres))
    assert main(["image", "save", "/depth", "depth.png"]) == 0
    assert read("depth.png").tolist() == [[500, 0, 0], [1234, 65535, 0]]


def test_absurd_distances_are_the_farthest_or_none_without_a_warning(node: Node) -> None:
    latch(node, "/depth", to_message(np.array([[3e38, -3e38], [np.inf, np.nan]], np.float32)))
    assert main(["image", "save", "/depth", "a.png"]) == 0
    assert_array_equal(read("a.png"), [[65535, 0], [0, 0]])


def test_several_and_a_jpeg(node: Node, capsys: pytest.CaptureFixture[str]) -> None:
    latch(node, "/image", *[to_message(np.full((8, 8, 3), each, np.uint8)) for each in (10, 200)])
    assert main(["image", "save", "/image", "a{}.jpg", "--count", "2", "--timeout", "20"]) == 0
    assert capsys.readouterr().out == "a0001.jpg\na0002.jpg\n"
    assert [abs(int(read(name)[4, 4, 0]) - shade) < 4 for name, shade in (("a0001.jpg", 10), ("a0002.jpg", 200))] == [
        True,
        True,
    ]


def test_what_came_compressed_stays_as_it_is(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    data = encoded(PICTURE, "png")
    latch(node, "/compressed", CompressedImage(format="png", data=data))
    assert main(["image", "save", "/compressed", "b.png"]) == 0
    assert Path("b.png").read_bytes() == data
    assert main(["image", "save", "/compressed", "b.jpg"]) == 0
    assert read("b.jpg").shape == PICTURE.shape


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["/image", "a.gif"], "end its name in .png or .jpg"),
        (["/image", "a.png", "--count", "2"], "'a.png' is one file, not 2: write {}"),
        (["/image", "nowhere/a.png"], "no folder"),
        (["/text", "a.png"], "/text is of std_msgs/msg/String, and holds no images"),
        (["/nothing", "a.png", "--timeout", "0"], "nobody publishes /nothing"),
        (["/broken", "a.png"], "Image is wrongly formed"),
        (["/empty", "a.png"], "the image is empty"),
        (["/float", "a.jpg"], "a JPEG holds no 64FC1: save it as .png"),
        (["/float", "a.png"], "no image file holds 64FC1"),
    ],
)
def test_what_cannot_be_saved_is_one_line(
    node: Node, words: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    latch(node, "/text", String(data="no image"))
    latch(node, "/broken", Image(height=2, width=2, encoding="bgr8", step=6, data=bytes(3)))
    latch(node, "/empty", Image(encoding="bgr8"))
    latch(node, "/float", to_message(np.zeros((2, 2))))
    assert main(["image", "save", *words]) == 1
    err = capsys.readouterr().err
    assert says in err
    assert err.count("\n") == 1


@pytest.mark.parametrize("compressed", [False, True])
def test_images_are_shown_in_the_terminal(
    node: Node, compressed: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLORTERM", "truecolor")
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    red = np.zeros((2, 1, 3), np.uint8)
    red[0, 0, 2] = red[1, 0, 0] = 255
    message = CompressedImage(format="png", data=encoded(red, "png")) if compressed else to_message(red)
    latch(node, "/image", message)
    assert main(["image", "show", "/image", "--once"]) == 0
    assert "\x1b[38;2;255;0;0;48;2;0;0;255m\u2580\x1b[0m\n1 x 2 bgr8\n" in capsys.readouterr().out


def test_a_broken_image_does_not_end_the_show(
    node: Node, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLORTERM", "truecolor")
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    latch(node, "/image", Image(height=2, width=2, encoding="bgr8", step=6, data=bytes(3)))
    assert main(["image", "show", "/image", "--timeout", "0.2"]) == 1
    said = capsys.readouterr()
    assert "2 x 2 pixels of bgr8 need 6 bytes a row" in said.out
    assert "no image on /image within 0.2 s" in said.err  # so it went on after the broken one


def test_without_a_terminal_it_says_what_to_do(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["image", "show", "/image", "--once"]) == 1
    assert "an image is drawn on a terminal, and the output is none" in capsys.readouterr().err
