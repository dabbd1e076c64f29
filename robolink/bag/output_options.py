"""Options of storages and outputs, in rosbag2's YAML and words."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec

from robolink.bag.converting import Output
from robolink.bag.selection import Selection, SelectionError
from robolink.bag.topic import BagError
from robolink.documents.foreign import warn_of_unknown_keys
from robolink.documents.yamlfile import Document, read
from robolink.exceptions import nearest
from robolink.system.terminal import shown

PROFILES = {"": "", "none": "", "fastwrite": "", "resilient": "", "zstd_fast": "zstd", "zstd_small": "zstd"}
"""Presets of rosbag2's storages, each with the compression that it means."""


KNOWN = (
    *("noChunkCRC", "noAttachmentCRC", "enableDataCRC", "noChunking", "noMessageIndex", "noSummary", "chunkSize"),
    *("compression", "compressionLevel", "forceCompression", "noRepeatedSchemas", "noRepeatedChannels"),
    *("noAttachmentIndex", "noMetadataIndex", "noChunkIndex", "noStatistics", "noSummaryOffsets"),
)
"""Keys of a configuration of rosbag2's MCAP storage."""


class _Configuration(msgspec.Struct):
    """Keys of a configuration of rosbag2's MCAP storage that have an effect here."""

    compression: str = "none"


def chunk_compression(profile: str | None, config: str | None) -> str:
    """Return the compression of chunks that a preset profile, or a configuration of the MCAP storage, means.

    Args:
        profile: Name of a preset, such as zstd_fast.
        config: Path of a YAML file, which has precedence; '' or None for none.

    Raises:
        BagError: for an unknown preset.
        DocumentError: for a file that is not as it should be.
    """
    name = profile or ""
    if name not in PROFILES:
        known = [each for each in PROFILES if each]
        raise BagError(
            f"no storage_preset_profile named '{shown(name, 60)}'{nearest(name, known)}: there are {', '.join(known)}"
        )
    if not config:
        return PROFILES[name]
    document = read(config, _Configuration)
    warn_of_unknown_keys(document, document.data, KNOWN)
    return compression_word(document.value.compression)


def compression_word(text: str | None) -> str:
    """Return the name of a compression, or of its mode, as a writer takes it: '' for none."""
    word = (text or "").lower()
    return "" if word == "none" else word


class _OutputBag(msgspec.Struct):
    """Keys of rosbag2's StorageOptions and RecordOptions; those that matter only to a recorder have no effect."""

    uri: str
    storage_id: str | None = ""
    max_bagfile_size: int = 0
    max_bagfile_duration: float = 0
    storage_preset_profile: str | None = ""
    storage_config_uri: str | None = ""
    start_time_ns: int = -1
    end_time_ns: int = -1
    custom_data: dict[str, str] | None = None
    all: bool = False
    all_topics: bool = False
    all_services: bool = False
    all_actions: bool = False
    topics: list[str] = []
    topic_types: list[str] = []
    services: list[str] = []
    actions: list[str] = []
    regex: str = ""
    exclude: str = ""
    exclude_regex: str = ""
    exclude_topics: list[str] = []
    exclude_topic_types: list[str] = []
    exclude_services: list[str] = []
    exclude_actions: list[str] = []
    include_hidden_topics: bool = False
    compression_mode: str | None = ""
    compression_format: str | None = ""
    rmw_serialization_format: str | None = ""
    input_serialization_format: Any = None
    output_serialization_format: Any = None
    max_cache_size: Any = None
    snapshot_mode: Any = None
    is_discovery_disabled: Any = None
    topic_polling_interval: Any = None
    node_prefix: Any = None
    compression_queue_size: Any = None
    compression_threads: Any = None
    compression_threads_priority: Any = None
    topic_qos_profile_overrides: Any = None
    include_unpublished_topics: Any = None
    ignore_leaf_topics: Any = None
    start_paused: Any = None
    use_sim_time: Any = None
    disable_keyboard_controls: Any = None


class _Outputs(msgspec.Struct):
    output_bags: list[_OutputBag]


def read_outputs(path: Path) -> list[Output]:
    """Read the file of `bag convert -o`.

    Raises:
        DocumentError: for a file that is not as it should be; the text begins with file:line:column.
        BagError: for an option that cannot be.
    """
    document = read(path, _Outputs)
    data: Any = document.data
    warn_of_unknown_keys(document, data, _Outputs.__struct_fields__)
    for number, each in enumerate(data["output_bags"]):
        warn_of_unknown_keys(document, each, _OutputBag.__struct_fields__, ["output_bags", number])
    if not document.value.output_bags:
        raise document.error("$.output_bags", "expected at least one output bag")
    return [_output(document, number, each) for number, each in enumerate(document.value.output_bags)]


def _output(document: Document[_Outputs], number: int, bag: _OutputBag) -> Output:
    where = f"$.output_bags[{number}]"
    if (bag.rmw_serialization_format or "cdr") != "cdr":
        raise document.error(f"{where}.rmw_serialization_format", "only cdr can be written")
    try:
        selection = _selection(bag).checked()
    except SelectionError as error:
        raise document.error(where, f"{error} (here: all_topics: true, topics: [...], regex: ...)") from None
    return Output(
        Path(bag.uri),
        bag.storage_id or "mcap",
        selection,
        compression_word(bag.compression_format)
        or chunk_compression(bag.storage_preset_profile, bag.storage_config_uri),
        compression_word(bag.compression_mode),
        bag.max_bagfile_size,
        bag.max_bagfile_duration,
        bag.start_time_ns if bag.start_time_ns >= 0 else None,
        bag.end_time_ns if bag.end_time_ns >= 0 else None,
        dict(bag.custom_data or {}),
    )


def _selection(bag: _OutputBag) -> Selection:
    """Return the topics of an output; where something is left out and nothing chosen, that is all the rest."""
    chosen = Selection(
        all_topics=bag.all_topics or bag.all,
        all_services=bag.all_services or bag.all,
        all_actions=bag.all_actions or bag.all,
        topics=tuple(bag.topics),
        topic_types=tuple(bag.topic_types),
        services=tuple(bag.services),
        actions=tuple(bag.actions),
        regex=bag.regex,
        include_hidden=bag.include_hidden_topics,
    )
    left_out = Selection(
        exclude_regex=bag.exclude_regex or bag.exclude,
        exclude_topics=tuple(bag.exclude_topics),
        exclude_topic_types=tuple(bag.exclude_topic_types),
        exclude_services=tuple(bag.exclude_services),
        exclude_actions=tuple(bag.exclude_actions),
    )
    if chosen._replace(include_hidden=False) == Selection() != left_out:
        chosen = chosen._replace(all_topics=True, all_services=True, all_actions=True)
    excluded = {name: value for name, value in left_out._asdict().items() if name.startswith("exclude")}
    return chosen._replace(**excluded)
