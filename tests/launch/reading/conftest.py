"""Fixtures for tests of reading launch files: a workspace with the files of a fleet."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.launch_configs import CONFIGS
from tests.support.launchfiles import make_workspace


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return make_workspace(tmp_path, monkeypatch, **CONFIGS)
