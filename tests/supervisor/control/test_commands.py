"""`robolink launch --status`, `stop` and `restart`: what they say, and to whom they go."""

from __future__ import annotations

import re
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import msgspec
import pytest

from robolink.cli.launching.launch_arguments import launch_words
from robolink.cli.main import main
from robolink.supervisor.control.client import running
from robolink.supervisor.control.server import Control
from tests.support.launchers import PATIENCE, FakeSupervisor, files_in


def test_status_lists_every_launcher(capsys: pytest.CaptureFixture[str], launched: Control) -> None:
    other = FakeSupervisor("sensors")
    other.runs(state="ended", returncode=-11, restarts=3, pid=4242)
    with Control(other, name="lap", members={"sensors": ["lidar", "camera"]}):
        assert main(["launch", "--status"]) == 0
        everyone = capsys.readouterr().out
        assert main(["launch", "--status", "lap"]) == 0
        lap = capsys.readouterr().out
    follow, _, rest = everyone.partition("\n\n")
    assert rest == lap
    assert re.search(r"^follow \(pid \d+\), up \d+ s, /somewhere/follow.yaml$", follow, re.MULTILINE)
    assert re.search(r"^  robot_1/wall_follower  running  1 min 3\d s  -    0         -$", follow, re.MULTILINE)
    assert re.search(r"^  sensors \(lidar, camera\)  ended .* 4242  3  +was killed by SIGSEGV$", lap, re.MULTILINE)


def test_status_as_json(capsys: pytest.CaptureFixture[str], launched: Control, supervisor: FakeSupervisor) -> None:
    assert main(["launch", "--status", "--json"]) == 0
    (told,) = msgspec.json.decode(capsys.readouterr().out)
    assert (told["launch"], told["error"]) == ("follow", "")
    assert [each["name"] for each in told["nodes"]] == ["world", "robot_1/wall_follower"]


def test_status_of_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "--status"]) == 0
    assert capsys.readouterr().out == "no launcher is running\n"
    assert main(["launch", "--status", "--json"]) == 0
    assert capsys.readouterr().out == "[]\n"


@pytest.mark.parametrize(
    ("args", "error"),
    [
        (["stop"], "no launcher is running"),
        (["stop", "follow"], "no launcher named 'follow'"),
        (["restart", "world"], "cannot restart 'world': no launcher is running"),
        (["--status", "follow"], "no launcher named 'follow'"),
        (["--top"], "no launcher is running"),
    ],
)
def test_what_is_asked_of_nobody(args: list[str], error: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", *args]) == 1
    assert capsys.readouterr().err == f"robolink: {error}\n"


def test_restart_finds_the_launcher_by_the_node(launched: Control, supervisor: FakeSupervisor) -> None:
    with Control(FakeSupervisor("sensors"), name="lap"):
        assert main(["launch", "restart", "/robot_1/wall_follower"]) == 0
    assert supervisor.restarted == ["robot_1/wall_follower"]


@pytest.mark.parametrize(
    ("args", "error"),
    [
        (["restart", "world"], r"'world' runs in 2 launchers, say in which: follow \(pid \d+\), lap \(pid \d+\)"),
        (["restart", "wall_folower"], r"no node named 'wall_folower' \(did you mean 'robot_1/wall_follower'\?\)"),
        (["restart", "lap", "wrld"], r"no node named 'wrld' in lap \(pid \d+\) \(did you mean 'world'\?\)"),
        (["restart", "camera"], r"'camera' shares the process 'sensors' of lap \(pid \d+\): restart that one"),
        (["restart", "lapp", "world"], r"no launcher named 'lapp' \(did you mean 'lap'\?\)"),
        (["stop"], r"2 launchers are running, say which one: follow \(pid \d+\), lap \(pid \d+\)"),
        (["--top"], r"2 launchers are running, say which one by --status --top NAME: follow \(pid .*"),
    ],
)
def test_what_is_not_clear(
    args: list[str], error: str, launched: Control, supervisor: FakeSupervisor, capsys: pytest.CaptureFixture[str]
) -> None:
    other = FakeSupervisor("world", "sensors")
    with Control(other, name="lap", members={"sensors": ["lidar", "camera"]}):
        assert main(["launch", *args]) == 1
    assert re.fullmatch(f"robolink: {error}\n", capsys.readouterr().err)
    assert supervisor.restarted == other.restarted == []
    assert not supervisor.stopped.is_set()


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (["stop"], ["follow", "lap", "robot_1/wall_follower", "sensors", "world"]),
        (["stop", "lap"], ["sensors"]),
        (["stop", "lap", "sensors"], []),
        (["restart"], ["follow", "lap", "robot_1/wall_follower", "sensors", "world"]),
        (["restart", "lap"], ["sensors"]),
        (["restart", "lap", "sensors"], []),
    ],
)
def test_the_shell_completes_what_runs(words: list[str], offered: list[str], launched: Control) -> None:
    with Control(FakeSupervisor("sensors"), name="lap"):
        context = SimpleNamespace(params={"words": words, "workspace": ""})
        assert launch_words(context, "") == offered  # type: ignore[arg-type]


@pytest.mark.parametrize("flag", ["--status", "--top"])
def test_only_one_launcher_is_looked_at_by_name(flag: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "--status", flag, "follow", "lap"]) == 2
    assert "one NAME" in capsys.readouterr().err


def test_restart_in_a_named_launcher(launched: Control, supervisor: FakeSupervisor) -> None:
    other = FakeSupervisor("world")
    with Control(other, name="lap"):
        assert main(["launch", "restart", "lap", "world"]) == 0
    assert (supervisor.restarted, other.restarted) == ([], ["world"])


def test_stop_returns_when_the_launcher_has_stopped(
    launched: Control, supervisor: FakeSupervisor, capsys: pytest.CaptureFixture[str]
) -> None:
    with ThreadPoolExecutor(1) as pool:
        code = pool.submit(main, ["launch", "stop"])
        assert supervisor.stopped.wait(PATIENCE)
        launched.__exit__(None, None, None)
        assert code.result(PATIENCE) == 0
    assert re.fullmatch(r"follow \(pid \d+\) has stopped\n", capsys.readouterr().out)


@pytest.mark.processes
def test_stop_ends_with_a_launcher_that_is_killed(elsewhere: subprocess.Popen[bytes], folder: Path) -> None:
    (launcher,) = running()
    with ThreadPoolExecutor(1) as pool:
        ended = pool.submit(launcher.stop, PATIENCE)
        assert elsewhere.stdout is not None
        assert elsewhere.stdout.readline().strip() == b"stop"
        elsewhere.kill()
        assert ended.result(PATIENCE)
    elsewhere.wait(PATIENCE)
    assert running() == []
    assert files_in(folder) == []
