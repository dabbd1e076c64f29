"""The node sign_reader: signs of all sizes are read, other things are not, and the world's road is driven."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
import pytest

from robolink.interfaces.std_msgs.msg import String
from robolink.testing import System
from tests.support.nodefiles import load_node_file

reader = load_node_file("sign_reader")
PICTURES = reader.pictures_in(str(reader.PICTURES))
NAMES = sorted(each.stem for each in reader.PICTURES.glob("*.png"))
GREY = (140, 150, 145)


def image_with(name: str, side: int, left: int = 200, top: int = 100) -> Any:
    image = np.full((480, 640, 3), GREY, np.uint8)
    picture = cv2.imread(str(reader.PICTURES / f"{name}.png"))
    image[top : top + side, left : left + side] = cv2.resize(picture, (side, side), interpolation=cv2.INTER_AREA)
    return image


def test_all_pictures_are_signs() -> None:
    assert sorted(PICTURES) == NAMES
    assert len(NAMES) == 7


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("side", [40, 77, 150, 300])
def test_a_sign_is_read_at_any_size(name: str, side: int) -> None:
    (sign,) = reader.find_signs(image_with(name, side), PICTURES)
    assert sign.name == name
    assert abs(sign.width - side) <= 0.12 * side


def test_what_is_no_sign_is_not_read() -> None:
    image = np.full((480, 640, 3), GREY, np.uint8)
    cv2.circle(image, (100, 100), 60, (200, 60, 30), -1)  # a ball, in blue
    cv2.rectangle(image, (300, 300), (600, 340), (20, 20, 200), -1)  # a plank, in red
    cv2.rectangle(image, (300, 50), (400, 150), (20, 20, 200), -1)  # a box, in red
    assert reader.find_signs(image, PICTURES) == []


@pytest.mark.parametrize("shape", [(1, 1, 3), (480, 1, 3), (1, 640, 3)])
def test_an_image_of_any_shape_is_searched(shape: tuple[int, int, int]) -> None:
    assert reader.find_signs(np.zeros(shape, np.uint8), PICTURES) == []


def test_a_folder_without_signs_is_refused(system: System, tmp_path: Any) -> None:
    (tmp_path / "broken.png").write_bytes(b"no picture")
    node: Any = system.start("sign_reader")
    with pytest.raises(Exception, match=r"no \.png of a red or blue sign in the folder"):
        system.set_parameter(node, "pictures", str(tmp_path))


@pytest.mark.slow
def test_the_road_is_driven_by_its_signs(system: System) -> None:
    world: Any = system.start("world", parameters={"world": "signs"})
    system.start("sign_reader", parameters={"speed": 0.5})
    read: list[str] = []
    system.node.create_subscription(String, "sign", lambda sign: read.append(sign.data), 10)
    system.wait_until(lambda: "no_entry" in read, within=120.0)
    system.run(3.0)
    robot = world.simulation.world.robots["robot"]
    assert read == ["ahead", "speed_30", "yield", "right", "stop", "no_entry"]
    assert robot.twist.v == 0.0
    assert 6.0 < robot.pose.x < 7.5
    assert robot.pose.y == pytest.approx(0.75, abs=0.1)
