"""Processes of `multiprocessing` have ROS 2's names under `robolink run`, however they are started."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path

import pytest

from robolink.workspace.load import load_module
from tests.support.commands import PATIENCE

WORK = """
import multiprocessing as mp
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

def child(queue, text):
    queue.put((__name__, rclpy.__name__, text))

def all_of():
    for method in {methods}:
        context = mp.get_context(method)
        queue = context.Queue()
        process = context.Process(target=child, args=(queue, String(data="hi")))
        process.start()
        print(method, queue.get(timeout=20)[1:])
        process.join()
        print(process.exitcode)
"""
AS_SCRIPT = "\nif __name__ == '__main__':\n    all_of()\n"
AS_NODE = """
class Asking(Node):
    def __init__(self):
        super().__init__("asking")
        all_of()
        raise SystemExit(0)
"""
METHODS = ["spawn", "forkserver"] if sys.platform != "win32" else ["spawn"]


@pytest.mark.processes
@pytest.mark.parametrize("end", [AS_SCRIPT, AS_NODE], ids=["script", "node"])
def test_a_process_that_is_started_afresh_has_the_names(end: str, tmp_path: Path) -> None:
    file = tmp_path / "working.py"
    file.write_text(WORK.format(methods=METHODS) + end, encoding="utf-8")
    command = [sys.executable, "-m", "robolink", "run", str(file)]
    environ = {**os.environ, "ROBOLINK_NETWORK": "off"}
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, env=environ, check=False)
    expected = [f"{method} ('robolink', std_msgs.msg.String(data='hi'))\n0" for method in METHODS]
    assert (done.returncode, done.stdout.splitlines()) == (0, "\n".join(expected).splitlines()), done.stderr


def test_what_a_file_defines_can_be_pickled(tmp_path: Path) -> None:
    """The name of its module has dots, and pickle takes these for those of a package."""
    file = tmp_path / "a.folder" / "defining.py"
    file.parent.mkdir()
    file.write_text("class Thing:\n    pass\n", encoding="utf-8")
    module = load_module(file)
    assert pickle.loads(pickle.dumps(module.Thing)) is module.Thing
