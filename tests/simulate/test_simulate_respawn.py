"""A node that can never be made is given up in virtual time too, after delays whose sums no binary number is."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.simulations import workspace

pytestmark = pytest.mark.processes

NEVER = """
from robolink import Node

class Never(Node):
    def __init__(self):
        super().__init__("never")
        raise RuntimeError("no camera")
"""
FILE = "nodes:\n- {node: never, respawn: {when: on_failure, delay: %s, most: 6}, on_exit: ignore}\n- {node: talker}\n"


@pytest.mark.parametrize("delay", [0.1, 0.3])
def test_it_is_given_up_and_the_others_go_on(tmp_path: Path, delay: float) -> None:
    """In a process of its own: time once stood still here for ever, at 0.30000000000000004 s."""
    workspace(tmp_path, again=FILE % delay)
    (tmp_path / "nodes" / "never.py").write_text(NEVER)
    command = [sys.executable, "-m", "robolink", "simulate", "again", "--duration", "50", "--json"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    result = json.loads(run.stdout)
    begins = [sum(delay * 2**each for each in range(count)) for count in range(7)]
    assert result["failures"] == [
        f"never ended with exit code 1 at {at:.3f} s: RuntimeError: no camera" for at in begins
    ]
    assert result["messages"]["/chatter"] == 500
    assert run.stderr.count("no camera; starting it again") == 1
    assert run.stderr.count("as before: starting it again") == 5
    assert run.stderr.count("as before: given up after 6 new starts within 60 s") == 1
