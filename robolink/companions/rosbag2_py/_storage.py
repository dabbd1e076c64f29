"""Options, filters and metadata of rosbag2_py, as plain data that programs fill in and read."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path
from typing import Any

from robolink.bag import information, metadata
from robolink.bag.qos import profiles_of_text
from robolink.bag.topic import BagError, BagTopic
from robolink.duration import Duration as Span
from robolink.exceptions import DocumentError
from robolink.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSPolicyEnum, QoSProfile, ReliabilityPolicy
from robolink.time import Time

__all__ = [
    "BagMetadata",
    "ConverterOptions",
    "Duration",
    "FileInformation",
    "MessageDefinition",
    "MetadataIo",
    "QoS",
    "ReadOrder",
    "ReadOrderSortBy",
    "StorageFilter",
    "StorageOptions",
    "TopicInformation",
    "TopicMetadata",
    "convert_rclcpp_qos_to_rclpy_qos",
    "get_default_storage_id",
    "rmw_qos_durability_policy_t",
    "rmw_qos_history_policy_t",
    "rmw_qos_liveliness_policy_t",
    "rmw_qos_reliability_policy_t",
    "to_rclcpp_qos_vector",
]


@dataclass
class ConverterOptions:
    """Serialization formats of the messages of a bag and of the program: cdr, or '' for that."""

    input_serialization_format: str = ""
    output_serialization_format: str = ""


@dataclass
class StorageOptions:
    """Options of a bag that is read or written.

    Args:
        uri: Its folder, or one storage file.
        storage_id: mcap or sqlite3; '' is mcap for writing, and whatever it is for reading.
        max_bagfile_size: Size of a file, in bytes, at which the next begins; 0 is never.
        max_bagfile_duration: Recorded time of a file, in seconds, at which the next begins; 0 is never.
        max_cache_size: Largest size of a snapshot, in bytes; 0 is 100 MiB.
        storage_preset_profile: zstd_fast or zstd_small compress the chunks of an MCAP.
        storage_config_uri: YAML file of the MCAP storage, of which `compression` has an effect.
        snapshot_mode: True to write only what `take_snapshot` finds in the cache.
        start_time_ns: Time of the first message to read; -1 is any.
        end_time_ns: Time of the last message to read; -1 is any.
        custom_data: Texts for metadata.yaml.
    """

    uri: str = ""
    storage_id: str = ""
    max_bagfile_size: int = 0
    max_bagfile_duration: int = 0
    max_cache_size: int = 0
    storage_preset_profile: str = ""
    storage_config_uri: str = ""
    snapshot_mode: bool = False
    start_time_ns: int = -1
    end_time_ns: int = -1
    custom_data: dict[str, str] = field(default_factory=dict)


@dataclass
class StorageFilter:
    """Topics that a reader yields: all, if nothing is listed and no expression given.

    Args:
        topics: Names of topics.
        services_events: Names of topics of services' events.
        regex: Expression that a whole name must match.
        exclude_topics: Names of topics to leave out.
        exclude_service_events: Names of topics of services' events to leave out.
        regex_to_exclude: Expression of whole names to leave out.
        topics_regex: Name of `regex` in Humble and Iron.
        topics_regex_to_exclude: Name of `regex_to_exclude` in Humble and Iron.
    """

    topics: list[str] = field(default_factory=list)
    services_events: list[str] = field(default_factory=list)
    regex: str = ""
    exclude_topics: list[str] = field(default_factory=list)
    exclude_service_events: list[str] = field(default_factory=list)
    regex_to_exclude: str = ""
    topics_regex: str = ""
    topics_regex_to_exclude: str = ""


@dataclass
class MessageDefinition:
    """Definition of a type as text, with its encoding (ros2msg, ros2idl) and its hash."""

    topic_type: str
    encoding: str
    encoded_message_definition: str
    type_hash: str


class TopicMetadata:
    """Topic of a bag. The number may be left out, as in Humble: `TopicMetadata("/a", "std_msgs/msg/String", "cdr")`.

    Args:
        id: Number of the topic, which readers and writers give out themselves.
        name: Its name.
        type: Its type, such as std_msgs/msg/String.
        serialization_format: cdr.
        offered_qos_profiles: Profiles that publishers offered, or Humble's YAML text of them.
        type_description_hash: Hash of the type; '' is found out where the type is known.
    """

    def __init__(self, *given: Any, **named: Any) -> None:
        order = ("id", "name", "type", "serialization_format", "offered_qos_profiles", "type_description_hash")
        names = order if given and isinstance(given[0], int) else order[1:]
        if len(given) > len(names):
            raise TypeError(f"TopicMetadata takes at most {len(names)} arguments, {len(given)} given")
        values = dict(zip(names, given, strict=False))
        for name in named:
            if name not in order:
                raise TypeError(f"TopicMetadata has no argument '{name}'")
            if name in values:
                raise TypeError(f"TopicMetadata got '{name}' twice")
        values |= named
        if lacking := [each for each in order[1:4] if each not in values]:
            raise TypeError(f"TopicMetadata lacks {', '.join(lacking)}")
        self.id: int = values.get("id", 0)
        self.name: str = values["name"]
        self.type: str = values["type"]
        self.serialization_format: str = values["serialization_format"]
        self.offered_qos_profiles: Any = values.get("offered_qos_profiles") or []
        self.type_description_hash: str = values.get("type_description_hash", "")

    def equals(self, other: TopicMetadata) -> bool:
        """Return whether all but the numbers are the same."""
        return topic_of(self) == topic_of(other)

    def __repr__(self) -> str:
        return f"TopicMetadata(id={self.id}, name={self.name!r}, type={self.type!r})"


@dataclass
class TopicInformation:
    """Topic with its number of messages."""

    topic_metadata: TopicMetadata
    message_count: int


@dataclass
class FileInformation:
    """File of a bag: path, times and number of messages."""

    path: str
    starting_time: Time
    duration: Span
    message_count: int


@dataclass
class BagMetadata:
    """Metadata of a bag; `bag_size` is in bytes. Its text is that of `ros2 bag info`."""

    version: int = metadata.VERSION
    bag_size: int = 0
    storage_identifier: str = ""
    relative_file_paths: list[str] = field(default_factory=list)
    files: list[FileInformation] = field(default_factory=list)
    duration: Span = field(default_factory=Span)
    starting_time: Time = field(default_factory=Time)
    message_count: int = 0
    topics_with_message_count: list[TopicInformation] = field(default_factory=list)
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: dict[str, str] = field(default_factory=dict)
    ros_distro: str = ""

    def __repr__(self) -> str:
        return information.info_text(metadata_from(self))


class ReadOrderSortBy(IntEnum):
    """Time by which a reader sorts; files are read in the order of their messages' times of reception, too."""

    ReceivedTimestamp = 0
    PublishedTimestamp = 1
    File = 2


@dataclass
class ReadOrder:
    """Order of reading."""

    sort_by: ReadOrderSortBy = ReadOrderSortBy.ReceivedTimestamp
    reverse: bool = False


class MetadataIo:
    """Reader and writer of metadata.yaml."""

    def write_metadata(self, uri: str, metadata_: BagMetadata) -> None:
        """Write the metadata.yaml of a bag's folder, as version 8."""
        metadata.write_metadata(Path(uri), metadata_from(metadata_))

    def read_metadata(self, uri: str) -> BagMetadata:
        """Read the metadata.yaml of a bag's folder. Raises BagError (a RuntimeError) if it cannot be read."""
        folder = Path(uri)
        found = metadata.read_metadata(folder)
        found.bag_size = sum(each.stat().st_size for each in folder.iterdir() if each.is_file())
        return metadata_to(found)

    def metadata_file_exists(self, uri: str) -> bool:
        """Return whether a folder has a metadata.yaml."""
        return (Path(uri) / metadata.FILE_NAME).is_file()

    def serialize_metadata(self, metadata_: BagMetadata) -> str:
        """Return metadata as YAML."""
        return metadata.spell_metadata(metadata_from(metadata_))

    def deserialize_metadata(self, serialized_metadata: str) -> BagMetadata:
        """Return the metadata of a YAML text. Raises BagError (a RuntimeError) if it is none."""
        return metadata_to(metadata.parse_metadata(serialized_metadata))


def get_default_storage_id() -> str:
    """Return the storage that is written unless another one is requested."""
    return "mcap"


def topic_of(topic: TopicMetadata) -> BagTopic:
    """Return a topic as `robolink.bag` has it."""
    if not topic.name or not topic.type:
        raise BagError("a topic of a bag needs a name and a type")
    return BagTopic(
        topic.name,
        topic.type,
        topic.serialization_format or "cdr",
        topic.type_description_hash,
        profiles_of(topic.offered_qos_profiles),
    )


def topics_to(topics: Iterable[BagTopic]) -> list[TopicMetadata]:
    """Return topics as rosbag2_py has them, numbered from 1."""
    return [
        TopicMetadata(
            number,
            each.name,
            each.type_name,
            each.serialization_format,
            [QoS.of(profile) for profile in each.offered_qos],
            each.type_hash,
        )
        for number, each in enumerate(topics, start=1)
    ]


def metadata_to(found: metadata.BagMetadata) -> BagMetadata:
    """Return metadata as rosbag2_py has it."""
    topics = topics_to(topic for topic, _ in found.topics_with_message_count)
    counts = [count for _, count in found.topics_with_message_count]
    return BagMetadata(
        found.version,
        found.bag_size,
        found.storage_identifier,
        list(found.relative_file_paths),
        [
            FileInformation(
                each.path, Time(nanoseconds=each.starting_time), Span(nanoseconds=each.duration), each.message_count
            )
            for each in found.files
        ],
        Span(nanoseconds=found.duration),
        Time(nanoseconds=found.starting_time),
        found.message_count,
        [TopicInformation(topic, count) for topic, count in zip(topics, counts, strict=True)],
        found.compression_format,
        found.compression_mode,
        dict(found.custom_data),
        found.ros_distro,
    )


def metadata_from(given: BagMetadata) -> metadata.BagMetadata:
    """Return metadata as `robolink.bag` has it."""
    return metadata.BagMetadata(
        given.version,
        given.bag_size,
        given.storage_identifier,
        list(given.relative_file_paths),
        [
            metadata.FileInformation(
                each.path, each.starting_time.nanoseconds, each.duration.nanoseconds, each.message_count
            )
            for each in given.files
        ],
        given.duration.nanoseconds,
        given.starting_time.nanoseconds,
        given.message_count,
        [(topic_of(each.topic_metadata), each.message_count) for each in given.topics_with_message_count],
        given.compression_format,
        given.compression_mode,
        dict(given.custom_data),
        given.ros_distro,
    )


class CompressionMode(IntEnum):
    """Unit of compression: nothing, the whole file once it is closed, or each message."""

    NONE = 0
    FILE = 1
    MESSAGE = 2


@dataclass
class CompressionOptions:
    """Options of a SequentialCompressionWriter.

    Args:
        compression_format: zstd, or '' for none.
        compression_mode: Unit of compression.
        compression_queue_size: Without effect: nothing waits to be compressed.
        compression_threads: Without effect.
        thread_priority: Without effect.
    """

    compression_format: str = ""
    compression_mode: CompressionMode = CompressionMode.NONE
    compression_queue_size: int = 0
    compression_threads: int = 0
    thread_priority: int | None = None


def compression_mode_from_string(compression_mode: str) -> CompressionMode:
    """Return the mode of a name, in any case; NONE for an unknown one, as rosbag2 does."""
    return CompressionMode.__members__.get(compression_mode.upper(), CompressionMode.NONE)


def compression_mode_to_string(compression_mode: CompressionMode) -> str:
    """Return the name of a mode, in capitals."""
    return CompressionMode(compression_mode).name


def _rmw(name: str, policy: type[QoSPolicyEnum]) -> Any:
    return IntEnum(
        f"rmw_qos_{name}_policy_t", {f"RMW_QOS_POLICY_{name.upper()}_{each.name}": each.value for each in policy}
    )


rmw_qos_history_policy_t = _rmw("history", HistoryPolicy)
"""Histories by rmw's names."""
rmw_qos_reliability_policy_t = _rmw("reliability", ReliabilityPolicy)
"""Reliabilities by rmw's names."""
rmw_qos_durability_policy_t = _rmw("durability", DurabilityPolicy)
"""Durabilities by rmw's names."""
rmw_qos_liveliness_policy_t = _rmw("liveliness", LivelinessPolicy)
"""Kinds of liveliness by rmw's names."""


class Duration(Span):
    """Span of time as rclcpp makes it: of seconds and nanoseconds."""

    def __init__(self, seconds: int, nanoseconds: int) -> None:
        super().__init__(seconds=seconds, nanoseconds=nanoseconds)


class QoS:
    """Profile with setters that return it: `QoS(10).reliable().transient_local()`.

    Args:
        history_depth: Number of samples that are stored.
    """

    def __init__(self, history_depth: int) -> None:
        self._profile = QoSProfile(depth=history_depth)

    @classmethod
    def of(cls, profile: QoSProfile) -> QoS:
        """Return the QoS of an rclpy profile."""
        made = cls(1)
        made._profile = QoSProfile(**(profile.to_dict() | {"history": HistoryPolicy.SYSTEM_DEFAULT}))
        made._profile.history = profile.history
        return made

    def to_profile(self) -> QoSProfile:
        """Return it as an rclpy profile."""
        return self._profile

    def keep_last(self, depth: int) -> QoS:
        """Keep the last `depth` samples."""
        self._profile.depth = depth
        return self._with(history=HistoryPolicy.KEEP_LAST)

    def keep_all(self) -> QoS:
        """Keep all samples."""
        return self._with(history=HistoryPolicy.KEEP_ALL)

    def reliable(self) -> QoS:
        """Set the reliability RELIABLE."""
        return self._with(reliability=ReliabilityPolicy.RELIABLE)

    def best_effort(self) -> QoS:
        """Set the reliability BEST_EFFORT."""
        return self._with(reliability=ReliabilityPolicy.BEST_EFFORT)

    def durability_volatile(self) -> QoS:
        """Set the durability VOLATILE."""
        return self._with(durability=DurabilityPolicy.VOLATILE)

    def transient_local(self) -> QoS:
        """Set the durability TRANSIENT_LOCAL."""
        return self._with(durability=DurabilityPolicy.TRANSIENT_LOCAL)

    def history(self, policy: int) -> QoS:
        """Set the history."""
        return self._with(history=HistoryPolicy(policy))

    def reliability(self, policy: int) -> QoS:
        """Set the reliability."""
        return self._with(reliability=ReliabilityPolicy(policy))

    def durability(self, policy: int) -> QoS:
        """Set the durability."""
        return self._with(durability=DurabilityPolicy(policy))

    def liveliness(self, policy: int) -> QoS:
        """Set the liveliness."""
        return self._with(liveliness=LivelinessPolicy(policy))

    def deadline(self, duration: Span) -> QoS:
        """Set the deadline."""
        return self._with(deadline=duration)

    def lifespan(self, duration: Span) -> QoS:
        """Set the lifespan."""
        return self._with(lifespan=duration)

    def liveliness_lease_duration(self, duration: Span) -> QoS:
        """Set the lease duration of the liveliness."""
        return self._with(liveliness_lease_duration=duration)

    def avoid_ros_namespace_conventions(self, avoids: bool) -> QoS:
        """Set whether the topic's name is not a ROS name."""
        return self._with(avoid_ros_namespace_conventions=avoids)

    def _with(self, **policies: Any) -> QoS:
        for name, value in policies.items():
            setattr(self._profile, name, value)
        return self

    def __eq__(self, other: object) -> bool:
        return isinstance(other, QoS) and self._profile == other._profile

    __hash__ = None  # type: ignore[assignment]  # mutable and compared by value

    def __repr__(self) -> str:
        return f"QoS of {self._profile!r}"


def to_rclcpp_qos_vector(serialized: str, version: int = 9) -> list[QoS]:
    """Return the profiles of a YAML text, in numbers or in words; `version` is for rosbag2's sake.

    Raises RuntimeError for a text that is not YAML.
    """
    try:
        return [QoS.of(each) for each in profiles_of_text(serialized)]
    except DocumentError as error:
        raise RuntimeError(f"Exception on parsing QoS: {error}") from None


def convert_rclcpp_qos_to_rclpy_qos(qos: QoS) -> QoSProfile:
    """Return a profile of rclpy."""
    return QoS.of(qos.to_profile()).to_profile()


def profiles_of(offered: str | Iterable[QoS | QoSProfile]) -> tuple[QoSProfile, ...]:
    """Return the profiles that a program gives for a topic: a YAML text, as in Humble, or a list."""
    found = to_rclcpp_qos_vector(offered) if isinstance(offered, str) else offered
    return tuple(each.to_profile() if isinstance(each, QoS) else each for each in found)
