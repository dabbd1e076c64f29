"""A running launcher is found, asked and told from elsewhere."""

from __future__ import annotations

import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from robolink.supervisor.control import client
from robolink.supervisor.control.client import LauncherError, LauncherGoneError
from robolink.supervisor.control.server import Control
from tests.support.launchers import PATIENCE, FakeSupervisor, the_only


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


@pytest.mark.processes
def test_a_paused_launcher_is_told_of(elsewhere: subprocess.Popen[bytes], monkeypatch: pytest.MonkeyPatch) -> None:
    if sys.platform == "win32":
        pytest.skip("SIGSTOP is POSIX's")
    monkeypatch.setattr(client, "ANSWER_WITHIN", 0.2)
    elsewhere.send_signal(signal.SIGSTOP)
    with pytest.raises(LauncherError, match=r"does not answer: no word in time.*Ctrl-Z") as caught:
        the_only().status()
    assert not isinstance(caught.value, LauncherGoneError)
    elsewhere.send_signal(signal.SIGCONT)
    monkeypatch.setattr(client, "ANSWER_WITHIN", PATIENCE)
    assert [each.name for each in the_only().status().nodes] == ["talker"]


def test_a_launch_file_of_any_name_can_be_asked(supervisor: FakeSupervisor) -> None:
    with Control(supervisor, name="lap\udcff", file="/lap\udcff.yaml"):
        assert the_only().name == "lap?"
        assert the_only().status().nodes == supervisor.nodes
