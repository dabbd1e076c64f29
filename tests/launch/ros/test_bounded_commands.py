"""Substitutions that read a file or run a command stop reading where it is too much, and say so."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from robolink.launch.ros.launch import LaunchContext, commands
from robolink.launch.ros.launch.substitutions import Command, FileContent, SubstitutionFailure


@pytest.fixture(autouse=True)
def low(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(commands, "LONGEST", 1000)


def test_a_file_is_read_up_to_a_limit(tmp_path: Path) -> None:
    path = tmp_path / "robot.urdf"
    path.write_bytes("<robot name='\u00e9'/>\r\n".encode())
    assert FileContent(str(path)).perform(LaunchContext()) == "<robot name='\u00e9'/>\n"
    path.write_bytes(b"x" * 1001)
    with pytest.raises(SubstitutionFailure, match="cannot be read: it is longer than 1 kB"):
        FileContent(str(path)).perform(LaunchContext())


@pytest.mark.processes
@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_command_that_writes_for_ever_is_ended(stream: str) -> None:
    endless = f"import sys\nwhile True: sys.{stream}.write('x' * 10000)"
    with pytest.raises(SubstitutionFailure, match="it writes more than 1,000 bytes"):
        Command([f'"{sys.executable}" -c "{endless}"']).perform(LaunchContext())


@pytest.mark.processes
def test_what_a_command_writes_is_its_output() -> None:
    said = "import sys; sys.stdout.write('out'); sys.stderr.write('err')"
    assert Command([f'"{sys.executable}" -c "{said}"'], on_stderr="ignore").perform(LaunchContext()) == "out"
    both = Command([f'"{sys.executable}" -c "{said}"'], on_stderr="capture").perform(LaunchContext())
    assert both in ("outerr", "errout")
