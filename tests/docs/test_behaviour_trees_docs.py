"""docs/howto/behaviour_trees.md: py_trees' own timers in virtual time; its blocks are run by test_pages_run.py."""

from __future__ import annotations

from pathlib import Path

from robolink.testing import System


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
