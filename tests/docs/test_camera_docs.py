"""docs/camera.md: its programs run, and its figures are those of the tests."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robolink.image import to_array, to_message
from robolink.interfaces.sensor_msgs.msg import CameraInfo
from robolink.testing import System
from tests.support.opencvs_conversions import ENCODINGS

PAGE = (Path(__file__).parents[2] / "docs" / "camera.md").read_text(encoding="utf-8")
PROGRAMS = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)


class Publisher:
    def __init__(self) -> None:
        self.sent: list[Any] = []

    def publish(self, message: Any) -> None:
        self.sent.append(message)


@pytest.mark.parametrize("program", PROGRAMS[:2])
def test_programs_for_images(program: str) -> None:
    publisher = Publisher()
    scope: dict[str, Any] = {"publisher": publisher}
    exec(program, scope)
    scope["on_image"](to_message(np.zeros((4, 20, 3), np.uint8), "rgb8"))
    sent = to_array(publisher.sent[0])
    assert sent.shape == (4, 20, 3)
    assert publisher.sent[0].encoding == "bgr8"
    assert sent[0, 0].tolist() in ([0, 0, 255], [0, 0, 0])


def test_the_program_for_points() -> None:
    scope: dict[str, Any] = {}
    exec(PROGRAMS[2], scope)
    numbers = [100.0, 0.0, 50.0, 0.0, 0.0, 100.0, 40.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    scope["on_camera_info"](
        CameraInfo(width=100, height=80, k=[*numbers[:3], *numbers[4:7], *numbers[8:11]], p=numbers)
    )
    assert scope["camera"].project3dToPixel((0.1, 0.0, 2.0)) == (55.0, 40.0)


def test_the_program_for_shots(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (line,) = (each for each in PAGE.splitlines() if each.startswith("  - {camera: camera"))
    Path("my_world.yaml").write_text(f"robots:\n- name: robot\n  pose: [0, 0]\n  sensors:\n  {line}\n")
    scope: dict[str, Any] = {}
    exec(PROGRAMS[3], scope)
    assert (scope["image"].shape, scope["depths"].shape) == ((240, 320, 3), (240, 320))


def test_so_many_pairs_are_compared() -> None:
    count = len(ENCODINGS)
    assert f"all {count**2:,} pairs of {count} encodings" in " ".join(PAGE.split())


def test_the_program_that_drives_by_a_camera(system: System) -> None:
    (program,) = (each for each in PROGRAMS if "ImageController" in each)
    scope: dict[str, Any] = {}
    exec(program, scope)
    system.start("world", parameters={"world": "track"})
    system.start(scope["Follower"])
    system.run(30.0)
    robot = system.robot()
    assert robot.pose.x > 4.0
    assert robot.pose.y > 3.5  # round two bends
    assert robot.contacts == 0
