"""Fixtures for tests of robolink interface: a workspace with types of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.workspace import VARIABLE
from tests.support.shown_types import ASK, DO, INNER, OUTER, Workspace


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Workspace:
    """Write an interface file of the package lab_msgs, in a workspace that is the working directory."""
    (tmp_path / "nodes").mkdir()
    (tmp_path / "configs").mkdir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://nobody")

    def write(name: str, text: str) -> None:
        path = tmp_path / "interfaces" / "lab_msgs" / name.rpartition(".")[2] / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    write("Inner.msg", INNER)
    write("Outer.msg", OUTER)
    write("Ask.srv", ASK)
    write("Do.action", DO)
    return write
