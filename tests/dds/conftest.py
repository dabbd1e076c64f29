"""Scenes with a real ROS 2, of the wheels that `python -m tests.judge.wheels` installs; without them tests are skipped.

A scene has two peers, one of a real ROS 2 and one of robolink, which meets it over DDS by itself ("direct", `--network
dds`) or over Zenoh beside `robolink bridge dds` ("bridge"). Tests share a scene, each with topics of its own.
"""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from robolink.dds import transport as dds_transport
from robolink.dds.transport import DdsTransport
from tests.dds.peers import Peer, environment
from tests.judge.programs import TEST_MSGS
from tests.judge.wheels import DISTRIBUTIONS, NoWheelsError, installed
from tests.support.commands import ROBOLINK, Command
from tests.support.dds_others import open_session
from tests.support.domains import free_dds_domain
from tests.support.fake_rtps import FakeNetwork

PROGRAMS = Path(__file__).parent / "programs"


def real(name: str) -> list[str]:
    """Return the command of a real ROS 2's Python; skip the test where there is none."""
    try:
        return installed(DISTRIBUTIONS[name])
    except NoWheelsError as reason:
        pytest.skip(f"no real ROS 2 {name}: {reason}")


class Lab(NamedTuple):
    """A domain, and a folder with the programs; `test_msgs` is known there, but not to a bridge."""

    domain: int
    folder: Path

    def real(self, distribution: str, name: str = "real") -> Peer:
        return Peer(real(distribution), name, environment(self.domain), self.folder)

    def direct(self, name: str = "ours") -> Peer:
        """Start robolink's on DDS by itself."""
        environ = environment(self.domain, ROBOLINK_NETWORK="dds")
        return Peer([*ROBOLINK, "run"], name, environ, self.folder)

    def beside(self, name: str = "ours") -> Peer:
        """Start robolink's on Zenoh."""
        return Peer([*ROBOLINK, "run"], name, environment(self.domain), self.folder)

    def bridge(self) -> Command:
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir(exist_ok=True)
        return Command(self.domain, "bridge", "dds", folder=elsewhere)

    def command(self, way: str, *words: str, merged: bool = False) -> Command:
        """Start a command of robolink on the network of robolink's peer."""
        environ = {"ROBOLINK_NETWORK": "dds"} if way == "direct" else {}
        return Command(self.domain, *words, environ=environ, folder=self.folder, merged=merged)


class Scene(NamedTuple):
    """A real ROS 2's peer /lab/real and robolink's /lab/ours that can meet."""

    lab: Lab
    distribution: str
    way: str
    real: Peer
    ours: Peer


@pytest.fixture(scope="session")
def programs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the programs, beside the package test_msgs as a workspace has it."""
    folder = tmp_path_factory.mktemp("programs")
    shutil.copytree(PROGRAMS, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(TEST_MSGS, folder / "interfaces" / "test_msgs")
    return folder


@pytest.fixture
def lab(programs: Path) -> Iterator[Lab]:
    """A domain of its own for a test that starts and ends processes."""
    with free_dds_domain() as domain:
        yield Lab(domain, programs)


WAYS = [(distribution, way) for way in ("direct", "bridge") for distribution in ("kilted", "jazzy")]


@pytest.fixture(scope="session", params=WAYS, ids="-".join)
def scene(request: pytest.FixtureRequest, programs: Path) -> Iterator[Scene]:
    """A real ROS 2 and robolink, each way: the same processes for all tests of a way."""
    distribution, way = request.param
    real(distribution)
    with contextlib.ExitStack() as stack:
        lab = Lab(stack.enter_context(free_dds_domain()), programs)
        theirs = stack.enter_context(lab.real(distribution))
        if way == "bridge":
            stack.enter_context(lab.bridge())
        ours = stack.enter_context(lab.direct() if way == "direct" else lab.beside())
        yield Scene(lab, distribution, way, theirs.ready(), ours.ready())


@pytest.fixture
def fake(monkeypatch: pytest.MonkeyPatch) -> Iterator[FakeNetwork]:
    """A DDS network in memory."""
    monkeypatch.setattr(dds_transport, "FIRST", 0.02)  # nobody takes long here
    monkeypatch.setattr(dds_transport, "PATIENCE", 0.1)
    network = FakeNetwork()
    yield network
    network.close()


@pytest.fixture
def ours(fake: FakeNetwork) -> Iterator[DdsTransport]:
    """A session on it."""
    session = open_session(fake)
    yield session
    session.close()
