"""Fixtures for tests of robolink launch: a workspace with a small system."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path
from typing import Any

import pytest

from robolink.supervisor import Process, Supervisor
from robolink.workspace import VARIABLE
from tests.support.launched_systems import LISTENER, SYSTEM, TALKER


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for folder in ("nodes", "configs", "configs/worlds"):
        (tmp_path / folder).mkdir()
    (tmp_path / "nodes" / "talker.py").write_text(TALKER)
    (tmp_path / "nodes" / "listener.py").write_text(LISTENER)
    (tmp_path / "configs" / "talk.yaml").write_text(SYSTEM)
    (tmp_path / "configs" / "none.yaml").write_text("nodes: [node: talker]\n")
    monkeypatch.setenv("ROBOLINK_LOG_DIR", str(tmp_path / "log"))
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path.resolve()


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[list[Process]]:
    """Record of what is started: nothing runs."""
    found: list[list[Process]] = []

    class Fake(Supervisor):
        def __init__(self, processes: Sequence[Process], **settings: Any) -> None:
            super().__init__(processes, **settings)
            found.append(list(processes))

        def run(self, duration: float | None = None, beside: Iterable[AbstractContextManager[object]] = ()) -> int:
            with ExitStack() as stack:
                for each in beside:
                    stack.enter_context(each)
                return 7

    monkeypatch.setattr("robolink.launch.command.Supervisor", Fake)
    return found
