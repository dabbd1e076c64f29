"""Fixtures for tests of ROS 2's launch files."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink.workspace.modules import FINDER
from tests.support.ros_launch import make_package
from tests.support.ros_names import forget


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Package `bot` in a workspace; ROS 2's names and the package's modules are as before afterwards."""
    monkeypatch.setattr(FINDER, "makers", list(FINDER.makers))
    monkeypatch.setattr(FINDER, "hides", FINDER.hides)
    monkeypatch.setattr(sys, "path", list(sys.path))
    yield make_package(tmp_path.resolve(), monkeypatch)
    forget()
    for name in [each for each in sys.modules if each.partition(".")[0] == "bot"]:
        del sys.modules[name]
