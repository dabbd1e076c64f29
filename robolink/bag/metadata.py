"""Metadata of a bag, the file metadata.yaml: versions 4 to 9 of rosbag2's format are read, version 8 is written.

Version 8 has the QoS profiles as a text of numbers. Humble reads that, and so does every later distribution; the words
of version 9 end Humble's reader.
"""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import msgspec

from robolink.bag.qos import profiles_of_list, profiles_or_none, text_of
from robolink.bag.topic import BagError, BagTopic
from robolink.documents.foreign import unknown_key, warn
from robolink.documents.yamlfile import read_text
from robolink.documents.yamltext import compose, texts
from robolink.exceptions import DocumentError
from robolink.system.files import put_in_place
from robolink.system.terminal import quoted, shown

FILE_NAME = "metadata.yaml"
VERSION = 8
"""Version that is written: 9 has QoS in words, which end Humble's reader; all later ones read 8."""
OLDEST, NEWEST = 1, 9
"""Versions of the format that are known; a newer one is read as far as it is the same."""

_KEY = "rosbag2_bagfile_information"


class FileInformation(msgspec.Struct):
    """File of a bag: its path within the folder, start and duration in nanoseconds, and its number of messages."""

    path: str
    starting_time: int = 0
    duration: int = 0
    message_count: int = 0


class BagMetadata(msgspec.Struct):
    """Metadata of a bag, under rosbag2's names.

    Times are nanoseconds since 1970, durations nanoseconds, `bag_size` bytes (of all files, which is not stored).
    `compression_mode` is '', `file` or `message`; an MCAP's own compression of chunks is not told here.
    """

    version: int = VERSION
    bag_size: int = 0
    storage_identifier: str = ""
    relative_file_paths: list[str] = []
    files: list[FileInformation] = []
    duration: int = 0
    starting_time: int = 0
    message_count: int = 0
    topics_with_message_count: list[tuple[BagTopic, int]] = []
    compression_format: str = ""
    compression_mode: str = ""
    custom_data: dict[str, str] = {}
    ros_distro: str = ""

    @property
    def end_time(self) -> int:
        """Time of the last message, in nanoseconds since 1970."""
        return self.starting_time + self.duration


class _Span(msgspec.Struct, frozen=True):
    nanoseconds: int = 0


class _Start(msgspec.Struct, frozen=True):
    nanoseconds_since_epoch: int = 0


class _Topic(msgspec.Struct):
    name: str
    type: str
    serialization_format: str | None = "cdr"
    offered_qos_profiles: str | list[Any] | None = None
    type_description_hash: str | None = ""


class _Counted(msgspec.Struct):
    topic_metadata: _Topic
    message_count: int = 0


class _File(msgspec.Struct):
    path: str
    starting_time: _Start = _Start()
    duration: _Span = _Span()
    message_count: int = 0


class _Stored(msgspec.Struct):
    """The mapping below rosbag2_bagfile_information, as it is in the file."""

    version: int
    storage_identifier: str = ""
    duration: _Span = _Span()
    starting_time: _Start = _Start()
    message_count: int = 0
    topics_with_message_count: list[_Counted] | None = None
    compression_format: str | None = ""
    compression_mode: str | None = ""
    relative_file_paths: list[str] | None = None
    files: list[_File] | None = None
    custom_data: dict[str, str | None] | None = None
    ros_distro: str | None = ""


def read_metadata(folder: Path) -> BagMetadata:
    """Read the `metadata.yaml` of a bag's folder. Raises BagError, which names the file and what is wrong in it."""
    path = folder / FILE_NAME
    try:
        text = read_text(path)
    except DocumentError as error:
        raise BagError(str(error)) from None
    return parse_metadata(text, str(path), tells=True)


def parse_metadata(text: str, name: str = FILE_NAME, *, tells: bool = False) -> BagMetadata:
    """Parse metadata, as it is in `metadata.yaml` or (without the outermost key) in a storage file.

    Args:
        text: The YAML text.
        name: Name of the text in errors.
        tells: True to give a `FileWarning` for keys that are not known, and are ignored, as by rosbag2.

    Raises:
        BagError: for a text that is not metadata.
    """
    try:
        data = texts(compose(text, name), name)
    except DocumentError as error:
        raise BagError(str(error)) from None
    if isinstance(data, dict):
        data = data.get(_KEY, data)
    if not isinstance(data, dict) or "version" not in data:
        raise BagError(f"{name}: expected the mapping '{_KEY}' with a 'version', which rosbag2 writes")
    try:
        stored = msgspec.convert(data, _Stored, strict=False)
    except msgspec.ValidationError as error:
        raise BagError(f"{name}: {_reason(error)}{_of_version(data)}") from None
    for key in data if tells else ():
        if key not in _Stored.__struct_fields__:
            warn(f"{name}: {unknown_key(key, _Stored.__struct_fields__)}{_of_version(data)}")
    return _metadata(stored)


def spell_metadata(metadata: BagMetadata) -> str:
    """Format metadata as version 8, without the outermost key: as it is within storage files."""
    topics = [line for each in metadata.topics_with_message_count for line in _topic_lines(*each)]
    files = [line for each in metadata.files for line in _file_lines(each)]
    custom = [f"  {_text(key)}: {_text(value)}" for key, value in metadata.custom_data.items()]
    lines = [
        f"version: {VERSION}",
        f"storage_identifier: {_text(metadata.storage_identifier)}",
        "duration:",
        f"  nanoseconds: {metadata.duration}",
        "starting_time:",
        f"  nanoseconds_since_epoch: {metadata.starting_time}",
        f"message_count: {metadata.message_count}",
        *_listed("topics_with_message_count", topics),
        f"compression_format: {_text(metadata.compression_format)}",
        f"compression_mode: {_text(metadata.compression_mode)}",
        *_listed("relative_file_paths", [f"  - {_text(each)}" for each in metadata.relative_file_paths]),
        *_listed("files", files),
        *_listed("custom_data", custom, "{}"),
        f"ros_distro: {_text(metadata.ros_distro)}",
    ]
    return "\n".join(lines)


def write_metadata(folder: Path, metadata: BagMetadata) -> None:
    """Write `metadata.yaml` into a bag's folder as version 8; whoever reads it meanwhile sees the old or the new.

    Raises OSError, with the name of the file, if it cannot be written; the old one is there then.
    """
    body = "\n".join(f"  {line}" for line in spell_metadata(metadata).split("\n"))
    partial = folder / f".{FILE_NAME}.partial"
    try:
        partial.write_text(f"{_KEY}:\n{body}\n", encoding="utf-8", newline="\n")
        put_in_place(partial, folder / FILE_NAME)
    except OSError as error:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)
        raise OSError(error.errno, error.strerror or str(error), str(folder / FILE_NAME)) from None


def metadata_of(topics: Iterable[tuple[BagTopic, int]], files: Iterable[FileInformation], **other: Any) -> BagMetadata:
    """Return metadata whose sums are those of `files`; `other` are further fields of BagMetadata."""
    counted, parts = list(topics), list(files)
    filled = [each for each in parts if each.message_count]
    start = min((each.starting_time for each in filled), default=0)
    end = max((each.starting_time + each.duration for each in filled), default=0)
    return BagMetadata(
        relative_file_paths=[each.path for each in parts],
        files=parts,
        starting_time=start,
        duration=end - start,
        message_count=sum(each.message_count for each in parts),
        topics_with_message_count=counted,
        **other,
    )


def _metadata(stored: _Stored) -> BagMetadata:
    topics = [(_topic(each.topic_metadata), each.message_count) for each in stored.topics_with_message_count or []]
    files = [
        FileInformation(
            each.path, each.starting_time.nanoseconds_since_epoch, each.duration.nanoseconds, each.message_count
        )
        for each in stored.files or []
    ]
    return BagMetadata(
        version=stored.version,
        storage_identifier=stored.storage_identifier,
        relative_file_paths=stored.relative_file_paths or [],
        files=files,
        duration=stored.duration.nanoseconds,
        starting_time=stored.starting_time.nanoseconds_since_epoch,
        message_count=stored.message_count,
        topics_with_message_count=topics,
        compression_format=_word(stored.compression_format),
        compression_mode=_word(stored.compression_mode),
        custom_data=_custom(stored.custom_data),
        ros_distro=stored.ros_distro or "",
    )


def _topic(stored: _Topic) -> BagTopic:
    qos = stored.offered_qos_profiles or ""
    return BagTopic(
        stored.name,
        stored.type,
        stored.serialization_format or "",
        stored.type_description_hash or "",
        profiles_or_none(qos) if isinstance(qos, str) else profiles_of_list(qos),
    )


def _word(text: str | None) -> str:
    word = (text or "").lower()
    return "" if word == "none" else word


def _custom(data: Mapping[str, str | None] | None) -> dict[str, str]:
    return {key: value or "" for key, value in (data or {}).items()}


def _reason(error: msgspec.ValidationError) -> str:
    """Return msgspec's reason with the place before it."""
    what, _, path = str(error).partition(" - at `")
    place = path.rstrip("`").removeprefix("$.").removeprefix("$")
    return f"{place}: {shown(what)}" if place else shown(what)


def _of_version(data: Mapping[str, Any]) -> str:
    """Return a remark for metadata of a version that is not known."""
    version = str(data["version"])
    known = version.isdigit() and len(version) < 9 and OLDEST <= int(version) <= NEWEST
    return "" if known else f" (it is version {shown(version, 40)}; {OLDEST} to {NEWEST} are known)"


def _listed(key: str, lines: list[str], empty: str = "[]") -> list[str]:
    return [f"{key}:", *lines] if lines else [f"{key}: {empty}"]


def _topic_lines(topic: BagTopic, count: int) -> list[str]:
    return [
        "  - topic_metadata:",
        f"      name: {_text(topic.name)}",
        f"      type: {_text(topic.type_name)}",
        f"      serialization_format: {_text(topic.serialization_format)}",
        f"      offered_qos_profiles: {_text(text_of(topic.offered_qos))}",
        f"      type_description_hash: {_text(topic.type_hash)}",
        f"    message_count: {count}",
    ]


def _file_lines(file: FileInformation) -> list[str]:
    return [
        f"  - path: {_text(file.path)}",
        "    starting_time:",
        f"      nanoseconds_since_epoch: {file.starting_time}",
        "    duration:",
        f"      nanoseconds: {file.duration}",
        f"    message_count: {file.message_count}",
    ]


@functools.lru_cache(maxsize=4096)  # the same texts each two seconds while a bag is recorded
def _text(text: str) -> str:
    if _is_plain(text):
        return text
    return quoted(text.encode("utf-8", "replace").decode())  # a word of the command line may be no Unicode


def _is_plain(text: str) -> bool:
    """True for a text that YAML reads as itself without quotes: names and types, but no number and no keyword."""
    first, rest = text[:1], text.replace("/", "").replace("_", "").replace(".", "").replace("-", "")
    is_word = first == "/" or (first.isalpha() and text.lower() not in _KEYWORDS)
    return text.isascii() and is_word and (rest.isalnum() or text == "/")


_KEYWORDS = {"null", "true", "false", "yes", "no", "on", "off", "y", "n"}
