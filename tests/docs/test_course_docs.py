"""docs/reference/course_camera.md: its programs do in other worlds what it says; test_pages_run.py runs its blocks."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from robolink.testing import System
from tools.docs_site.markdown import blocks

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "course_camera.md").read_text(encoding="utf-8")
FILES = {each.title: each.text for each in blocks(PAGE) if each.title}
WORLD = FILES["line.yaml"]


@pytest.fixture(autouse=True)
def _files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)


def test_the_line_is_seen(system: System) -> None:
    system.start("world", parameters={"world": "line.yaml"})
    system.start("see_line.py")
    system.run(1.5)
    seen = [each.message for each in system.logs if each.message.startswith("the line is at")]
    assert seen
    assert all(re.fullmatch(r"the line is at \d+, \d+", each) for each in seen)


@pytest.mark.slow
def test_exercises_have_a_solution(system: System, tmp_path: Path) -> None:
    """The other way round, and with odometry that errs: the same program follows the line."""
    text = WORLD.replace("[2, 1.1, 0]", "[2, 1, 3.1416]\n    odom: {scale: {v: 1.02, w: 0.97}, drift: 0.02}")
    (tmp_path / "line.yaml").write_text(text, encoding="utf-8")
    system.start("world", parameters={"world": "line.yaml"})
    system.start("follow_line.py", parameters={"kp": 2.0})
    odometry, truth = system.messages("/odom"), system.messages("/ground_truth")
    system.run(60.0)
    assert system.robot().driven > 9.0
    assert abs(odometry[-1].pose.pose.position.x - truth[-1].pose.pose.position.x) > 0.1
    area = system.robot().area
    assert (area.x_min, area.y_min) == pytest.approx((1.0, 1.0), abs=0.1)
    assert (area.x_max, area.y_max) == pytest.approx((5.0, 3.65), abs=0.1)  # the corners of the line are round


@pytest.mark.slow
def test_gains_do_what_the_page_says(tmp_path: Path) -> None:
    spreads = []
    for gains in ({"kp": 10.0}, {"kp": 10.0, "kd": 0.4}):
        with System(seed=1) as system:
            system.start("world", parameters={"world": "line.yaml"})
            system.start("follow_line.py", parameters=gains)
            commands = system.messages("/cmd_vel")
            system.run(30.0)
            spreads.append(float(np.std([each.angular.z for each in commands[50:]])))
    assert spreads[0] > 3 * spreads[1]
