"""Fixtures for tests of the world's node: a hall and its world."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robolink.testing import System
from tests.support.halls import HALL, simulation


@pytest.fixture
def hall(tmp_path: Path) -> str:
    path = tmp_path / "hall.yaml"
    path.write_text(HALL)
    return str(path)


@pytest.fixture
def world(system: System, hall: str) -> Any:
    return system.start(simulation.SimulatedWorld, parameters={"world": hall})
