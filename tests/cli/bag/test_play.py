"""`robolink bag play`: its flags, its services, its keys, and its end."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink import Node
from robolink.cli.bag import player as player_command
from robolink.cli.bag.play import with_clock_rate
from robolink.cli.main import main
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.rosbag2_interfaces.srv import (
    Burst,
    GetRate,
    IsPaused,
    Pause,
    Play,
    PlayNext,
    Resume,
    Seek,
    SetRate,
    Stop,
    TogglePaused,
)
from robolink.interfaces.std_msgs.msg import String
from tests.support.players import START, counting
from tests.support.seen_by_commands import a_node_that_commands_see, spinning

PATIENCE = 30.0


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Node]:
    monkeypatch.chdir(tmp_path)
    counting(tmp_path / "bag", 3)
    with a_node_that_commands_see(monkeypatch) as node, spinning(node):
        yield node


@pytest.fixture
def heard(robot: Node) -> queue.SimpleQueue[str]:
    found: queue.SimpleQueue[str] = queue.SimpleQueue()
    robot.create_subscription(String, "/count", lambda message: found.put(message.data), 100)
    return found


class Run:
    """A `bag play` that runs on a thread."""

    def __init__(self, robot: Node, words: str) -> None:
        self.robot, self.code = robot, -1
        self._thread = threading.Thread(target=self._main, args=(words,), daemon=True)
        self._thread.start()

    def _main(self, words: str) -> None:
        self.code = main(["bag", "play", *words.split()])

    def call(self, kind: Any, name: str, **request: Any) -> Any:
        client = self.robot.create_client(kind, f"/rosbag2_player/{name}")
        assert client.wait_for_service(PATIENCE)
        return client.call(kind.Request(**request), timeout_sec=PATIENCE)

    def end(self) -> int:
        self._thread.join(PATIENCE)
        assert not self._thread.is_alive()
        return self.code


def test_a_bag_is_played_to_its_end(robot: Node, heard: queue.SimpleQueue[str]) -> None:
    assert Run(robot, "bag -r 100").end() == 0
    assert [heard.get(timeout=PATIENCE) for _ in range(3)] == ["0", "1", "2"]


def test_the_services_steer_it(robot: Node, heard: queue.SimpleQueue[str]) -> None:
    run = Run(robot, "bag -p --disable-keyboard-controls")
    assert run.call(IsPaused, "is_paused").paused
    assert not run.call(Play, "play").success, "it plays already"
    assert run.call(PlayNext, "play_next").success
    assert heard.get(timeout=PATIENCE) == "0"
    assert run.call(Seek, "seek", time=Time(sec=START // 10**9 + 2)).success
    assert not run.call(Seek, "seek", time=Time(sec=5)).success
    assert run.call(Burst, "burst", num_messages=1).actually_burst == 1
    assert heard.get(timeout=PATIENCE) == "2"
    assert run.call(SetRate, "set_rate", rate=0.5).success
    assert not run.call(SetRate, "set_rate", rate=0.0).success
    assert run.call(GetRate, "get_rate").rate == 0.5
    assert run.call(Seek, "seek", time=Time(sec=START // 10**9)).success
    run.call(Resume, "resume")
    assert heard.get(timeout=PATIENCE) == "0"
    assert not run.call(PlayNext, "play_next").success, "it does not pause"
    run.call(Pause, "pause")
    run.call(TogglePaused, "toggle_paused")
    assert not run.call(IsPaused, "is_paused").paused
    run.call(Stop, "stop")
    assert run.end() == 0


@pytest.mark.slow
def test_keys_pause_step_and_change_the_rate(
    robot: Node, heard: queue.SimpleQueue[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    typed = queue.SimpleQueue[str]()
    monkeypatch.setattr(player_command, "keys", lambda: _Typed(typed))
    run = Run(robot, "bag -p")
    assert run.call(IsPaused, "is_paused").paused
    for key in ("right", "s", "up", "down", " "):
        typed.put(key)
    assert run.end() == 0
    assert [heard.get(timeout=PATIENCE) for _ in range(3)] == ["0", "1", "2"]
    log = capsys.readouterr().err
    assert "Press SPACE for Pause/Resume" in log
    assert "Set rate to 1.1\n" in log
    assert "Set rate to 0.99\n" in log
    assert "Resuming play." in log


class _Typed:
    """Keys that a test types."""

    def __init__(self, typed: queue.SimpleQueue[str]) -> None:
        self._typed = typed

    def __enter__(self) -> Any:
        return self._read

    def __exit__(self, *_: object) -> None:
        pass

    def _read(self, timeout: float) -> str:
        try:
            return self._typed.get(timeout=timeout)
        except queue.Empty:
            return ""


def test_an_end_beyond_every_time_is_none(robot: Node, heard: queue.SimpleQueue[str]) -> None:
    assert Run(robot, "bag -r 100 --playback-until-sec 1e300").end() == 0
    assert [heard.get(timeout=PATIENCE) for _ in range(3)] == ["0", "1", "2"]


def test_an_offset_behind_the_end_is_told(robot: Node, capsys: pytest.CaptureFixture[str]) -> None:
    assert Run(robot, "bag --start-offset 100").end() == 0
    assert "the start offset of 100 s is behind the end: the bag is 2 s long" in capsys.readouterr().err


def test_the_clock_may_have_a_rate_or_none() -> None:
    assert with_clock_rate([]) == []
    assert with_clock_rate(["a", "--clock"]) == ["a", "--clock", "40"]
    assert with_clock_rate(["--clock", "a"]) == ["--clock", "40", "a"]
    assert with_clock_rate(["--clock", "2.5", "a"]) == ["--clock", "2.5", "a"]
    assert with_clock_rate(["--", "--clock"]) == ["--", "--clock"]


def test_ros2s_flags_become_settings(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    ran: list[Any] = []

    def run(*given: Any) -> int:
        ran.append(given)
        return 0

    monkeypatch.setattr(player_command, "run", run)
    (tmp_path / "qos.yaml").write_text("/scan:\n  reliability: best_effort\n  depth: 3\n  history: keep_last\n")
    words = (
        "a -i b mcap -i c sqlite3 -s mcap -r 2 --topics /scan odom --services /set -e re -x no --exclude-topics /t"
        f" --qos-profile-overrides-path {tmp_path / 'qos.yaml'} -l -m /a:=/b /c:=/d --clock --clock-topics /scan"
        " -d 1 --playback-duration 5 --playback-until-sec 7.5 -p --start-offset 3 --wait-for-all-acked 5"
        " --disable-keyboard-controls --disable-loan-message --publish-service-requests --message-order sent"
        " --storage-config-file any.yaml"
        " --progress-bar-update-rate 0 --progress-bar-separation-lines 2 --read-ahead-queue-size 7 --log-level warn"
    )
    assert main(["bag", "play", *words.split()]) == 0
    ((paths, settings, request),) = ran
    assert paths == ["a", "b", "c"]
    assert settings.selection.topics == ("/scan", "/odom")
    assert settings.selection.services == ("/set",)
    assert (settings.selection.regex, settings.selection.exclude_regex) == ("re", "no")
    assert settings.selection.exclude_topics == ("/t",)
    assert not settings.selection.all_topics
    assert settings.qos_overrides["/scan"].depth == 3
    assert (settings.rate, settings.loop, settings.delay, settings.start_offset) == (2.0, True, 1.0, 3.0)
    assert (settings.duration, settings.until, settings.start_paused) == (5.0, 7_500_000_000, True)
    assert (settings.clock_rate, settings.clock_topics) == (40.0, frozenset({"/scan"}))
    assert (settings.order, settings.read_ahead, settings.service_requests) == ("sent", 7, "service_introspection")
    assert request == player_command.Request("rosbag2_player", "warn", False, 0.0, ("/a:=/b", "/c:=/d"))


@pytest.mark.parametrize(
    ("words", "line"),
    [
        ("", "play what? name a bag"),
        ("none", "no bag 'none'"),
        ("bag -r 0", "rate: expected"),
        ("bag --clock 0", "--clock: expected a number of Hz above 0"),
        ("bag --topics /none", "no topic is selected"),
        ("bag -e (", "regex: '(' is not a regular expression"),
        ("bag -d -1", "expected 0 to"),
        ("bag --playback-duration nan", "take numbers of seconds"),
        ("bag --playback-until-sec 1 --playback-until-nsec 1", "do not go together"),
        ("bag --message-order any", "'any' is none of received, sent"),
        ("bag --qos-profile-overrides-path none.yaml", "none.yaml"),
        ("bag -m nonsense", "nonsense"),
    ],
)
def test_one_line_for_what_is_wrong(robot: Node, capsys: pytest.CaptureFixture[str], words: str, line: str) -> None:
    assert main(["bag", "play", *words.split()]) != 0
    error = capsys.readouterr().err
    assert line in error
    assert "Traceback" not in error
