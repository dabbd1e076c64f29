"""rosbag2_py as public programs use it: readers, writers, filters, metadata, QoS, conversion, the recorder."""

from __future__ import annotations

import gc
import threading
from pathlib import Path

import pytest

from robolink.bag.reader import open_bag
from robolink.companions import rosbag2_py
from robolink.companions.rosbag2_py import (
    BagMetadata,
    CompressionMode,
    CompressionOptions,
    ConverterOptions,
    Info,
    MetadataIo,
    ReadOrder,
    ReadOrderSortBy,
    Reindexer,
    SequentialCompressionReader,
    SequentialCompressionWriter,
    SequentialReader,
    SequentialWriter,
    StorageFilter,
    StorageOptions,
    TopicMetadata,
)
from robolink.companions.rosbag2_py import _storage as storage
from robolink.companions.rosidl_runtime import get_message
from robolink.duration import Duration
from robolink.interfaces.std_msgs.msg import String
from robolink.message import type_hash
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.serialization import deserialize_message, serialize_message
from tests.support.bags import LATCHED, START, read, read_by_rosbags, ten_messages, write, write_theirs

Captured = pytest.CaptureFixture[str]
MESSAGES = ten_messages()
CDR = ConverterOptions(input_serialization_format="cdr", output_serialization_format="cdr")


def opened(path: Path | str, storage_id: str = "") -> SequentialReader:
    reader = SequentialReader()
    reader.open(StorageOptions(uri=str(path), storage_id=storage_id), CDR)
    return reader


def all_of(reader: SequentialReader) -> list[tuple[str, bytes, int]]:
    found = []
    while reader.has_next():
        found.append(reader.read_next())
    return found


def as_read(messages: object) -> list[tuple[str, bytes, int]]:
    return [(each.topic, each.data, each.stamp) for each in messages]  # type: ignore[attr-defined]


@pytest.mark.slow
@pytest.mark.parametrize("storage_id", ["mcap", "sqlite3"])
def test_a_program_writes_and_reads_a_bag(tmp_path: Path, storage_id: str) -> None:
    writer = rosbag2_py.SequentialWriter()
    writer.open(rosbag2_py.StorageOptions(str(tmp_path / "bag"), storage_id), rosbag2_py.ConverterOptions("", ""))
    writer.create_topic(
        rosbag2_py.TopicMetadata(id=0, name="/chatter", type="std_msgs/msg/String", serialization_format="cdr")
    )
    for number in range(10):
        writer.write("/chatter", serialize_message(String(data=f"Hello {number}")), number * 100)
    del writer  # which closes the bag, as rosbag2's tests have it
    gc.collect()

    reader = opened(tmp_path / "bag", storage_id)
    type_map = {each.name: each.type for each in reader.get_all_topics_and_types()}
    for number, (topic, data, stamp) in enumerate(all_of(reader)):
        message = deserialize_message(data, get_message(type_map[topic]))
        assert (message.data, stamp) == (f"Hello {number}", number * 100)
    (definition,) = reader.get_all_message_definitions()
    assert (definition.topic_type, definition.encoding) == ("std_msgs/msg/String", "ros2msg")
    assert "string data" in definition.encoded_message_definition
    assert reader.get_all_topics_and_types()[0].type_description_hash == type_hash(String)
    reader.close()
    theirs = read_by_rosbags(tmp_path / "bag")
    assert len(theirs.messages) == 10
    assert "string data" in theirs.definitions["/chatter"]


def test_humbles_topics_have_no_number_and_a_text_of_qos(tmp_path: Path) -> None:
    text = "- history: 1\n  depth: 7\n  reliability: 2\n  durability: 1"
    topic = storage.TopicMetadata(
        name="a", type="std_msgs/msg/String", serialization_format="cdr", offered_qos_profiles=text
    )
    assert topic.equals(TopicMetadata("a", "std_msgs/msg/String", "cdr", text))
    assert topic.equals(TopicMetadata(3, "a", "std_msgs/msg/String", "cdr", rosbag2_py.to_rclcpp_qos_vector(text)))
    writer = SequentialWriter()
    writer.open(StorageOptions(str(tmp_path / "bag")))
    writer.create_topic(topic)
    writer.close()
    (found,) = opened(tmp_path / "bag").get_all_topics_and_types()
    profile = rosbag2_py.convert_rclcpp_qos_to_rclpy_qos(found.offered_qos_profiles[0])
    assert isinstance(profile, QoSProfile)
    assert (profile.depth, profile.reliability) == (7, ReliabilityPolicy.BEST_EFFORT)
    assert profile.durability is DurabilityPolicy.TRANSIENT_LOCAL


def test_wrong_topics_are_type_errors() -> None:
    wrong: list[tuple[tuple[object, ...], dict[str, str]]] = [
        ((), {}),
        (("a",), {"name": "b"}),
        ((1, "a", "b", "cdr", [], "", 5), {}),
        ((), {"nmae": "a"}),
    ]
    for given, named in wrong:
        with pytest.raises(TypeError, match="TopicMetadata"):
            TopicMetadata(*given, **named)


def test_qos_is_set_in_a_chain() -> None:
    qos = (
        storage.QoS(10)
        .keep_last(1)
        .history(storage.rmw_qos_history_policy_t.RMW_QOS_POLICY_HISTORY_KEEP_LAST)
        .reliability(storage.rmw_qos_reliability_policy_t.RMW_QOS_POLICY_RELIABILITY_RELIABLE)
        .durability(storage.rmw_qos_durability_policy_t.RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL)
        .liveliness(storage.rmw_qos_liveliness_policy_t.RMW_QOS_POLICY_LIVELINESS_AUTOMATIC)
        .deadline(LATCHED.deadline)
        .lifespan(LATCHED.lifespan)
        .liveliness_lease_duration(LATCHED.liveliness_lease_duration)
        .avoid_ros_namespace_conventions(False)
    )
    assert qos == storage.QoS.of(LATCHED)
    assert qos.to_profile() == LATCHED
    assert storage.QoS(1).best_effort().durability_volatile() != qos
    assert storage.QoS(1).keep_all().reliable().transient_local().to_profile().history.name == "KEEP_ALL"
    assert storage.Duration(1, 500) == Duration(nanoseconds=1_000_000_500)
    with pytest.raises(RuntimeError):
        rosbag2_py.to_rclcpp_qos_vector("{")


@pytest.mark.parametrize(
    ("chosen", "kept"),
    [
        (StorageFilter(), ["/chatter", "/map"]),
        (StorageFilter(topics=["/chatter"]), ["/chatter"]),
        (StorageFilter(topics=["/map", "/nothing"]), ["/map"]),
        (StorageFilter(regex="/m.*"), ["/map"]),
        (StorageFilter(regex="m"), []),
        (StorageFilter(topics_regex=".*r"), ["/chatter"]),
        (StorageFilter(exclude_topics=["/map"]), ["/chatter"]),
        (StorageFilter(regex_to_exclude="/c.*"), ["/map"]),
        (StorageFilter(topics=["/map"], regex=".*", exclude_topics=["/map"]), ["/chatter"]),
    ],
)
def test_a_filter_chooses_topics(tmp_path: Path, chosen: StorageFilter, kept: list[str]) -> None:
    write(tmp_path / "bag", MESSAGES)
    reader = opened(tmp_path / "bag")
    reader.set_filter(chosen)
    assert all_of(reader) == as_read(each for each in MESSAGES if each.topic in kept)


def test_a_filter_goes_on_from_where_the_reader_is(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES)
    reader = opened(tmp_path / "bag")
    for _ in range(4):
        reader.read_next()
    reader.set_filter(StorageFilter(topics=["/chatter"]))
    assert reader.read_next()[2] == MESSAGES[4].stamp
    reader.reset_filter()
    assert all_of(reader) == as_read(MESSAGES[5:])
    with pytest.raises(RuntimeError, match="is not a regular expression"):
        reader.set_filter(StorageFilter(regex="("))


def test_messages_of_one_time_are_read_once_each(tmp_path: Path) -> None:
    same = [each._replace(stamp=START) for each in MESSAGES]
    write(tmp_path / "bag", same)
    reader = opened(tmp_path / "bag")
    first = [reader.read_next() for _ in range(5)]
    reader.set_filter(StorageFilter())
    assert sorted([*first, *all_of(reader)]) == sorted(as_read(same))


def test_seeking_keeps_the_filter(tmp_path: Path) -> None:
    write_theirs(tmp_path / "bag", MESSAGES, storage="sqlite3")
    reader = opened(tmp_path / "bag")
    reader.set_filter(StorageFilter(topics=["/map"]))
    reader.seek(MESSAGES[4].stamp)
    assert all_of(reader) == as_read([MESSAGES[6], MESSAGES[9]])
    reader.seek(0)
    assert len(all_of(reader)) == 4
    reader.seek(2**62)
    assert not reader.has_next()
    with pytest.raises(RuntimeError, match="Bag is at end"):
        reader.read_next()


def test_a_bag_is_read_backwards(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES, max_duration=3.0)
    reader = opened(tmp_path / "bag")
    assert reader.set_read_order(ReadOrder(ReadOrderSortBy.ReceivedTimestamp, True))
    assert all_of(reader) == as_read(reversed(MESSAGES))
    reader.seek(MESSAGES[3].stamp)
    assert all_of(reader) == as_read(MESSAGES[3::-1])
    assert not reader.set_read_order(ReadOrder(sort_by=ReadOrderSortBy.PublishedTimestamp))


def test_a_part_of_a_bag_is_read(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES)
    reader = SequentialReader()
    times = {"start_time_ns": MESSAGES[2].stamp, "end_time_ns": MESSAGES[5].stamp}
    reader.open(StorageOptions(str(tmp_path / "bag"), "", **times))  # type: ignore[arg-type]
    assert all_of(reader) == as_read(MESSAGES[2:6])


@pytest.mark.parametrize("mode", [CompressionMode.FILE, CompressionMode.MESSAGE])
def test_compressed_bags_are_written_and_read(tmp_path: Path, mode: CompressionMode) -> None:
    writer = SequentialCompressionWriter(CompressionOptions("zstd", mode))
    writer.open(StorageOptions(str(tmp_path / "bag"), "sqlite3"), ConverterOptions("", ""))
    writer.create_topic(TopicMetadata(0, "/chatter", "std_msgs/msg/String", "cdr"))
    for each in MESSAGES:
        writer.write("/chatter", each.data, each.stamp)
    writer.close()
    reader = SequentialCompressionReader()
    reader.open_uri(str(tmp_path / "bag"))
    assert [data for _, data, _ in all_of(reader)] == [each.data for each in MESSAGES]
    assert reader.get_metadata().compression_mode == mode.name.lower()
    assert rosbag2_py.compression_mode_from_string("file") is CompressionMode.FILE
    assert rosbag2_py.compression_mode_to_string(mode) == mode.name


def test_a_snapshot_is_what_came_last(tmp_path: Path) -> None:
    writer = SequentialWriter()
    writer.open(StorageOptions(str(tmp_path / "bag"), snapshot_mode=True, max_cache_size=60))
    writer.create_topic(TopicMetadata(0, "/chatter", "std_msgs/msg/String", "cdr"))
    assert not writer.take_snapshot()
    for each in MESSAGES:
        writer.write("/chatter", each.data, each.stamp)
    assert writer.take_snapshot()
    writer.split_bagfile()
    writer.close()
    assert [each.stamp for each in read(tmp_path / "bag")] == [each.stamp for each in MESSAGES[-3:]]
    with open_bag(tmp_path / "bag") as bag:
        assert len(bag.metadata.files) == 2


def test_times_of_sending_and_presets(tmp_path: Path) -> None:
    writer = SequentialWriter()
    options = StorageOptions(str(tmp_path / "bag"), "mcap", storage_preset_profile="zstd_fast", custom_data={"a": "b"})
    writer.open(options, CDR)
    topic = TopicMetadata(0, "/chatter", "std_msgs/msg/String", "cdr")
    writer.create_topic(topic)
    writer.write("/chatter", MESSAGES[0].data, START, START - 5)
    writer.remove_topic(topic)
    with pytest.raises(RuntimeError, match=r"Call create_topic\(\) before first write"):
        writer.write("/chatter", MESSAGES[0].data, START)
    writer.close()
    with open_bag(tmp_path / "bag") as bag:
        assert bag.compression == "zstd"
        assert bag.metadata.custom_data == {"a": "b"}
        assert [each.publish_time for each in bag.messages()] == [START - 5]


def test_what_is_not_open_is_told() -> None:
    for call in (SequentialReader().has_next, SequentialReader().read_next, SequentialReader().get_metadata):
        with pytest.raises(RuntimeError, match=r"Bag is not open. Call open\(\) before reading."):
            call()
    with pytest.raises(RuntimeError, match=r"Bag is not open. Call open\(\) before writing."):
        SequentialWriter().write("/a", b"", 0)


def test_a_bag_that_is_not_there_or_there_already_is_told(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="no bag"):
        opened(tmp_path / "nothing")
    write(tmp_path / "bag")
    with pytest.raises(RuntimeError, match="exists already"):
        SequentialWriter().open(StorageOptions(str(tmp_path / "bag"), "mcap"), ConverterOptions("", ""))
    with pytest.raises(RuntimeError, match="cdr"):
        SequentialWriter().open(StorageOptions(str(tmp_path / "new")), ConverterOptions("cdr", "xml"))
    with pytest.raises(RuntimeError, match="not 'xml'"):
        SequentialReader().open(StorageOptions(str(tmp_path / "bag")), ConverterOptions("cdr", "xml"))


def test_metadata_has_rclpys_times(tmp_path: Path) -> None:
    write_theirs(tmp_path / "bag", MESSAGES)
    metadata = Info().read_metadata(str(tmp_path / "bag"), "mcap")
    assert metadata.duration == Duration(seconds=9)
    assert metadata.starting_time.nanoseconds == START
    assert metadata.message_count == 10
    assert {each.topic_metadata.name: each.message_count for each in metadata.topics_with_message_count} == {
        "/chatter": 6, "/map": 4,
    }  # fmt: skip
    assert metadata.files[0].path == metadata.relative_file_paths[0]
    assert "Messages:          10" in repr(metadata)
    again = MetadataIo().deserialize_metadata(MetadataIo().serialize_metadata(metadata))
    again.version, again.bag_size = metadata.version, metadata.bag_size
    assert MetadataIo().serialize_metadata(again) == MetadataIo().serialize_metadata(metadata)
    assert BagMetadata().message_count == 0


def test_metadata_is_written_and_made_anew(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES)
    files = MetadataIo()
    metadata = files.read_metadata(str(tmp_path / "bag"))
    metadata.custom_data = {"new": "data"}
    files.write_metadata(str(tmp_path / "bag"), metadata)
    assert opened(tmp_path / "bag").get_metadata().custom_data == {"new": "data"}
    (tmp_path / "bag" / "metadata.yaml").unlink()
    assert not files.metadata_file_exists(str(tmp_path / "bag"))
    Reindexer().reindex(StorageOptions(str(tmp_path / "bag"), "mcap"))
    assert files.read_metadata(str(tmp_path / "bag")).message_count == 10


def test_info_prints_what_the_command_prints(tmp_path: Path, capsys: Captured) -> None:
    write(tmp_path / "bag", MESSAGES)
    info = Info()
    metadata = info.read_metadata(str(tmp_path / "bag"), "")
    info.print_output(metadata, "name")
    assert "Topic: /chatter | Type: std_msgs/msg/String | Count: 6 |" in capsys.readouterr().out
    info.print_output_topic_name_only(metadata, "count")
    assert capsys.readouterr().out == "/map\n/chatter\n"
    info.print_output_verbose(str(tmp_path / "bag"), metadata, "type")
    assert "Size Contribution: " in capsys.readouterr().out
    assert info.get_sorting_methods() == {"name", "type", "count"}


def test_bags_are_rewritten(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES)
    options = tmp_path / "options.yaml"
    options.write_text(f"output_bags:\n- uri: '{tmp_path / 'new'}'\n  exclude: '.*map'\n")
    rosbag2_py.bag_rewrite([StorageOptions(str(tmp_path / "bag"))], str(options))
    assert {each.topic for each in read(tmp_path / "new")} == {"/chatter"}
    options.write_text("bags: []")
    with pytest.raises(RuntimeError, match=r"options\.yaml:1:1"):
        rosbag2_py.bag_rewrite([], str(options))


def test_definitions_are_those_of_installed_types() -> None:
    found = rosbag2_py.LocalMessageDefinitionSource().get_full_text("std_msgs/msg/Header")
    assert found.encoding == "ros2msg"
    assert "MSG: builtin_interfaces/Time" in found.encoded_message_definition
    unknown = rosbag2_py.LocalMessageDefinitionSource().get_full_text("some_pkg")
    assert (unknown.encoding, unknown.encoded_message_definition) == ("unknown", "")


BASIC_IDL = "module kit { module msg { struct Basic { float x; }; }; };\n"
WHOLE_IDL = '#include "kit/msg/Basic.idl"\nmodule kit { module msg { struct Whole { kit::msg::Basic a; }; }; };\n'
LINE = "=" * 80 + "\n"


def test_definitions_are_the_files_of_a_workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, text in {
        "msg/Part.msg": "# metres\nfloat32 c\n",
        "msg/Set.msg": "Header header  # when\nPart[<=2] parts\nkit/Part first\nint8 ON=1\n",
        "msg/Basic.idl": BASIC_IDL,
        "msg/Whole.idl": WHOLE_IDL,
        "srv/Ask.srv": "Part p\n---\nBasic b\n",
        "msg/Mixed.msg": "Basic basic\n",
        "srv/Lacks.srv": "Nothing p\n---\n",
    }.items():
        (tmp_path / "interfaces/kit" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "interfaces/kit" / name).write_text(text)
    monkeypatch.setenv("ROBOLINK_WORKSPACE", str(tmp_path))
    full = rosbag2_py.LocalMessageDefinitionSource().get_full_text
    found = full("kit/Set")
    assert found.encoding == "ros2msg"
    text = "Header header  # when\nPart[<=2] parts\nkit/Part first\nint8 ON=1\n"
    assert found.encoded_message_definition.startswith(f"{text}\n{LINE}MSG: kit/Part\n# metres\nfloat32 c\n")
    assert f"\n{LINE}MSG: std_msgs/Header\n" in found.encoded_message_definition
    assert found.type_hash.startswith("RIHS01_")
    of_idl = full("kit/msg/Whole")
    assert of_idl.encoding == "ros2idl"
    whole = f"{LINE}IDL: kit/msg/Whole\n{WHOLE_IDL}\n{LINE}IDL: kit/msg/Basic\n{BASIC_IDL}"
    assert of_idl.encoded_message_definition == whole
    asked = full("kit/srv/Ask").encoded_message_definition
    assert asked.startswith(
        f"{LINE}SRV: kit/srv/Ask\nPart p\n---\nBasic b\n\n{LINE}MSG: kit/Basic\n\n{LINE}IDL: kit/Basic"
    )
    assert asked.endswith(f"\n{LINE}MSG: kit/Part\n# metres\nfloat32 c\n")
    mixed = full("kit/Mixed")  # what rosbag2 has here is an .idl file that the build makes
    assert (mixed.encoding, mixed.encoded_message_definition[:11]) == ("ros2msg", "Basic basic")
    assert "MSG: kit/Basic\n" in mixed.encoded_message_definition
    for unknown in ("kit/srv/Lacks", "kit/srv/Nothing", "kit/Nothing", "kit", "../kit/Set"):
        assert (full(unknown).encoding, full(unknown).encoded_message_definition) == ("unknown", "")


def test_plugins_are_named() -> None:
    assert rosbag2_py.get_registered_readers() == rosbag2_py.get_registered_writers() == {"mcap", "sqlite3"}
    assert rosbag2_py.get_registered_compressors() == {"zstd"}
    assert rosbag2_py.get_registered_serializers() == {"cdr"}
    assert rosbag2_py.get_default_storage_id() == "mcap"


def test_a_recorder_records_until_it_is_cancelled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOLINK_NETWORK", "off")
    options = rosbag2_py.RecordOptions()
    options.topics = ["/chatter"]
    options.disable_keyboard_controls = True
    recorder = rosbag2_py.Recorder("warn")
    running = threading.Thread(
        target=recorder.record, args=(StorageOptions(str(tmp_path / "bag"), "sqlite3"), options, "recorder")
    )
    running.start()
    recorder.cancel()
    running.join()
    with open_bag(tmp_path / "bag") as bag:
        assert bag.metadata.storage_identifier == "sqlite3"
    with pytest.raises(RuntimeError, match="did you mean"):
        rosbag2_py.Recorder("wran")
