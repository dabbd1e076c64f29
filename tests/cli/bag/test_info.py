"""`robolink bag info` and `list`: the lines of `ros2 bag info`, JSON, and a line for each bag that is none."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink.bag.information import size_text, time_text
from robolink.bag.topic import BagTopic
from robolink.bag.writer import BagWriter
from robolink.cli.main import main
from robolink.serialization import serialize_message
from tests.support.bags import START, ten_messages, text, write, write_theirs

Captured = pytest.CaptureFixture[str]
MESSAGES = ten_messages()


@pytest.fixture(autouse=True)
def in_utc(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TZ", "UTC")
    getattr(time, "tzset", lambda: None)()
    yield
    monkeypatch.undo()
    getattr(time, "tzset", lambda: None)()


def folder_size(folder: Path) -> int:
    return sum(each.stat().st_size for each in folder.iterdir())


@pytest.mark.skipif(not hasattr(time, "tzset"), reason="Windows has its own time zone")
def test_info_prints_the_lines_of_ros2(capsys: Captured) -> None:
    write(Path("walk"), MESSAGES, max_duration=5.0)
    assert main(["bag", "info", "walk"]) == 0
    assert capsys.readouterr().out.split("\n") == [
        "",
        "Files:             walk_0.mcap",
        "                   walk_1.mcap",
        f"Bag size:          {size_text(folder_size(Path('walk')))}",
        "Storage id:        mcap",
        "ROS Distro:        jazzy",
        "Duration:          9.000000000s",
        "Start:             Nov 14 2023 22:13:20.000000000 (1700000000.000000000)",
        "End:               Nov 14 2023 22:13:29.000000000 (1700000009.000000000)",
        "Messages:          10",
        "Topic information: Topic: /chatter | Type: std_msgs/msg/String | Count: 6 | Serialization Format: cdr",
        "                   Topic: /map | Type: std_msgs/msg/String | Count: 4 | Serialization Format: cdr",
        "Service:           0",
        "Service information: ",
        "",
    ]


def event(kind: int, number: int) -> bytes:
    """Return an event of a service without its request and response."""
    from robolink.interfaces.service_msgs.msg import ServiceEventInfo

    info = ServiceEventInfo(event_type=kind, sequence_number=number)
    return bytes(serialize_message(info)) + bytes(8)


def write_service(path: Path) -> None:
    """Write a bag of a service that was called three times and answered twice, and of one that nobody called."""
    with BagWriter(path) as writer:
        called = writer.add_topic(BagTopic("/reset/_service_event", "std_srvs/srv/Empty_Event"))
        writer.add_topic(BagTopic("/add/_service_event", "std_srvs/srv/Trigger_Event"))
        chatter = writer.add_topic(BagTopic("/chatter", "std_msgs/msg/String"))
        for number in range(3):
            writer.write(called, START, START, 0, event(0, number))
            writer.write(called, START, START, 0, event(1, number))
        for number in range(2):
            writer.write(called, START, START, 0, event(2, number))
        writer.write(chatter, START, START, 0, text("a"))


def test_services_are_counted_apart(capsys: Captured) -> None:
    write_service(Path("bag"))
    main(["bag", "info", "bag"])
    lines = capsys.readouterr().out.split("\n")
    assert lines[8:] == [
        "Messages:          1",
        "Topic information: Topic: /chatter | Type: std_msgs/msg/String | Count: 1 | Serialization Format: cdr",
        "Service:           2",
        "Service information: Service: /add | Type: std_srvs/srv/Trigger | Event Count: 0 | Serialization Format: cdr",
        "                     Service: /reset | Type: std_srvs/srv/Empty | Event Count: 8 | Serialization Format: cdr",
        "",
        "",
    ]


def test_verbose_reads_sizes_and_calls(capsys: Captured) -> None:
    write_service(Path("bag"))
    main(["bag", "info", "-v", "bag"])
    lines = capsys.readouterr().out.split("\n")
    size = size_text(len(event(0, 0)) * 8)
    assert lines[9:-2] == [
        (
            "Topic information: Topic: /chatter | Type: std_msgs/msg/String | Count: 1 | Size Contribution: 12 B | "
            "Serialization Format: cdr"
        ),
        "Service:           2",
        (
            "Service information: Service: /add | Type: std_srvs/srv/Trigger | Request Count: 0 | Response Count: 0 | "
            "Size Contribution: 0 B | Serialization Format: cdr"
        ),
        (
            "                     Service: /reset | Type: std_srvs/srv/Empty | Request Count: 3 | Response Count: 2 | "
            f"Size Contribution: {size} | Serialization Format: cdr"
        ),
    ]


def test_names_alone(capsys: Captured) -> None:
    write_service(Path("bag"))
    assert main(["bag", "info", "-t", "bag"]) == 0
    assert capsys.readouterr() == ("/chatter\n", "")
    assert main(["bag", "info", "-t", "-v", "bag"]) == 0
    captured = capsys.readouterr()
    assert "Size Contribution" in captured.out
    assert captured.err.startswith("Warning! You have set both the '-t' and '-v' parameters.")


@pytest.mark.parametrize(
    ("sort", "order"), [("name", ["/a", "/b", "/c"]), ("type", ["/b", "/c", "/a"]), ("count", ["/c", "/a", "/b"])]
)
def test_topics_are_sorted(sort: str, order: list[str], capsys: Captured) -> None:
    with BagWriter("bag") as writer:
        for name, type_name, count in (("/a", "z/msg/Z", 2), ("/b", "a/msg/A", 3), ("/c", "b/msg/B", 1)):
            number = writer.add_topic(BagTopic(name, type_name))
            for _ in range(count):
                writer.write(number, START, START, 0, text("x"))
    main(["bag", "info", "bag", "-t", "--sort", sort])
    assert capsys.readouterr().out.split() == order


def test_an_unknown_order_is_refused(capsys: Captured) -> None:
    write(Path("bag"))
    assert main(["bag", "info", "bag", "--sort", "naem"]) == 2
    assert "(did you mean 'name'?)" in capsys.readouterr().err


def test_json_has_everything(capsys: Captured) -> None:
    write_theirs(Path("bag"), MESSAGES, storage="sqlite3")
    assert main(["bag", "info", "bag", "--json", "-v"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["storage"] == "sqlite3"
    assert data["size"] == folder_size(Path("bag"))
    assert (data["start"], data["end"], data["duration"], data["messages"]) == (START, START + 9 * 10**9, 9 * 10**9, 10)
    assert [(each["name"], each["messages"]) for each in data["topics"]] == [("/chatter", 6), ("/map", 4)]
    assert data["topics"][1]["offered_qos_profiles"][0]["durability"] == "transient_local"
    assert data["topics"][1]["size"] == sum(len(each.data) for each in MESSAGES if each.topic == "/map")
    assert data["custom_data"] == {"robot": "r2"}
    assert (data["is_whole"], data["problems"]) == (True, [])


def test_an_empty_bag_has_lines_too(capsys: Captured) -> None:
    with BagWriter("bag"):
        pass
    assert main(["bag", "info", "bag"]) == 0
    lines = capsys.readouterr().out.split("\n")
    assert lines[5] == "Duration:          0.000000000s"
    assert lines[8:11] == ["Messages:          0", "Topic information: ", "Service:           0"]


def test_times_and_sizes_have_rosbag2s_form() -> None:
    assert [size_text(each) for each in (0, 1023, 1024, 1536, 5 * 1024**3, 2048 * 1024**4)] == [
        "0 B", "1023 B", "1.0 KiB", "1.5 KiB", "5.0 GiB", "2048.0 TiB",
    ]  # fmt: skip
    assert time_text(10**30).endswith("(1000000000000000000000.000000000)")


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: None, "no bag 'bag'"),
        (lambda: Path("bag").mkdir(), "bag is not a bag: there is no .mcap and no .db3 file in it"),
        (lambda: Path("bag").write_bytes(b""), "bag is empty"),
        (lambda: Path("bag").write_text("hello, this is not a bag"), "is neither an MCAP file nor a sqlite3 database"),
        (lambda: Path("bag").write_bytes(b"#ROSBAG V2.0\n"), "is a bag of ROS 1: rosbags-convert"),
        (lambda: Path("bag").write_bytes(bytes(100)), "begins with zeros"),
        (lambda: Path("bag").write_bytes(b"SQLite format 3\0" + bytes(100)), "bag is damaged"),
        (lambda: Path("bag").write_bytes(b"\x89MCAP0\r\n"), "bag"),
    ],
)
def test_what_is_no_bag_is_told_in_one_line(make: object, words: str, capsys: Captured) -> None:
    make()  # type: ignore[operator]
    code = main(["bag", "info", "bag"])
    captured = capsys.readouterr()
    if code == 0:  # the beginning of an MCAP is one without messages
        assert "Messages:          0" in captured.out
        return
    assert captured.out == ""
    assert captured.err.startswith("robolink: ")
    assert captured.err.count("\n") == 1
    assert words in captured.err


def test_a_bag_whose_metadata_is_damaged_is_described_by_its_files(capsys: Captured) -> None:
    write(Path("bag"), MESSAGES)
    Path("bag/metadata.yaml").write_text("rosbag2_bagfile_information: {version: [}")
    assert main(["bag", "info", "bag"]) == 0
    captured = capsys.readouterr()
    assert "Messages:          10" in captured.out
    assert captured.err.startswith("bag/metadata.yaml:1:")
    assert captured.err.endswith("; 'robolink bag reindex bag' makes it anew\n")


def test_a_missing_file_is_told_and_the_others_are_described(capsys: Captured) -> None:
    write(Path("bag"), MESSAGES, max_duration=3.0)
    Path("bag/bag_1.mcap").unlink()
    Path("bag/bag_2.mcap").write_bytes(b"")
    assert main(["bag", "info", "bag"]) == 0
    captured = capsys.readouterr()
    assert "Messages:          4" in captured.out
    first, second = captured.err.splitlines()
    assert first.endswith("bag_1.mcap is missing: metadata.yaml names it")
    assert second.endswith("bag_2.mcap is empty: nothing was written to it, or the disk was full")


@pytest.mark.parametrize(
    ("kind", "names"), [("storage", "mcap\nsqlite3\n"), ("converter", "cdr\n"), ("compressor", "zstd\n")]
)
def test_plugins_are_listed(kind: str, names: str, capsys: Captured) -> None:
    assert main(["bag", "list", kind]) == 0
    assert capsys.readouterr().out == names


def test_plugins_are_described(capsys: Captured) -> None:
    assert main(["bag", "list", "storage", "-v"]) == 0
    assert capsys.readouterr().out.startswith("available storage plugins are:\nname: mcap\n\tMCAP files")
    assert main(["bag", "list", "storages"]) == 1
    assert "(did you mean 'storage'?)" in capsys.readouterr().err
