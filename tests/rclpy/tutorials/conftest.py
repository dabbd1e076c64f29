"""Fixture of the tests of ROS 2's tutorials for Python: a workspace, of which nothing is left in this process."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import interfaces
from robolink.workspace import VARIABLE
from robolink.workspace.interfaces import WORKSPACE_TYPES
from robolink.workspace.modules import FINDER
from tests.support.ros_names import forget
from tests.support.tutorial_workspace import TutorialWorkspace


@pytest.fixture
def ros2_ws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Iterator[TutorialWorkspace]:
    folder = tmp_path.resolve() / "ros2_ws"
    (folder / "src").mkdir(parents=True)
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setenv("ROBOLINK_LOG_DIR", str(tmp_path / "log"))
    monkeypatch.setenv("ROBOLINK_SHARE_DIR", str(tmp_path / "share"))
    monkeypatch.chdir(folder)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(FINDER, "makers", list(FINDER.makers))
    monkeypatch.setattr(FINDER, "hides", FINDER.hides)
    monkeypatch.setattr(interfaces, "_sources", ())
    monkeypatch.setattr(WORKSPACE_TYPES, "_added", [])
    yield TutorialWorkspace(folder, capsys)
    forget()
    packages = {each.name for each in (folder / "src").iterdir()}
    for name in [each for each in sys.modules if each.partition(".")[0] in packages]:
        del sys.modules[name]
