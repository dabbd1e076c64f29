"""metadata.yaml: versions 4 to 9 are read, version 8 is written, and whatever is wrong in one is told in a line."""

from __future__ import annotations

import string
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import example, given
from hypothesis import strategies as st

from robolink.bag.metadata import (
    BagMetadata,
    FileInformation,
    parse_metadata,
    read_metadata,
    spell_metadata,
    write_metadata,
)
from robolink.bag.qos import profiles_of_text, profiles_or_none, text_of
from robolink.bag.topic import BagError, BagTopic
from robolink.duration import Duration, Infinite
from robolink.exceptions import DocumentError
from robolink.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy
from tests.support.bags import LATCHED

WORDS = st.text(max_size=30)
NUMBERS = st.integers(0, 2**63 - 1)
SPANS = NUMBERS.map(lambda each: Duration(nanoseconds=each))


def profile(*values: Any) -> QoSProfile:
    names = ("history", "reliability", "durability", "liveliness", "deadline", "lifespan", "liveliness_lease_duration")
    made = QoSProfile(depth=values[0], **dict(zip(names[1:], values[2:-1], strict=True)))
    made.avoid_ros_namespace_conventions = values[-1]
    made.history = values[1]
    return made


QOS = st.builds(
    profile,
    st.integers(1, 2**31 - 1),
    st.sampled_from(HistoryPolicy),
    st.sampled_from(ReliabilityPolicy),
    st.sampled_from(DurabilityPolicy),
    st.sampled_from(LivelinessPolicy),
    SPANS,
    SPANS,
    SPANS,
    st.booleans(),
)
TOPICS = st.builds(
    BagTopic, WORDS, WORDS, st.just("cdr"), WORDS, st.lists(QOS, max_size=2).map(tuple), st.just(""), st.just("ros2msg")
)
METADATA = st.builds(
    BagMetadata,
    storage_identifier=st.sampled_from(["mcap", "sqlite3"]),
    relative_file_paths=st.lists(WORDS, max_size=3),
    files=st.lists(st.builds(FileInformation, WORDS, NUMBERS, NUMBERS, NUMBERS), max_size=3),
    duration=NUMBERS,
    starting_time=NUMBERS,
    message_count=NUMBERS,
    topics_with_message_count=st.lists(st.tuples(TOPICS, NUMBERS), max_size=3),
    compression_format=st.sampled_from(["", "zstd"]),
    compression_mode=st.sampled_from(["", "file", "message"]),
    custom_data=st.dictionaries(WORDS, WORDS, max_size=3),
    ros_distro=WORDS,
)


@given(METADATA)
def test_what_is_written_is_read_back(metadata: BagMetadata) -> None:
    assert parse_metadata(spell_metadata(metadata)) == metadata


@given(METADATA)
def test_another_parser_reads_the_same(metadata: BagMetadata) -> None:
    """PyYAML is one of YAML 1.1, as yaml-cpp is in the main."""
    data = yaml.safe_load(spell_metadata(metadata))
    assert data["version"] == 8
    assert data["custom_data"] == metadata.custom_data
    assert data["relative_file_paths"] == metadata.relative_file_paths
    topics = [(each["topic_metadata"]["name"], each["message_count"]) for each in data["topics_with_message_count"]]
    assert topics == [(topic.name, count) for topic, count in metadata.topics_with_message_count]


def test_the_file_has_the_keys_of_rosbag2_in_its_order(tmp_path: Path) -> None:
    topic = BagTopic("/a", "b/msg/C", "cdr", "", (LATCHED,))
    write_metadata(tmp_path, BagMetadata(topics_with_message_count=[(topic, 3)]))
    text = (tmp_path / "metadata.yaml").read_text(encoding="utf-8")
    information = yaml.safe_load(text)["rosbag2_bagfile_information"]
    assert list(information) == [
        "version", "storage_identifier", "duration", "starting_time", "message_count", "topics_with_message_count",
        "compression_format", "compression_mode", "relative_file_paths", "files", "custom_data", "ros_distro",
    ]  # fmt: skip
    (written,) = information["topics_with_message_count"]
    assert list(written["topic_metadata"]) == [
        "name", "type", "serialization_format", "offered_qos_profiles", "type_description_hash",
    ]  # fmt: skip
    assert [each.name for each in tmp_path.iterdir()] == ["metadata.yaml"], "nothing else is left"


def test_qos_is_written_in_numbers_which_humble_reads() -> None:
    assert yaml.safe_load(text_of([LATCHED])) == [
        {
            "history": 1,
            "depth": 1,
            "reliability": 1,
            "durability": 1,
            "deadline": {"sec": 9223372036, "nsec": 854775807},
            "lifespan": {"sec": 9223372036, "nsec": 854775807},
            "liveliness": 1,
            "liveliness_lease_duration": {"sec": 9223372036, "nsec": 854775807},
            "avoid_ros_namespace_conventions": False,
        }
    ]


VERSION_4 = """
rosbag2_bagfile_information:
  version: 4
  storage_identifier: sqlite3
  relative_file_paths:
    - a_0.db3
  duration: {nanoseconds: 411}
  starting_time: {nanoseconds_since_epoch: 2623}
  message_count: 3
  topics_with_message_count:
    - topic_metadata: {name: /a, type: std_msgs/msg/String, serialization_format: cdr, offered_qos_profiles: ""}
      message_count: 3
  compression_format: ""
  compression_mode: NONE
"""
VERSION_9 = """
rosbag2_bagfile_information:
  version: 9
  storage_identifier: mcap
  duration: {nanoseconds: 0}
  starting_time: {nanoseconds_since_epoch: 9223372036854775807}
  message_count: 0
  topics_with_message_count:
    - topic_metadata:
        name: /tf_static
        type: tf2_msgs/msg/TFMessage
        serialization_format: cdr
        offered_qos_profiles:
          - history: keep_last
            depth: 1
            reliability: reliable
            durability: transient_local
            deadline: {sec: 9223372036, nsec: 854775807}
            lifespan: {sec: 2147483647, nsec: 4294967295}
            liveliness: automatic
            liveliness_lease_duration: {sec: 0, nsec: 5}
            avoid_ros_namespace_conventions: false
        type_description_hash: RIHS01_e369
      message_count: 0
  compression_format: zstd
  compression_mode: FILE
  relative_file_paths: [b_0.mcap.zstd]
  files:
    - path: b_0.mcap.zstd
      starting_time: {nanoseconds_since_epoch: 5}
      duration: {nanoseconds: 6}
      message_count: 7
  custom_data:
    robot: 012
    nothing: ~
  ros_distro: rolling
  something_new: {of: the future}
"""


def test_version_4_has_less() -> None:
    metadata = parse_metadata(VERSION_4)
    assert (metadata.version, metadata.starting_time, metadata.end_time) == (4, 2623, 3034)
    assert metadata.topics_with_message_count == [(BagTopic("/a", "std_msgs/msg/String"), 3)]
    assert (metadata.compression_mode, metadata.files, metadata.custom_data) == ("", [], {})


def test_version_9_has_words_for_policies_and_later_ones_have_more_keys() -> None:
    metadata = parse_metadata(VERSION_9)
    ((topic, _),) = metadata.topics_with_message_count
    (qos,) = topic.offered_qos
    assert (qos.history, qos.depth, qos.reliability) == (HistoryPolicy.KEEP_LAST, 1, ReliabilityPolicy.RELIABLE)
    assert (qos.durability, qos.liveliness) == (DurabilityPolicy.TRANSIENT_LOCAL, LivelinessPolicy.AUTOMATIC)
    assert (qos.deadline, qos.lifespan) == (Infinite, Infinite), "the second is Fast DDS's of Foxy"
    assert qos.liveliness_lease_duration == Duration(nanoseconds=5)
    assert topic.type_hash == "RIHS01_e369"
    assert (metadata.compression_mode, metadata.compression_format) == ("file", "zstd")
    assert metadata.files == [FileInformation("b_0.mcap.zstd", 5, 6, 7)]
    assert metadata.custom_data == {"robot": "012", "nothing": ""}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "expected the mapping 'rosbag2_bagfile_information' with a 'version'"),
        ("[1, 2]", "expected the mapping"),
        ("a: [", "metadata.yaml:1:5"),
        ("rosbag2_bagfile_information: {version: nine}", "version: Expected `int`, got `str`"),
        ("version: 12\nduration: long", "(it is version 12; 1 to 9 are known)"),
        ("version: 9\nfiles: [{duration: {}}]", "files[0]: Object missing required field `path`"),
        ("version: 5\nmessage_count: many", "message_count: Expected `int`, got `str`"),
        ("\0", "character U+0000 is not allowed"),
    ],
)
def test_what_is_wrong_is_told_in_one_line(text: str, words: str) -> None:
    with pytest.raises(BagError) as refused:
        parse_metadata(text)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


@given(st.text(alphabet=string.printable + "é\0", max_size=300))
@example(VERSION_9.replace("keep_last", "{}"))
def test_any_text_is_metadata_or_an_error(text: str) -> None:
    try:
        parse_metadata(text)
    except BagError as error:
        assert "\n" not in str(error)  # noqa: PT017


@given(st.integers(0, len(VERSION_9) - 1), st.integers(1, 40), st.text(alphabet="{}[]:-~ 0x\n", max_size=5))
def test_damaged_metadata_is_metadata_or_an_error(place: int, length: int, other: str) -> None:
    try:
        parse_metadata(VERSION_9[:place] + other + VERSION_9[place + length :])
    except BagError as error:
        assert "\n" not in str(error)  # noqa: PT017


@given(st.text(alphabet=string.printable, max_size=100))
@example("- history: 99\n  depth: -3\n  deadline: soon")
@example("- {history: keep_last, depth: 0}")
def test_qos_that_cannot_be_read_is_unknown(text: str) -> None:
    try:
        profiles_of_text(text)
    except DocumentError:
        assert profiles_or_none(text) == ()


def test_a_file_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(BagError, match="no file"):
        read_metadata(tmp_path)
