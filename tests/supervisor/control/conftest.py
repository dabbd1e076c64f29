"""A launcher that can be asked, in a runtime folder of its own; and one in another process."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink.supervisor.control import protocol, server
from robolink.supervisor.control.server import Control
from tests.support.launchers import FakeSupervisor, launcher_elsewhere, own_runtime_folder


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    with own_runtime_folder(monkeypatch) as made:
        yield made


@pytest.fixture(params=["path", "port"])
def kind(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Both kinds of sockets: Windows has only the second."""
    if request.param == "port":
        for module in (protocol, server):
            monkeypatch.setattr(module, "AF_UNIX", None)
    elif protocol.AF_UNIX is None:
        pytest.skip("this system's sockets have no paths")
    return str(request.param)


@pytest.fixture
def supervisor() -> FakeSupervisor:
    return FakeSupervisor("world", "robot_1/wall_follower")


@pytest.fixture
def launched(supervisor: FakeSupervisor) -> Iterator[Control]:
    with Control(supervisor, name="follow", file="/somewhere/follow.yaml") as made:
        yield made


@pytest.fixture
def elsewhere(folder: Path) -> Iterator[subprocess.Popen[bytes]]:
    """A launcher in another process."""
    with launcher_elsewhere(folder) as process:
        yield process
