"""The tests do not depend on the shell that starts them: a user of ROS 2 has its variables set."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOR_DOMAIN_0 = "tests/wire/test_humble.py::test_a_destroyed_service_leaves_humbles_key"
"""A test that compares keys on the network, which begin with the domain."""


@pytest.mark.processes
def test_a_domain_of_the_shell_does_not_reach_the_tests(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "pytest", "-q", "-n", "0", "-p", "no:cacheprovider"]
    done = subprocess.run(
        [*command, f"--basetemp={tmp_path / 'inner'}", FOR_DOMAIN_0],
        cwd=ROOT,
        env=os.environ | {"ROS_DOMAIN_ID": "81"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
