"""A running launcher is found and asked from elsewhere, leaves nothing behind, and nobody can disturb it."""

from __future__ import annotations

import os
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.cli import main
from robolink.exceptions import RobolinkError
from robolink.supervisor.door import asking, control, runtime, talk
from robolink.supervisor.door.asking import LauncherError, LauncherGoneError, running
from robolink.supervisor.door.control import Control
from robolink.supervisor.door.runtime import Registration, RuntimeFolderError, new_place, register, runtime_folder
from robolink.supervisor.door.talk import Line, Question, connect
from tests.launchers import FakeSupervisor, files_in, launcher_elsewhere, own_runtime_folder

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="modes, owners and SIGSTOP are POSIX's")
PATIENCE = 30.0


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    with own_runtime_folder(monkeypatch) as made:
        yield made


@pytest.fixture(params=["path", "port"])
def kind(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Both kinds of sockets: Windows has only the second."""
    if request.param == "port":
        for module in (talk, control):
            monkeypatch.setattr(module, "AF_UNIX", None)
    elif talk.AF_UNIX is None:
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


def the_only() -> asking.Launcher:
    (launcher,) = running()
    return launcher


# --- asking ---------------------------------------------------------------------------------------------------


def test_a_launcher_is_found_and_tells_its_status(kind: str, supervisor: FakeSupervisor) -> None:
    with Control(supervisor, name="follow", file="/somewhere/follow.yaml", members={"world": ["lidar", "camera"]}):
        launcher = the_only()
        answer = launcher.status()
    assert (launcher.name, launcher.file) == ("follow", "/somewhere/follow.yaml")
    assert answer.nodes == supervisor.nodes
    assert answer.members == {"world": ["lidar", "camera"]}


def test_a_node_is_restarted(kind: str, supervisor: FakeSupervisor) -> None:
    with Control(supervisor, name="follow"):
        the_only().restart("robot_1/wall_follower")
    assert supervisor.restarted == ["robot_1/wall_follower"]


def test_an_unknown_node_is_refused_with_the_nearest(supervisor: FakeSupervisor, launched: Control) -> None:
    with pytest.raises(LauncherError, match=r"no node named 'wrld' in 'follow' \(did you mean 'world'\?\)"):
        the_only().restart("wrld")
    assert supervisor.restarted == []


def test_what_asks_for_a_restart_learns_why_not(supervisor: FakeSupervisor, launched: Control) -> None:
    supervisor.why_not = "the system is stopping"
    with pytest.raises(LauncherError, match="'world' of 'follow' is not restarted: the system is stopping"):
        the_only().restart("world")
    assert supervisor.restarted == []


def test_whoever_asks_for_an_end_waits_for_it(kind: str, supervisor: FakeSupervisor) -> None:
    with ThreadPoolExecutor(1) as pool:
        with Control(supervisor, name="follow"):
            stopping = pool.submit(the_only().stop, PATIENCE)
            assert supervisor.stopped.wait(PATIENCE)
            assert not stopping.done()
        assert stopping.result(PATIENCE)


def test_an_end_that_does_not_come_is_not_waited_for_for_ever(launched: Control, supervisor: FakeSupervisor) -> None:
    assert not the_only().stop(patience=0.01)
    assert supervisor.stopped.is_set()


def test_fifty_may_ask_at_once(launched: Control, supervisor: FakeSupervisor) -> None:
    with ThreadPoolExecutor(50) as pool:
        answers = list(pool.map(lambda _: the_only().status().nodes, range(50)))
    assert answers == [supervisor.nodes] * 50


# --- what is left ---------------------------------------------------------------------------------------------


def test_nothing_is_left_after_an_orderly_end(kind: str, folder: Path, supervisor: FakeSupervisor) -> None:
    before = threading.active_count()
    with Control(supervisor, name="follow"):
        assert files_in(folder)
        assert threading.active_count() == before + 1
    assert files_in(folder) == []
    assert threading.active_count() == before
    assert running() == []


@posix_only
def test_nobody_else_can_read_what_is_left(launched: Control, folder: Path) -> None:
    for each in (folder / "robolink").iterdir():
        assert stat.S_IMODE(each.stat().st_mode) == 0o600
    assert stat.S_IMODE((folder / "robolink").stat().st_mode) == 0o700


def test_a_killed_launcher_is_cleared_by_who_looks(folder: Path, elsewhere: subprocess.Popen[bytes]) -> None:
    launcher = the_only()
    elsewhere.kill()
    elsewhere.wait(PATIENCE)
    with pytest.raises(LauncherGoneError, match=r"elsewhere \(pid \d+\) runs no more"):
        launcher.status()
    assert files_in(folder) == []
    assert running() == []


def test_the_next_launcher_clears_it_away_too(
    folder: Path, elsewhere: subprocess.Popen[bytes], supervisor: FakeSupervisor
) -> None:
    elsewhere.kill()
    elsewhere.wait(PATIENCE)
    left = files_in(folder)
    assert left
    with Control(supervisor, name="follow"):
        ours = next(each for each in asking._registered() if each.pid == os.getpid())
        assert ours.status().nodes == supervisor.nodes  # it looks around before it answers
        assert not set(left) & set(files_in(folder))
    assert files_in(folder) == []


def test_a_pid_alone_is_no_proof(launched: Control, folder: Path) -> None:
    """Our own process lives, but nobody listens where this says."""
    place = new_place(runtime_folder())
    address = str(place.with_suffix(".sock")) if talk.AF_UNIX is not None else 1
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


@posix_only
def test_a_paused_launcher_is_told_of(elsewhere: subprocess.Popen[bytes], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(asking, "ANSWER_WITHIN", 0.2)
    elsewhere.send_signal(signal.SIGSTOP)
    with pytest.raises(LauncherError, match=r"does not answer: no word in time.*Ctrl-Z") as caught:
        the_only().status()
    assert not isinstance(caught.value, LauncherGoneError)
    elsewhere.send_signal(signal.SIGCONT)
    monkeypatch.setattr(asking, "ANSWER_WITHIN", PATIENCE)
    assert [each.name for each in the_only().status().nodes] == ["talker"]


def test_what_was_left_half_written_is_cleared_once_it_is_old(
    folder: Path, launched: Control, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours = files_in(folder)
    for name in ("a.part", "b.json", "c.sock"):
        (runtime_folder() / f"launch-{os.getpid()}-{name}").write_text('{"pid": "what?"')
    assert len(running()) == 1
    assert len(files_in(folder)) == len(ours) + 3  # perhaps it is just being written
    monkeypatch.setattr(runtime, "_UNFINISHED", -1.0)
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
    for each in runtime.files_at(place):
        each.touch()
    killed = Registration(0x7FFFFFF0, "killed", "", str(place.with_suffix(".sock")), "", 0.0)
    register(place.with_name("launch"), killed)
    place.with_name("launch.json").replace(place.with_suffix(".json"))
    for each in runtime.files_at(place)[:removed]:
        each.unlink()
    asking.clear_away()
    assert files_in(folder) == []


# --- strangers ------------------------------------------------------------------------------------------------


def address_of(launcher: asking.Launcher) -> str | int:
    return launcher._registration.address


def says_garbage(connection: socket.socket) -> None:
    connection.sendall(b"GET / HTTP/1.1\r\nHost: robot\r\n\r\n")


def says_without_the_key(connection: socket.socket) -> None:
    line = Line(connection, "00" * 32, time.monotonic() + PATIENCE)
    with pytest.raises((EOFError, ConnectionError)):
        greeted_and_asked(line)


def greeted_and_asked(line: Line) -> None:
    line.be_greeted()
    line.ask(Question("stop"))


def says_too_much(connection: socket.socket) -> None:
    try:
        for _ in range(1 << 8):
            connection.sendall(b"x" * (1 << 16))
    except OSError:  # it has hung up by then
        return


def says_half(connection: socket.socket) -> None:
    connection.sendall(b"0123 {")


def says_nothing(connection: socket.socket) -> None:
    return


def wait_for_the_end(connection: socket.socket) -> None:
    try:
        while connection.recv(1 << 16):
            continue
    except ConnectionError:
        return


STRANGERS = [says_garbage, says_without_the_key, says_too_much, says_half, says_nothing]


@pytest.mark.parametrize("behave", STRANGERS)
def test_a_stranger_disturbs_nobody(
    kind: str, behave: Callable[[socket.socket], None], supervisor: FakeSupervisor
) -> None:
    with Control(supervisor, name="follow", patience=PATIENCE):
        launcher = the_only()
        with connect(address_of(launcher), PATIENCE) as connection:
            behave(connection)
            assert launcher.status().nodes == supervisor.nodes
    assert not supervisor.stopped.is_set()


@pytest.mark.parametrize("behave", STRANGERS)
def test_a_stranger_is_hung_up_on(
    kind: str, behave: Callable[[socket.socket], None], supervisor: FakeSupervisor
) -> None:
    with Control(supervisor, name="follow", patience=0.1), connect(address_of(the_only()), PATIENCE) as connection:
        behave(connection)
        wait_for_the_end(connection)


def test_a_hundred_that_say_nothing_only_make_others_wait(
    supervisor: FakeSupervisor, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(asking, "ANSWER_WITHIN", PATIENCE)
    with Control(supervisor, name="follow", patience=PATIENCE), ThreadPoolExecutor(1) as pool:
        launcher = the_only()
        silent = [connect(address_of(launcher), PATIENCE) for _ in range(60)]
        nodes = pool.submit(lambda: launcher.status().nodes)
        threads = [each for each in threading.enumerate() if each.name == "control client"]
        assert len(threads) <= control.MOST_CLIENTS
        for each in silent:
            each.close()
        assert nodes.result(PATIENCE) == supervisor.nodes


class Recorder:
    """A socket that notes what is sent."""

    def __init__(self, connection: socket.socket) -> None:
        self.settimeout, self.recv, self._connection = connection.settimeout, connection.recv, connection
        self.sent: list[bytes] = []

    def sendall(self, data: bytes) -> None:
        self.sent.append(data)
        self._connection.sendall(data)


def test_a_question_counts_once(launched: Control, supervisor: FakeSupervisor) -> None:
    launcher = the_only()
    with connect(address_of(launcher), PATIENCE) as connection:
        recorder = Recorder(connection)
        line = Line(recorder, launcher._registration.key, time.monotonic() + PATIENCE)  # type: ignore[arg-type]
        line.be_greeted()
        line.ask(Question("restart", "world"))
    with connect(address_of(launcher), PATIENCE) as connection:
        connection.sendall(recorder.sent[0])
        wait_for_the_end(connection)
    assert supervisor.restarted == ["world"]


def test_a_line_without_an_end_is_too_long_in_the_end() -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs, ThreadPoolExecutor(1) as pool:
        hearing = pool.submit(Line(ours, "00", time.monotonic() + PATIENCE).hear)
        theirs.sendall(b"x" * (talk.LONGEST_QUESTION + 2))
        with pytest.raises(talk.TalkError, match="more than 65536 bytes at once"):
            hearing.result(PATIENCE)


def test_an_end_waits_for_nobody_at_the_door(supervisor: FakeSupervisor) -> None:
    with Control(supervisor, name="follow"):
        silent = [connect(address_of(the_only()), PATIENCE) for _ in range(2 * control.MOST_CLIENTS)]
    assert running() == []
    for each in silent:
        each.close()


def test_a_question_that_this_version_does_not_know_is_hung_up_on(
    launched: Control, supervisor: FakeSupervisor
) -> None:
    class Other(msgspec.Struct):
        ask: str

    launcher = the_only()
    with connect(address_of(launcher), PATIENCE) as connection:
        line = Line(connection, launcher._registration.key, time.monotonic() + PATIENCE)
        line.be_greeted()
        with pytest.raises(EOFError):
            line.ask(Other("dance"))  # type: ignore[arg-type]
    assert launcher.status().nodes == supervisor.nodes


@given(st.binary(max_size=200))
def test_any_bytes_are_refused_in_order(received: bytes) -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.sendall(received + b"\n")
        theirs.shutdown(socket.SHUT_WR)
        with pytest.raises((RobolinkError, EOFError, OSError)):
            Line(ours, "00", time.monotonic() + PATIENCE).hear()


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
    for launcher in asking._registered():
        with pytest.raises(LauncherError):
            launcher.status()
    asking.clear_away()
    assert main(["launch", "--status"]) == 0
    runtime.unregister(place)


# --- the folder -----------------------------------------------------------------------------------------------


@posix_only
def test_a_launcher_without_a_folder_says_so_once_and_runs(
    supervisor: FakeSupervisor, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "robolink").write_text("in the way")
    with Control(supervisor, name="follow"):
        pass
    (said,) = supervisor.said
    assert said == (
        "no other shell can ask for the status, restart or stop: "
        f"{folder / 'robolink'} is no folder of this user: remove it"
    )


def test_a_launch_file_of_any_name_can_be_asked(supervisor: FakeSupervisor) -> None:
    with Control(supervisor, name="lap\udcff", file="/lap\udcff.yaml"):
        assert the_only().name == "lap?"
        assert the_only().status().nodes == supervisor.nodes


def test_a_launcher_that_cannot_write_leaves_nothing_and_says_so(
    supervisor: FakeSupervisor, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def register_on_a_full_disk(place: Path, registration: Registration) -> None:
        place.with_suffix(".part").write_text("{")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(control, "register", register_on_a_full_disk)
    with Control(supervisor, name="follow"):
        assert files_in(folder) == []
    (said,) = supervisor.said
    assert said.endswith("No space left on device")


@posix_only
def test_a_folder_of_another_user_is_refused(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "getuid", lambda: 12345)
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(folder))
    (folder / "robolink-12345").mkdir(mode=0o700)
    with pytest.raises(RuntimeFolderError, match="robolink-12345 is no folder of this user"):
        runtime_folder()


@posix_only
def test_a_folder_that_others_may_open_is_refused(folder: Path) -> None:
    (folder / "robolink").mkdir(mode=0o755)
    (folder / "robolink").chmod(0o755)
    with pytest.raises(RuntimeFolderError, match="can be opened by others: chmod 700 it"):
        runtime_folder()


@posix_only
def test_a_link_in_its_place_is_refused(folder: Path, tmp_path: Path) -> None:
    (folder / "robolink").symlink_to(tmp_path)
    with pytest.raises(RuntimeFolderError, match="is no folder of this user"):
        runtime_folder()


@posix_only
@pytest.mark.parametrize("given_folder", ["", ".", "/nowhere/at/all", "/tmp/" + 80 * "x"])
def test_without_a_runtime_folder_it_is_the_temporary_one(
    given_folder: str, monkeypatch: pytest.MonkeyPatch, folder: Path
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", given_folder)
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(folder))
    assert runtime_folder().parent == folder
    assert stat.S_IMODE(runtime_folder().stat().st_mode) == 0o700
