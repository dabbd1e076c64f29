"""`robolink launch stop NODE`: one node of a running system is stopped from another shell, and the others go on."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from robolink.cli.launching import launchers
from robolink.cli.main import main
from robolink.supervisor.control.client import Launcher, LauncherError
from robolink.supervisor.control.client import running as all_that_run
from robolink.supervisor.control.server import Control
from robolink.supervisor.policy import Ask, Policy, Restarts, Rules, Say, Step
from tests.support.commands import Command
from tests.support.launchers import FakeSupervisor

Captured = pytest.CaptureFixture[str]


def the_only() -> Launcher:
    (launcher,) = all_that_run()
    return launcher


# --- the door -------------------------------------------------------------------------------------------------


def test_one_is_stopped_at_the_door(supervisor: FakeSupervisor, launched: Control) -> None:
    the_only().stop_one("world")
    assert supervisor.stopped_ones == ["world"]
    assert not supervisor.stopped.is_set()


def test_a_node_that_is_not_there_is_refused_at_the_door(supervisor: FakeSupervisor, launched: Control) -> None:
    with pytest.raises(LauncherError, match=r"no node named 'wrld' in 'follow' \(did you mean 'world'\?\)"):
        the_only().stop_one("wrld")
    assert supervisor.stopped_ones == []


def test_whoever_asks_learns_why_not(supervisor: FakeSupervisor, launched: Control) -> None:
    supervisor.why_not = "it has ended"
    with pytest.raises(LauncherError, match="'world' of 'follow' is not stopped: it has ended"):
        the_only().stop_one("world")
    assert supervisor.stopped_ones == []


# --- the command ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "words", [("robot_1/wall_follower",), ("/robot_1/wall_follower",), ("wall_follower",), ("follow", "wall_follower")]
)
def test_a_node_is_stopped_by_its_name(
    words: tuple[str, ...], supervisor: FakeSupervisor, launched: Control, capsys: Captured
) -> None:
    with Control(FakeSupervisor("sensors"), name="lap"):
        assert main(["launch", "stop", *words]) == 0
    assert re.fullmatch(r"robot_1/wall_follower of follow \(pid \d+\) has stopped\n", capsys.readouterr().out)
    assert supervisor.stopped_ones == ["robot_1/wall_follower"]
    assert not supervisor.stopped.is_set()


def test_a_node_is_restarted_by_the_last_part_of_its_name(supervisor: FakeSupervisor, launched: Control) -> None:
    assert main(["launch", "restart", "wall_follower"]) == 0
    assert supervisor.restarted == ["robot_1/wall_follower"]


def test_one_that_had_to_be_killed_is_told_of(
    supervisor: FakeSupervisor, launched: Control, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(supervisor, "stop_one", lambda name: supervisor.runs(state="stopped", returncode=-9))
    supervisor.runs(pid=4242)
    assert main(["launch", "stop", "world"]) == 0
    killed = r"killed by SIGKILL" if sys.platform != "win32" else r"killed by signal 9"
    assert re.fullmatch(rf"world of follow \(pid \d+\) has stopped: it was {killed}\n", capsys.readouterr().out)


def test_one_that_does_not_stop_is_not_waited_for_for_ever(
    supervisor: FakeSupervisor, launched: Control, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(launchers, "STOPPED_WITHIN", 0.01)
    monkeypatch.setattr(supervisor, "stop_one", lambda name: supervisor.runs(state="stopping", pid=4242))
    assert main(["launch", "stop", "world"]) == 1
    assert re.search(r"robolink: world of follow \(pid \d+\) is still stopping after 0.01 s", capsys.readouterr().err)


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (["wrld"], r"no launcher or node named 'wrld' \(did you mean 'world'\?\)"),
        (["lpa"], r"no launcher or node named 'lpa' \(did you mean 'lap'\?\)"),
        (["follow", "sensors"], r"no node named 'sensors' in follow \(pid \d+\)"),
        (["folow", "world"], r"no launcher named 'folow' \(did you mean 'follow'\?\)"),
        (["world"], r"'world' runs in 2 launchers, say in which: follow \(pid \d+\), lap \(pid \d+\)"),
        (["lidar"], r"which node 'lidar'\? There are a/lidar, b/lidar: give a whole name"),
        (["camera"], r"'camera' shares the process 'sensors' of lap \(pid \d+\): stop that one"),
        (["lap", "camera"], r"'camera' shares the process 'sensors' of lap \(pid \d+\): stop that one"),
        (["lap", "follow"], r"no node named 'follow' in lap \(pid \d+\)"),
    ],
)
def test_what_is_not_clear_stops_nothing(
    words: list[str], error: str, supervisor: FakeSupervisor, launched: Control, capsys: Captured
) -> None:
    other = FakeSupervisor("world", "sensors", "a/lidar", "b/lidar")
    with Control(other, name="lap", members={"sensors": ["gps", "camera"]}):
        assert main(["launch", "stop", *words]) == 1
    assert re.fullmatch(f"robolink: {error}\n", capsys.readouterr().err)
    assert supervisor.stopped_ones == other.stopped_ones == []
    assert not supervisor.stopped.is_set()
    assert not other.stopped.is_set()


def test_a_name_of_a_launcher_and_of_a_node_stops_neither(capsys: Captured) -> None:
    talker = FakeSupervisor("r1/talker")
    with Control(talker, name="talker"):
        assert main(["launch", "stop", "talker"]) == 1
        both = "both a launcher and a node are called 'talker'"
        ways = r"write stop \d+ for the launcher, or stop talker r1/talker for the node"
        assert re.fullmatch(f"robolink: {both}: {ways}\n", capsys.readouterr().err)
        assert not talker.stopped.is_set()
        assert main(["launch", "stop", "talker", "r1/talker"]) == 0
    assert talker.stopped_ones == ["r1/talker"]


def test_too_many_words_are_wrong_usage(capsys: Captured) -> None:
    assert main(["launch", "stop", "a", "b", "c"]) == 2
    assert capsys.readouterr().err.startswith("robolink: ask what? stop [NAME] [NODE] or restart [NAME] NODE")


# --- what is decided ------------------------------------------------------------------------------------------

ONCE_MORE = Rules(Restarts("on_failure", delay=5.0), "ignore")


def test_one_that_is_to_be_started_again_is_not() -> None:
    policy = Policy({"a": ONCE_MORE, "b": Rules()})
    policy.begin(0.0)
    policy.exited("a", 1, 1.0)
    assert policy.why_not_stopped("a") == ""
    assert policy.stop_one("a", 2.0) == [Say("a is not started again")]
    assert policy.woken(9.0) == []
    assert policy.why_not_stopped("a") == "somebody has stopped it already"


def test_one_that_is_being_restarted_is_only_stopped() -> None:
    policy = Policy({"a": Rules(), "b": Rules()})
    policy.begin(0.0)
    assert Ask("a", Step.INTERRUPT) in policy.restart("a", 1.0)
    assert policy.stop_one("a", 1.5) == [Say("a is not started again")]
    assert policy.why_not_stopped("a") == "it is being stopped already"
    assert policy.exited("a", 0, 2.0) == [Say("a has stopped")]
    assert policy.processes["a"].state == "stopped"


@pytest.mark.parametrize(("code", "why"), [(0, "it has ended"), (3, "it ended with exit code 3")])
def test_one_that_has_ended_cannot_be_stopped(code: int, why: str) -> None:
    policy = Policy({"a": Rules(on_exit="ignore"), "b": Rules()})
    policy.begin(0.0)
    policy.exited("a", code, 1.0)
    assert policy.why_not_stopped("a") == why
    assert policy.stop_one("a", 2.0) == []


def test_nothing_is_stopped_alone_on_the_way_to_the_end() -> None:
    policy = Policy({"a": Rules(), "b": Rules(held=True)})
    policy.begin(0.0)
    policy.interrupted(1.0)
    assert policy.why_not_stopped("a") == policy.why_not_stopped("b") == "the system is stopping"


# --- for real -------------------------------------------------------------------------------------------------

HANGS = """
import signal, sys, time
for each in (signal.SIGINT, signal.SIGTERM):
    signal.signal(each, lambda *_: None if sys.argv[1] == "stubborn" else sys.exit(0))
print("up", flush=True)
while True:
    time.sleep(60)
"""


@pytest.mark.processes
def test_a_node_is_stopped_held_and_ended_ones_too(
    tmp_path: Path, domain: int, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROBOLINK_LOG_DIR", str(tmp_path / "log"))
    (tmp_path / "hangs.py").write_text(HANGS)
    (tmp_path / "three.yaml").write_text(
        f"""
nodes:
- {{run: ['{sys.executable}', hangs.py, obeys], name: first}}
- {{run: ['{sys.executable}', hangs.py, obeys], name: second}}
- {{run: ['{sys.executable}', -c, 'raise SystemExit(3)'], name: gone, on_exit: ignore}}
- {{run: ['{sys.executable}', hangs.py, obeys], name: late, start_after: {{topic: never}}}}
"""
    )
    with Command(domain, "launch", "three.yaml", folder=tmp_path, merged=True) as launch:
        launch.wait_for("gone ended with exit code 3")
        for name in ("first", "second"):
            if f"[{name}] up" not in [each.text for each in launch.lines]:
                launch.wait_for(f"[{name}] up")
        assert main(["launch", "stop", "first"]) == 0
        assert "first of three (pid " in capsys.readouterr().out
        assert main(["launch", "stop", "late"]) == 0
        assert capsys.readouterr().out.endswith(" is not started any more\n")
        for name, why in [("gone", "it ended with exit code 3"), ("first", "somebody has stopped it already")]:
            assert main(["launch", "stop", name]) == 1
            assert capsys.readouterr().err == f"robolink: '{name}' of 'three' is not stopped: {why}\n"
        (launcher,) = all_that_run()
        assert [each.state for each in launcher.status().nodes] == ["stopped", "running", "ended", "stopped"]
        assert main(["launch", "stop", "second"]) == 0
        launch.wait_for("second has stopped")
        assert launch.end() == 0
