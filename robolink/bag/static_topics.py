"""File of static topics, which a recorder listens to from its start, whoever will publish them.

As in rosbag2: a mapping with `static_topics_and_types_list`, a list of pairs of a topic and its type.
"""

from __future__ import annotations

import os
from typing import Any

import msgspec

from robolink.documents.foreign import warn_of_unknown_keys
from robolink.documents.yamlfile import Document, read
from robolink.exceptions import RobolinkError
from robolink.interfaces import find
from robolink.validate_full_topic_name import validate_full_topic_name

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
