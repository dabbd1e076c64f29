"""`robolink bag record`: its flags, its services, its keys, and its end."""

from __future__ import annotations

import errno
import json
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from robolink import Node
from robolink.bag.reader import open_bag
from robolink.bag.recording import Figures
from robolink.bag.writer import BagWriter
from robolink.cli.bag import recorder
from robolink.cli.bag.recorder import clock, progress, summary
from robolink.cli.main import main
from robolink.cli.shared.session import opened as opened_session
from robolink.interfaces.rosbag2_interfaces.msg import WriteSplitEvent
from robolink.interfaces.rosbag2_interfaces.srv import (
    IsDiscoveryRunning,
    IsPaused,
    Pause,
    Record,
    Resume,
    Snapshot,
    SplitBagfile,
    StartDiscovery,
    Stop,
    StopDiscovery,
)
from robolink.interfaces.std_msgs.msg import Int32
from robolink.publisher import Publisher
from tests.support.seen_by_commands import a_node_that_commands_see, spinning
from tests.support.waits import wait_until

PATIENCE = 30.0


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Node]:
    monkeypatch.chdir(tmp_path)

    @contextmanager
    def opened(enclave: str) -> Iterator[Any]:
        with opened_session(enclave) as context:
            OPENED.append(context)
            yield context

    monkeypatch.setattr(recorder, "opened", opened)
    with a_node_that_commands_see(monkeypatch) as node, spinning(node):
        yield node


OPENED: list[Any] = []
"""Contexts of the commands, the last of which `Run.stop` ends: a thread gets no Ctrl-C."""


class Run:
    """A `bag record` that runs on a thread."""

    def __init__(self, robot: Node, words: str) -> None:
        self.robot, self.code = robot, -1
        self._thread = threading.Thread(target=self._main, args=(words,))
        self._thread.start()

    def _main(self, words: str) -> None:
        self.code = main(["bag", "record", *words.split()])

    def call(self, kind: Any, name: str, **fields: Any) -> Any:
        client = self.robot.create_client(kind, f"/rosbag2_recorder/{name}")
        assert client.wait_for_service(PATIENCE)
        return client.call(kind.Request(**fields), timeout_sec=PATIENCE)

    def stop(self) -> int:
        self.call(Stop, "stop")
        OPENED[-1].shutdown()
        return self.end()

    def end(self) -> int:
        self._thread.join(PATIENCE)
        assert not self._thread.is_alive()
        return self.code


@contextmanager
def recording(robot: Node, words: str) -> Iterator[Run]:
    run = Run(robot, words)
    try:
        yield run
    finally:
        if run.code == -1:
            run.stop()


def subscribed(publisher: Publisher[Int32]) -> None:
    wait_until(publisher.get_subscription_count)


def counts(path: str) -> dict[str, int]:
    with open_bag(path) as bag:
        return {name: count for name, count in bag.counts.items() if count}


def test_named_topics_are_recorded_until_somebody_stops_it(robot: Node, capsys: pytest.CaptureFixture[str]) -> None:
    count, other = (robot.create_publisher(Int32, name, 10) for name in ("/count", "/other"))
    with recording(robot, "count -o lap --custom-data robot=r1 place=lab=2") as run:
        subscribed(count)
        for number in range(10):
            count.publish(Int32(data=number))
            other.publish(Int32(data=number))
        assert run.stop() == 0
    assert counts("lap") == {"/count": 10}
    with open_bag("lap") as bag:
        assert bag.metadata.custom_data == {"robot": "r1", "place": "lab=2"}
    shown = capsys.readouterr()
    assert shown.out.startswith("lap: 10 messages of 1 topics in ")
    assert "[rosbag2_recorder]: Subscribed to topic '/count'" in shown.err
    assert "Recording stopped" in shown.err


def test_lists_of_names_follow_their_flags_and_the_figures_are_json(
    robot: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    publishers = [robot.create_publisher(Int32, f"/n{number}", 10) for number in range(4)]
    words = "--topics /n0 /n1 /n2 --exclude-topics /n1 /n3 -o bag --json --log-level error"
    with recording(robot, words) as run:
        subscribed(publishers[0])
        subscribed(publishers[2])
        for each in publishers:
            each.publish(Int32(data=1))
        run.stop()
    assert counts("bag") == {"/n0": 1, "/n2": 1}
    shown = capsys.readouterr()
    figures = json.loads(shown.out)
    assert (figures["path"], figures["messages"], figures["topics"], figures["dropped"]) == ("bag", 2, 2, {})
    assert "Subscribed" not in shown.err


def test_the_services_of_rosbag2_control_it(robot: Node) -> None:
    count = robot.create_publisher(Int32, "/count", 10)
    reported: list[WriteSplitEvent] = []
    robot.create_subscription(WriteSplitEvent, "/events/write_split", reported.append, 10)
    with recording(robot, "/count -o bag --start-paused") as run:
        subscribed(count)
        assert run.call(IsPaused, "is_paused").paused
        count.publish(Int32(data=1))
        run.call(Resume, "resume")
        assert not run.call(IsPaused, "is_paused").paused
        count.publish(Int32(data=2))
        wait_until(lambda: counts("bag"))
        run.call(SplitBagfile, "split_bagfile")
        count.publish(Int32(data=3))
        wait_until(lambda: reported)
        wait_until(lambda: counts("bag") == {"/count": 2})
        run.call(Pause, "pause")
        count.publish(Int32(data=4))
        assert run.stop() == 0
    assert counts("bag") == {"/count": 2}
    assert sorted(each.name for each in Path("bag").iterdir()) == ["bag_0.mcap", "bag_1.mcap", "metadata.yaml"]
    (event,) = reported
    assert (Path(event.closed_file).name, Path(event.opened_file).name) == ("bag_0.mcap", "bag_1.mcap")
    assert event.node_name == "/rosbag2_recorder"


def test_it_records_again_after_a_stop_and_discovery_is_switched(robot: Node) -> None:
    count = robot.create_publisher(Int32, "/count", 10)
    with recording(robot, "-a -o bag") as run:
        subscribed(count)
        assert run.call(IsDiscoveryRunning, "is_discovery_running").running
        assert run.call(StopDiscovery, "stop_discovery").return_code == 0
        assert run.call(StopDiscovery, "stop_discovery").error_string == "Discovery is not running."
        assert not run.call(IsDiscoveryRunning, "is_discovery_running").running
        late = robot.create_publisher(Int32, "/late", 10)
        assert run.call(Record, "record", uri="second").error_string == "Recorder is already recording."
        assert late.get_subscription_count() == 0
        assert run.call(StartDiscovery, "start_discovery").return_code == 0
        subscribed(late)
        run.call(Stop, "stop")
        assert run.call(Record, "record").return_code == 1  # the first bag is there
        assert run.call(Record, "record", uri="second").return_code == 0
        subscribed(count)
        count.publish(Int32(data=1))
        assert run.stop() == 0
    assert counts("second")["/count"] == 1


def test_a_snapshot_is_written_when_it_is_asked_for(robot: Node) -> None:
    count = robot.create_publisher(Int32, "/count", 10)
    with recording(robot, "/count -o bag --snapshot-mode --max-cache-size 1000") as run:
        subscribed(count)
        for number in range(100):
            count.publish(Int32(data=number))
        wait_until(lambda: run.call(Snapshot, "snapshot").success)
        assert run.stop() == 0
    assert 1 <= counts("bag")["/count"] <= 5


def test_keys_pause_and_go_on(robot: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    typed = ["", " ", " ", " "]

    @contextmanager
    def keys() -> Iterator[Callable[[float], str]]:
        yield lambda timeout: typed.pop() if typed else ""

    monkeypatch.setattr(recorder, "keys", keys)
    with recording(robot, "-a -o bag") as run:
        wait_until(lambda: not typed)
        wait_until(lambda: run.call(IsPaused, "is_paused").paused)


@pytest.mark.parametrize(
    ("words", "compression"),
    [
        ("--storage-config-file mcap.yaml", "lz4"),
        ("--storage-preset-profile zstd_small", "zstd"),
        ("--storage-preset-profile zstd_small --compression-format lz4", "lz4"),
        ("--storage-preset-profile resilient -s sqlite3", ""),
    ],
)
def test_rosbag2s_settings_of_a_storage_compress_its_chunks(robot: Node, words: str, compression: str) -> None:
    Path("mcap.yaml").write_text("noChunkCRC: false\ncompression: Lz4\nchunkSize: 1000\n", encoding="utf-8")
    count = robot.create_publisher(Int32, "/count", 10)
    with recording(robot, f"/count -o bag {words}") as run:
        subscribed(count)
        count.publish(Int32(data=1))
        assert run.stop() == 0
    with open_bag("bag") as bag:
        assert (bag.compression, bag.counts) == (compression, {"/count": 1})


def test_a_full_disk_is_one_line_and_the_bag_has_what_was_written(
    robot: Node, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write = BagWriter.write

    def until_it_is_full(self: BagWriter, *arguments: Any) -> None:
        if self.message_count >= 5:
            raise OSError(errno.ENOSPC, "No space left on device", "bag_0.mcap")
        write(self, *arguments)

    monkeypatch.setattr(BagWriter, "write", until_it_is_full)
    count = robot.create_publisher(Int32, "/count", 10)
    run = Run(robot, "/count -o bag --log-level error")
    subscribed(count)
    for number in range(10):
        count.publish(Int32(data=number))
    assert run.end() == 1
    shown = capsys.readouterr()
    assert shown.err == "robolink: the recording has ended: bag_0.mcap: No space left on device\n"
    assert shown.out.startswith("bag: 5 messages of 1 topics in ")
    assert counts("bag") == {"/count": 5}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("-o bag", "record what? name topics, or give -a, --all-topics"),
        ("-e ( -o bag", "regex: '(' is not a regular expression"),
        ("-a -o there", "'there' exists already"),
        ("-a --use-sim-time --no-discovery", "do not go together"),
        ("-a --max-bag-files 3", "--max-bag-files says something with"),
        ("-a --snapshot-mode --max-cache-size 0", "--snapshot-mode needs a limit"),
        ("-a --repeat-transient-local /map=x", "expected TOPIC or TOPIC=N"),
        ("-a -s sqlite3 --compression-format zstd", "sqlite3 has no chunks to compress"),
        ("-a -s rosbag", "'rosbag' is none of mcap, sqlite3"),
        ("-a --qos-profile-overrides-path nowhere.yaml", "nowhere.yaml"),
        ("-a --storage-config-file nowhere.yaml", "nowhere.yaml"),
        ("-a --max-bag-size -1", "--max-bag-size"),
        ("-a --static-topics-path nowhere.yaml", "no file 'nowhere.yaml'"),
        ("--static-topics-path there/file", "there/file"),
        ("/a//b -o bag", "invalid topic name"),
    ],
)
def test_what_cannot_be_is_told_in_one_line_and_makes_no_bag(
    robot: Node, capsys: pytest.CaptureFixture[str], words: str, said: str
) -> None:
    Path("there").mkdir()
    Path("there", "file").touch()
    assert main(["bag", "record", *words.split()]) in (1, 2)
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert [each.name for each in Path().iterdir()] == ["there"]


def test_static_topics_and_a_storage_configuration_are_files(robot: Node, tmp_path: Path) -> None:
    (tmp_path / "static.yaml").write_text("static_topics_and_types_list:\n  - [/awaited, std_msgs/msg/Int32]\n")
    (tmp_path / "mcap.yaml").write_text("compression: Zstd\nchunkSize: 1000\n")
    with recording(robot, "--static-topics-path static.yaml --storage-config-file mcap.yaml -o bag") as run:
        wait_until(lambda: robot.count_subscribers("/awaited"))
        run.call(IsPaused, "is_paused")  # so that the publisher has nothing to wait for
        robot.create_publisher(Int32, "/awaited", 10).publish(Int32(data=7))
        assert run.stop() == 0
    assert counts("bag") == {"/awaited": 1}
    with open_bag("bag") as bag:
        assert bag.compression == "zstd"


def test_the_figures_are_shown_in_words() -> None:
    before = Figures(Path("bag"), 10.0, 1000, 10_000, 3, {}, {}, False, 0, "")
    now = before._replace(seconds=12.0, messages=3000, bytes=4_010_000, dropped={"/a": 5, "/b": 70}, lost={"/c": 1})
    assert progress(now, before) == (
        "[recording]  12.0 s  3,000 messages (1,000/s)  3.8 MiB (1.9 MiB/s)  3 topics"
        "  dropped 75 (/b 70, /a 5)  lost 1 (/c 1)"
    )
    assert progress(now._replace(paused=True), now).startswith("[paused]  12.0 s  3,000 messages (0/s)")
    assert summary(now) == [
        "bag: 3,000 messages of 3 topics in 12.0 s, 3.8 MiB",
        "  dropped, since they came faster than they could be written: /a 5",
        "  dropped, since they came faster than they could be written: /b 70",
        "  lost on the way: /c 1",
    ]
    assert [clock(each) for each in (0.04, 59.94, 60, 3723)] == ["0.0 s", "59.9 s", "1:00 min", "1:02:03 h"]
