"""Launchers leave nothing behind; what a killed one has left, or another program, is cleared or passed over."""

from __future__ import annotations

import os
import socket
import subprocess
import threading
from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.cli.main import main
from robolink.supervisor.control import client, protocol, registry
from robolink.supervisor.control.client import LauncherError, LauncherGoneError, running
from robolink.supervisor.control.registry import Registration, new_place, register, runtime_folder
from robolink.supervisor.control.server import Control
from tests.support.launchers import PATIENCE, FakeSupervisor, files_in, the_only


def test_nothing_is_left_after_an_orderly_end(kind: str, folder: Path, supervisor: FakeSupervisor) -> None:
    before = set(threading.enumerate())
    with Control(supervisor, name="follow"):
        assert files_in(folder)
        assert len(set(threading.enumerate()) - before) == 1
    assert files_in(folder) == []
    assert set(threading.enumerate()) <= before
    assert running() == []


@pytest.mark.processes
def test_a_killed_launcher_is_cleared_by_who_looks(folder: Path, elsewhere: subprocess.Popen[bytes]) -> None:
    launcher = the_only()
    elsewhere.kill()
    elsewhere.wait(PATIENCE)
    with pytest.raises(LauncherGoneError, match=r"elsewhere \(pid \d+\) runs no more"):
        launcher.status()
    assert files_in(folder) == []
    assert running() == []


@pytest.mark.processes
def test_the_next_launcher_clears_it_away_too(
    folder: Path, elsewhere: subprocess.Popen[bytes], supervisor: FakeSupervisor
) -> None:
    elsewhere.kill()
    elsewhere.wait(PATIENCE)
    left = files_in(folder)
    assert left
    with Control(supervisor, name="follow"):
        ours = next(each for each in client._registered() if each.pid == os.getpid())
        assert ours.status().nodes == supervisor.nodes  # it looks around before it answers
        assert not set(left) & set(files_in(folder))
    assert files_in(folder) == []


def test_a_pid_alone_is_no_proof(launched: Control, folder: Path) -> None:
    """Our own process lives, but nobody listens where this says."""
    place = new_place(runtime_folder())
    address = str(place.with_suffix(".sock")) if protocol.AF_UNIX is not None else 1
    alive = the_only()
    register(place, Registration(alive.pid, "killed", "", address, "00", 0.0))
    assert [each.name for each in running()] == ["follow"]
    assert not place.with_suffix(".json").exists()


def test_a_port_that_another_program_has_now_is_no_proof(folder: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        place = new_place(runtime_folder())
        register(place, Registration(0x7FFFFFF0, "killed", "", other.getsockname()[1], "00", 0.0))
        assert running() == []
    assert files_in(folder) == []


def test_what_was_left_half_written_is_cleared_once_it_is_old(
    folder: Path, launched: Control, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours = files_in(folder)
    for name in ("a.part", "b.json", "c.sock"):
        (runtime_folder() / f"launch-{os.getpid()}-{name}").write_text('{"pid": "what?"')
    assert len(running()) == 1
    assert len(files_in(folder)) == len(ours) + 3  # perhaps it is just being written
    monkeypatch.setattr(registry, "_UNFINISHED", -1.0)
    assert len(running()) == 1
    assert files_in(folder) == ours


def test_what_the_killed_left_half_written_is_cleared_at_once(folder: Path, launched: Control) -> None:
    ours = files_in(folder)
    for name in (f"launch-{0x7FFFFFF0}-a.part", f"launch-{0x7FFFFFF0}-b.sock", "launch-²-c.sock", "launch-no-d.json"):
        (runtime_folder() / name).write_text("")
    assert len(running()) == 1
    assert files_in(folder) == ours


@pytest.mark.parametrize("removed", range(3))
def test_whoever_is_killed_as_it_clears_leaves_what_can_be_cleared(folder: Path, removed: int) -> None:
    place = new_place(runtime_folder())
    for each in registry.files_at(place):
        each.touch()
    killed = Registration(0x7FFFFFF0, "killed", "", str(place.with_suffix(".sock")), "", 0.0)
    register(place.with_name("launch"), killed)
    place.with_name("launch.json").replace(place.with_suffix(".json"))
    for each in registry.files_at(place)[:removed]:
        each.unlink()
    client.clear_away()
    assert files_in(folder) == []


@given(st.binary(max_size=200) | st.recursive(st.none() | st.text() | st.integers(), st.lists).map(msgspec.json.encode))
def test_any_file_in_the_folder_is_passed_over(written: bytes) -> None:
    place = new_place(runtime_folder())
    place.with_suffix(".json").write_bytes(written)
    assert running() == []
    place.with_suffix(".json").unlink()


@given(
    st.builds(
        Registration,
        pid=st.integers(-(2**63), 2**63 - 1) | st.integers(0, 3),
        name=st.text(max_size=10),
        file=st.text(max_size=10),
        address=st.integers(-(2**63), 2**63 - 1) | st.text(max_size=200),
        key=st.text(max_size=10) | st.binary(max_size=4).map(bytes.hex),
        registered=st.floats(allow_nan=False, allow_infinity=False),
    )
)
def test_any_registration_can_be_asked(registration: Registration) -> None:
    place = new_place(runtime_folder())
    register(place, registration)
    for launcher in client._registered():
        with pytest.raises(LauncherError):
            launcher.status()
    client.clear_away()
    assert main(["launch", "--status"]) == 0
    registry.unregister(place)
