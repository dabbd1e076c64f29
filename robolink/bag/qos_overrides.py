"""File of QoS profiles by topic, which override those of a recorder's subscriptions or of a player's publishers.

As in rosbag2: a mapping of topics to profiles, with the policies in words and spans of time as {sec, nsec}.
"""

from __future__ import annotations

import os
from typing import Annotated, Literal

import msgspec

from robolink.documents.yamlfile import Document, read
from robolink.duration import Duration
from robolink.exceptions import RobolinkError
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    InvalidQoSProfileException,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from robolink.validate_full_topic_name import validate_full_topic_name

Count = Annotated[int, msgspec.Meta(ge=0, le=2**31 - 1)]


class _Span(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    sec: Count
    nsec: Annotated[int, msgspec.Meta(ge=0, lt=10**9)]


class _Profile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    history: Literal["system_default", "keep_last", "keep_all"] | None = None
    depth: Count | None = None
    reliability: Literal["system_default", "reliable", "best_effort", "best_available"] | None = None
    durability: Literal["system_default", "transient_local", "volatile", "best_available"] | None = None
    lifespan: _Span | None = None
    deadline: _Span | None = None
    liveliness: Literal["system_default", "automatic", "manual_by_topic", "best_available"] | None = None
    liveliness_lease_duration: _Span | None = None
    avoid_ros_namespace_conventions: bool | None = None

    def profile(self) -> QoSProfile:
        return QoSProfile(
            history=None if self.history is None else HistoryPolicy[self.history.upper()],
            depth=self.depth,
            reliability=None if self.reliability is None else ReliabilityPolicy[self.reliability.upper()],
            durability=None if self.durability is None else DurabilityPolicy[self.durability.upper()],
            lifespan=_duration(self.lifespan),
            deadline=_duration(self.deadline),
            liveliness=None if self.liveliness is None else LivelinessPolicy[self.liveliness.upper()],
            liveliness_lease_duration=_duration(self.liveliness_lease_duration),
            avoid_ros_namespace_conventions=self.avoid_ros_namespace_conventions,
        )


def _duration(span: _Span | None) -> Duration | None:
    return None if span is None else Duration(seconds=span.sec, nanoseconds=span.nsec)


def read_qos_overrides(path: str | os.PathLike[str], *, text: str | None = None) -> dict[str, QoSProfile]:
    """Read a file of profiles by topic.

    Args:
        path: The file.
        text: Content to read in place of the file's.

    Raises:
        DocumentError: with `file:line:column`, for a topic that has no full name, and for a policy or value that does
            not exist.
        DocumentNotFoundError: if the file does not exist.
    """
    document = read(path, dict[str, _Profile], text=text)
    return {topic: _checked(document, topic, profile) for topic, profile in document.value.items()}


def _checked(document: Document[dict[str, _Profile]], topic: str, profile: _Profile) -> QoSProfile:
    try:
        validate_full_topic_name(topic)
    except RobolinkError:
        raise document.error([topic], "expected a topic's full name, such as /scan", key=True) from None
    try:
        return profile.profile()
    except InvalidQoSProfileException as error:
        raise document.error([topic], str(error)) from None
