"""Fixtures for tests of commands: files in a workspace of a test's own."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.workspace import VARIABLE
from tests.support.started import Write


@pytest.fixture
def write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Write:
    """Write a file of a workspace that is the working directory."""
    for folder in ("nodes", "configs"):
        (tmp_path / folder).mkdir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(VARIABLE, raising=False)

    def write(name: str, text: str) -> Path:
        (tmp_path / name).write_text(text)
        return tmp_path / name

    return write
