"""Cheating wins no race: the world's services and parameters, a forged answer, and the end of a rival."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.grading.mistakes import Mistake
from robolink.race.apart import race_all, run_one
from robolink.race.driving import Drive
from robolink.race.races import RACES

FOLLOW = RACES["follow"]._replace(seconds=3.0)
CALLS = """
import rclpy
from rclpy.node import Node
from rcl_interfaces.srv import SetParameters
from rclpy.parameter import Parameter
from robolink_interfaces.srv import Teleport


class Cheat(Node):
    def __init__(self):
        super().__init__("cheat")
        self.teleport = self.create_client(Teleport, "/world/teleport")
        self.set = self.create_client(SetParameters, "/world/set_parameters")
        self.count = 0
        self.create_timer(0.05, self.on_timer)

    def on_timer(self):
        self.count += 1
        if self.count == 1:
            rate = Parameter("rtf", value=50.0).to_parameter_msg()
            self.answer = self.set.call_async(SetParameters.Request(parameters=[rate]))
        if self.answer.done() and self.answer.result().results[0].successful:
            raise RuntimeError("the world can be made faster")
        if self.teleport.service_is_ready():
            raise RuntimeError("the world has teleport")


rclpy.init()
rclpy.spin(Cheat())
"""
FORGES = """
import json
import os
import sys

answer = {"program": "me", "score": 1.0, "progress": 1.0, "contacts": 0, "hash": "0" * 64, "mistake": None}
with open(sys.orig_argv[-1], "w") as file:
    json.dump(answer, file)
os._exit(0)
"""
ENDS_OTHERS = """
import os
import signal

import psutil

for each in psutil.process_iter(["cmdline", "name"]):
    line = each.info["cmdline"] or []
    if "race-run" in line and "MARK" in " ".join(line) and each.pid != os.getpid():
        os.kill(each.pid, signal.SIGKILL)
"""
STANDS = "import rclpy\nfrom rclpy.node import Node\nrclpy.init()\nrclpy.spin(Node('stands'))\n"


def test_a_world_in_a_race_has_no_services_and_parameters_that_move_robots(tmp_path: Path) -> None:
    (tmp_path / "cheat.py").write_text(CALLS)
    result = Drive(FOLLOW, str(tmp_path / "cheat.py"), 1).run()
    assert (result.mistake, result.score) == (None, 0.0)


@pytest.mark.processes
def test_a_forged_answer_is_none(tmp_path: Path) -> None:
    (tmp_path / "forges.py").write_text(FORGES)
    result = run_one(FOLLOW, str(tmp_path / "forges.py"), 1)
    assert (result.score, result.mistake) == (None, Mistake("ended all"))


@pytest.mark.processes
def test_who_is_ended_by_another_one_runs_again(tmp_path: Path) -> None:
    for name in ("ends.py", "victim.py"):
        (tmp_path / name).write_text(ENDS_OTHERS.replace("MARK", f"{tmp_path}/victim") if name == "ends.py" else STANDS)
    done: list[str] = []
    programs = [str(tmp_path / "victim.py"), str(tmp_path / "ends.py")]
    victim, _ = race_all(FOLLOW, programs, 1, on_done=lambda each: done.append(each.program))
    assert (victim.score, victim.mistake) == (0.0, None)
    assert sorted(done) == sorted(programs)
