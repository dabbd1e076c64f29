"""Topics of bags: as they are recorded, with their messages; texts of their types; and files that name topics.

A file of static topics is as in rosbag2: a mapping with `static_topics_and_types_list`, a list of pairs of a topic and
its type, to which a recorder listens from its start, whoever will publish them.
"""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import msgspec

from robolink.bag.selection import SERVICE_EVENT
from robolink.documents.foreign import warn_of_unknown_keys
from robolink.documents.yamlfile import Document, read
from robolink.exceptions import RobolinkError
from robolink.interfaces import find
from robolink.message import Message
from robolink.message.text import text_of
from robolink.qos import QoSProfile
from robolink.validate_full_topic_name import validate_full_topic_name

SEPARATOR = "=" * 80
"""Line before each type after the first."""


def message_definition(cls: type[Message]) -> str:
    """Return the text of a message class, and behind it that of each type in it, as the schema encoding ros2msg has it.

    A part of a service or action (``SetBool.Request``, ``SetBool.Event``) is a message class too; a service itself is
    none. The types come in the order in which they are first used, each once, behind a line ``MSG: pkg/Name``.
    """
    types: dict[str, type[Message]] = {cls.__ros_type__: cls}
    waiting = [cls]
    for each in waiting:
        for kind in each.__ros_fields__.values():
            if kind.message is not None and kind.message.__ros_type__ not in types:
                types[kind.message.__ros_type__] = kind.message
                waiting.append(kind.message)
    first, *others = (_ended(text_of(each)) for each in types.values())
    names = [name.replace("/msg/", "/") for name in types][1:]
    return first + "".join(f"{SEPARATOR}\nMSG: {name}\n{text}" for name, text in zip(names, others, strict=True))


def _ended(text: str) -> str:
    return text if not text or text.endswith("\n") else text + "\n"


class BagError(RobolinkError, ValueError, RuntimeError):
    """A bag cannot be read or written; the text is one line that names the file. rosbag2_py has RuntimeErrors."""


class BagTopic(NamedTuple):
    """Topic of a bag.

    Args:
        name: Full name, such as `/scan`.
        type_name: Type, such as `std_msgs/msg/String`.
        serialization_format: Encoding of the messages.
        type_hash: Hash of the type (RIHS01_...), '' if unknown.
        offered_qos: Profiles that publishers offered while it was recorded.
        message_definition: Text of the type's definition with all that it uses, '' if unknown.
        definition_encoding: Language of that text: ros2msg or ros2idl.
    """

    name: str
    type_name: str
    serialization_format: str = "cdr"
    type_hash: str = ""
    offered_qos: tuple[QoSProfile, ...] = ()
    message_definition: str = ""
    definition_encoding: str = "ros2msg"

    @property
    def is_service_event(self) -> bool:
        """True for a topic of a service's events, which `bag info` counts apart."""
        return self.name.endswith(SERVICE_EVENT) and self.type_name.endswith("_Event")

    def difference(self, before: BagTopic) -> str:
        """Return how the type differs from that of a topic of the same name in a bag before, in words; '' if not."""
        if self.type_name != before.type_name:
            return f"topic '{self.name}' is a {self.type_name} there, and a {before.type_name} before"
        if self.type_hash and before.type_hash and self.type_hash != before.type_hash:
            return f"topic '{self.name}' is another {self.type_name} there than before"
        return ""


class BagMessage(NamedTuple):
    """Message of a bag: serialized, with the times at which it was received and sent, in nanoseconds since 1970.

    `sequence` is the sender's number of it, 0 where that is not known.
    """

    topic: str
    data: bytes | memoryview
    log_time: int
    publish_time: int
    sequence: int = 0


KEY = "static_topics_and_types_list"


class _StaticTopics(msgspec.Struct, frozen=True):
    static_topics_and_types_list: list[tuple[str, str]]


def read_static_topics(path: str | os.PathLike[str], *, text: str | None = None) -> dict[str, type[Any]]:
    """Read a file of static topics, and return the message class of each.

    Args:
        path: The file.
        text: Content to read in place of the file's.

    Raises:
        DocumentError: with `file:line:column`, for a topic that has no full name, and for a type that is not installed.
        DocumentNotFoundError: if the file does not exist.
    """
    document = read(path, _StaticTopics, text=text)
    warn_of_unknown_keys(document, document.data, [KEY])
    pairs = document.value.static_topics_and_types_list
    return {topic: _class_of(document, number, topic, kind) for number, (topic, kind) in enumerate(pairs)}


def _class_of(document: Document[_StaticTopics], number: int, topic: str, kind: str) -> type[Any]:
    try:
        validate_full_topic_name(topic)
    except RobolinkError:
        raise document.error([KEY, number, 0], "expected a topic's full name, such as /scan") from None
    try:
        return find(kind)
    except RobolinkError as error:
        raise document.error([KEY, number, 1], str(error)) from None
