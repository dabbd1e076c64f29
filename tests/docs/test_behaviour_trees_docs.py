"""docs/behaviour_trees.md: its program wanders, and its test passes."""

from __future__ import annotations

import re
from pathlib import Path
from types import ModuleType

import pytest

from robolink.testing import System

PAGE = (Path(__file__).parents[2] / "docs" / "behaviour_trees.md").read_text(encoding="utf-8")
PROGRAM, TEST = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.slow
def test_the_test_of_the_page_passes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "wanderer.py").write_text(PROGRAM, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    made = ModuleType("test_wanderer")
    exec(TEST, made.__dict__)
    with System(seed=1) as system:
        made.test_it_wanders_and_touches_nothing(system)


def test_timers_of_py_trees_go_by_simulated_time(system: System, tmp_path: Path) -> None:
    text = """
import rclpy
from py_trees.timers import Timer
rclpy.init()
node, timer = rclpy.create_node("waiting"), Timer("timer", 3600.0)
node.create_timer(60.0, timer.tick_once)
node.create_timer(60.0, lambda: node.get_logger().info(timer.status.name))
rclpy.spin(node)
"""
    (tmp_path / "waiting.py").write_text(text, encoding="utf-8")
    system.start(str(tmp_path / "waiting.py"))
    system.run(3800.0)
    said = [each.message for each in system.logs if each.message in ("RUNNING", "SUCCESS")]
    assert said[:60] == ["RUNNING"] * 60
    assert "SUCCESS" in said
