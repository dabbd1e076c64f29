"""A whole robot system in one process: a minute of its life in well under a second, twice the same byte for byte."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest

from robolink import logging
from tests import traces


@pytest.mark.timeout(30)
def test_a_minute_of_a_robots_life_is_the_same_twice_byte_for_byte(capfd: pytest.CaptureFixture[str]) -> None:
    logging.set_console_handler(None)
    first, again = traces.follow(60.0, speed=0.4), traces.follow(60.0, speed=0.4)
    assert first.hexdigest() == again.hexdigest()
    assert first.messages == again.messages
    assert [first.messages[topic] for topic in ("/scan", "/odom", "/tf")] == pytest.approx([600, 3000, 3000], abs=1)
    assert first.messages["/cmd_vel"] == pytest.approx(first.messages["/scan"], abs=1)
    assert first.messages["/rosout"] > 30
    assert capfd.readouterr() == ("", "")


def test_another_robot_leaves_another_trace() -> None:
    logging.set_console_handler(None)
    assert traces.follow(2.0, speed=0.4).hexdigest() != traces.follow(2.0, speed=0.3).hexdigest()


def test_a_noisy_laboratory_is_the_same_in_two_processes() -> None:
    """The same on other Pythons too: .ci/run compares them."""
    hashes = [
        subprocess.run(
            [sys.executable, "-m", "tests.traces", "5"],
            env={**os.environ, "PYTHONHASHSEED": seed},
            stdout=subprocess.PIPE,
            text=True,
            check=True,
            timeout=60,
        ).stdout
        for seed in ("1", "2")
    ]
    assert hashes[0] == hashes[1]
    assert re.fullmatch(r"[0-9a-f]{64}\n", hashes[0])
