"""Fixtures for tests of robolink.compat: ROS 2's names as they were before."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from typing import Any

import pytest

from robolink import interfaces
from robolink.workspace.modules import FINDER
from tests.support.ros_names import MODE, forget


@pytest.fixture
def before(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Imports as they are without robolink.compat; nothing of it is left in this process."""
    monkeypatch.delenv(MODE, raising=False)
    monkeypatch.setattr(sys, "meta_path", [each for each in sys.meta_path if each is not FINDER])
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(FINDER, "makers", [])
    monkeypatch.setattr(FINDER, "hides", lambda _: False)
    monkeypatch.setattr(interfaces, "_sources", ())
    forget()
    yield
    forget()


@pytest.fixture
def compat(before: None) -> Any:
    return importlib.import_module("robolink.compat")
