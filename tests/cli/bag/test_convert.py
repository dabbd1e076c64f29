"""`robolink bag convert`: by flags and by rosbag2's YAML, between storages, compressions, files and topics."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.bag.reader import open_bag
from robolink.bag.topic import BagTopic
from robolink.bag.writer import BagWriter
from robolink.cli.main import main
from tests.support.bags import MAP, START, read, read_by_rosbags, ten_messages, write, write_theirs

Captured = pytest.CaptureFixture[str]
MESSAGES = ten_messages()
CHATTER = [each for each in MESSAGES if each.topic == "/chatter"]


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    ("flags", "compression"),
    [
        ([], ""),
        (["--compression", "zstd"], "zstd"),
        (["--compression", "lz4"], "lz4"),
        (["--compression-mode", "file", "--compression-format", "zstd"], "zstd"),
        (["-s", "sqlite3"], ""),
        (["-s", "sqlite3", "--compression-mode", "message", "--compression", "zstd"], "zstd"),
    ],
)
def test_a_bag_becomes_another(flags: list[str], compression: str, capsys: Captured) -> None:
    write_theirs(Path("old"), MESSAGES, version=8, storage="sqlite3")
    assert main(["bag", "convert", "old", "new", *flags]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("new: 10 messages of 2 topics, ")
    assert out.endswith("in 1 file\n")
    assert err == ""
    assert read(Path("new")) == MESSAGES
    with open_bag("new") as new, open_bag("old") as old:
        assert new.compression == compression
        assert new.topics == old.topics
        assert new.metadata.custom_data == {"robot": "r2"}
        assert new.metadata.ros_distro == "rosbags"
    assert read_by_rosbags(Path("new")).messages == MESSAGES


@pytest.mark.parametrize(
    ("flags", "kept"),
    [
        (["--topics", "/chatter"], CHATTER),
        (["--topics", "/chatter", "/map"], MESSAGES),
        (["--exclude-topics", "/map", "/nothing"], CHATTER),
        (["--regex", "ch.t"], CHATTER),
        (["--exclude-regex", "^/m"], CHATTER),
        (["--topic-types", "std_msgs/msg/String"], MESSAGES),
        (["--exclude-topic-types", "std_msgs/msg/String"], []),
        (["--start-offset", "4"], MESSAGES[4:]),
        (["--start-offset", "4", "--duration", "2"], MESSAGES[4:7]),
        (["--duration", "2.5"], MESSAGES[:3]),
    ],
)
def test_some_messages_are_kept(flags: list[str], kept: list[object]) -> None:
    write(Path("old"), MESSAGES)
    assert main(["bag", "convert", "old", "new", *flags]) == 0
    assert read(Path("new")) == kept


def test_times_and_numbers_of_senders_are_kept() -> None:
    write(Path("old"), MESSAGES)
    main(["bag", "convert", "old", "new"])
    with open_bag("new") as bag:
        assert [(each.publish_time, each.sequence) for each in bag.messages()] == [
            (each.stamp - 5, number) for number, each in enumerate(MESSAGES)
        ]


def test_one_file_becomes_several_and_several_one() -> None:
    write(Path("one"), MESSAGES)
    assert main(["bag", "convert", "one", "several", "-d", "3"]) == 0
    assert len(list(Path("several").glob("*.mcap"))) == 4
    assert main(["bag", "convert", "several", "again"]) == 0
    assert len(list(Path("again").glob("*.mcap"))) == 1
    assert read(Path("several")) == read(Path("again")) == MESSAGES


def test_several_bags_become_one_in_order() -> None:
    write(Path("odd"), MESSAGES[1::2])
    write(Path("even"), MESSAGES[::2], storage="sqlite3")
    assert main(["bag", "convert", "odd", "even", "both"]) == 0
    assert main(["bag", "convert", "-i", "odd", "-i", "even", "again"]) == 0
    assert read(Path("both")) == read(Path("again")) == MESSAGES


YAML = """
output_bags:
- uri: everything
  storage_id: mcap
  all_topics: true
  storage_preset_profile: zstd_fast
- uri: chatter
  storage_id: sqlite3
  topics: [/chatter]
  compression_mode: file
  compression_format: zstd
  max_cache_size: 100
- uri: part
  regex: ".*"
  exclude_regex: map
  start_time_ns: %d
  custom_data: {who: me}
"""


def test_rosbag2s_yaml_says_what_is_written(capsys: Captured) -> None:
    write_theirs(Path("old"), MESSAGES)
    Path("out.yaml").write_text(YAML % (START + 2 * 10**9))
    assert main(["bag", "convert", "-i", "old", "mcap", "-o", "out.yaml"]) == 0
    assert [line.partition(",")[0] for line in capsys.readouterr().out.splitlines()] == [
        "everything: 10 messages of 2 topics",
        "chatter: 6 messages of 1 topics",
        "part: 5 messages of 1 topics",
    ]
    assert read(Path("everything")) == MESSAGES
    assert read(Path("chatter")) == CHATTER
    assert read(Path("part")) == [each for each in CHATTER if each.stamp >= START + 2 * 10**9]
    with open_bag("everything") as bag:
        assert bag.compression == "zstd"
    with open_bag("part") as bag:
        assert bag.metadata.custom_data == {"robot": "r2", "who": "me"}
    assert [each.name for each in Path("chatter").glob("*.zstd")] == ["chatter_0.db3.zstd"]


def test_a_key_that_rosbag2_ignores_is_told(capsys: Captured) -> None:
    write(Path("old"), MESSAGES)
    Path("out.yaml").write_text("output_bags: [{uri: new, all_topics: true, all_topic: true}]")
    assert main(["bag", "convert", "-i", "old", "-o", "out.yaml"]) == 0
    reported = "output_bags[0].all_topic: unknown key 'all_topic' (did you mean 'all_topics'?): ignored"
    assert f"robolink: out.yaml:1:44: {reported}\n" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("output_bags: []", "out.yaml:1:14: output_bags: expected at least one output bag"),
        ("output_bags: [{uri: a}]", "nothing is selected"),
        ("bags: 3", "out.yaml:1:1"),
        ("output_bags: [{uri: a, all_topics: true, rmw_serialization_format: xml}]", "only cdr can be written"),
        ("output_bags: [{uri: a, all_topics: true, storage_preset_profile: fast}]", "no storage_preset_profile"),
    ],
)
def test_what_is_wrong_in_the_yaml_is_told(text: str, words: str, capsys: Captured) -> None:
    write(Path("old"), MESSAGES)
    Path("out.yaml").write_text(text)
    assert main(["bag", "convert", "-i", "old", "-o", "out.yaml"]) == 1
    err = capsys.readouterr().err
    assert words in err
    assert err.count("\n") == 1
    assert not Path("a").exists()


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["old"], "convert what into what?"),
        ([], "convert what into what?"),
        (["old", "old"], "'old' exists already"),
        (["olld", "new"], "no bag 'olld' (did you mean 'old'?)"),
        (["old", "new", "--regex", "("], "is not a regular expression"),
        (["old", "new", "--compression-mode", "file"], "needs the format zstd"),
        (["old", "new", "-s", "sqlite3", "--compression", "zstd"], "a file of sqlite3 has no zstd inside"),
        (["old", "new", "-s", "sqlite"], "(did you mean 'sqlite3'?)"),
    ],
)
def test_what_cannot_be_converted_is_told(words: list[str], reason: str, capsys: Captured) -> None:
    write(Path("old"), MESSAGES)
    assert main(["bag", "convert", *words]) in {1, 2}
    err = capsys.readouterr().err
    assert reason in err
    assert err.count("\n") == 1
    assert not Path("new").exists()
    assert read(Path("old")) == MESSAGES


def test_two_types_under_one_name_are_never_mixed(capsys: Captured) -> None:
    number = BagTopic("/chatter", "std_msgs/msg/Int32", "cdr", "RIHS01_" + "cd" * 32, (), "int32 data\n")
    newer = MAP._replace(type_hash="RIHS01_" + "ef" * 32)
    write(Path("one"), MESSAGES)
    with BagWriter(Path("two")) as writer:
        for each in (number, newer):
            writer.write(writer.add_topic(each), START, START, 1, bytes(8))
    assert main(["bag", "convert", "one", "two", "both"]) == 1
    assert capsys.readouterr().err == (
        "robolink: two: topic '/chatter' is a std_msgs/msg/Int32 there, and a std_msgs/msg/String before: convert the"
        " bags one by one, or exclude it\n"
    )
    assert not Path("both").exists()
    assert main(["bag", "convert", "one", "two", "both", "--exclude-topics", "/chatter"]) == 1
    assert "topic '/map' is another std_msgs/msg/String there than before" in capsys.readouterr().err
    assert main(["bag", "convert", "one", "two", "both", "--exclude-topics", "/chatter", "/map"]) == 0


def test_names_may_lack_their_slash_as_on_other_commands() -> None:
    write(Path("old"), MESSAGES)
    assert main(["bag", "convert", "old", "new", "--topics", "chatter"]) == 0
    assert read(Path("new")) == CHATTER
