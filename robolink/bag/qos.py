"""QoS profiles in bags: as rosbag2 writes them, and the overrides of a YAML file.

Bags have a YAML text of numbers (versions 4 to 8) or a list of words (version 9). The overrides are as in rosbag2: a
mapping of topics to profiles, with the policies in words and spans of time as {sec, nsec}.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Iterable
from typing import Annotated, Any, Literal, TypeVar

import msgspec

from robolink.documents.yamlfile import Document, read
from robolink.documents.yamltext import compose, texts
from robolink.duration import Duration, Infinite
from robolink.exceptions import DocumentError, RobolinkError
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    InvalidQoSProfileException,
    LivelinessPolicy,
    QoSPolicyEnum,
    QoSProfile,
    ReliabilityPolicy,
)
from robolink.validate_full_topic_name import validate_full_topic_name

Policy = TypeVar("Policy", bound=QoSPolicyEnum)

_LARGEST_DEPTH = 2**31 - 1
_FOXY = {(0x7FFFFFFF, 0xFFFFFFFF), (0x7FFFFFFF, 0x7FFFFFFF)}
"""Seconds and nanoseconds by which Fast DDS and Connext of ROS 2 Foxy say "infinite"."""


@functools.lru_cache(maxsize=256)
def profiles_of_text(text: str) -> tuple[QoSProfile, ...]:
    """Return the profiles of a YAML text, in numbers or in words; raises `DocumentError` for no YAML.

    What a profile lacks or cannot be read becomes UNKNOWN, as in rosbag2: a recording is worth more than its QoS.
    """
    return profiles_of_list(texts(compose(text, "offered_qos_profiles"), "offered_qos_profiles"))


def profiles_or_none(text: str) -> tuple[QoSProfile, ...]:
    """Return the profiles of a YAML text, or none where it cannot be parsed."""
    try:
        return profiles_of_text(text)
    except DocumentError:
        return ()


def profiles_of_list(data: Any) -> tuple[QoSProfile, ...]:
    """Return the profiles of a list of mappings, whose values are texts; what is not a mapping is left out."""
    return tuple(_profile(each) for each in data if isinstance(each, dict)) if isinstance(data, list) else ()


def text_of(profiles: Iterable[QoSProfile]) -> str:
    """Format profiles as version 8 has them: YAML with the policies as rmw's numbers, which every rosbag2 reads."""
    return "\n".join(map(_text, profiles))


def _profile(data: dict[str, Any]) -> QoSProfile:
    depth = min(_number(data.get("depth"), 0), _LARGEST_DEPTH)
    profile = QoSProfile(
        history=HistoryPolicy.SYSTEM_DEFAULT,
        depth=depth,
        reliability=_policy(ReliabilityPolicy, data.get("reliability")),
        durability=_policy(DurabilityPolicy, data.get("durability")),
        deadline=_span(data.get("deadline")),
        lifespan=_span(data.get("lifespan")),
        liveliness=_policy(LivelinessPolicy, data.get("liveliness")),
        liveliness_lease_duration=_span(data.get("liveliness_lease_duration")),
        avoid_ros_namespace_conventions=str(data.get("avoid_ros_namespace_conventions")).lower() == "true",
    )
    profile.history = _policy(HistoryPolicy, data.get("history"))  # last: KEEP_LAST with depth 0 is worth no warning
    return profile


def _policy(kind: type[Policy], value: Any) -> Policy:
    name = str(value).strip().upper()
    if name in kind.__members__:
        return kind[name]
    number = _number(value, -1)
    return kind(number) if number in {int(each) for each in kind} else kind["UNKNOWN"]


def _span(data: Any) -> Duration:
    if not isinstance(data, dict):
        return Duration()
    seconds, nanoseconds = _number(data.get("sec"), 0), _number(data.get("nsec"), 0)
    total = seconds * 10**9 + nanoseconds
    if (seconds, nanoseconds) in _FOXY or total >= Infinite.nanoseconds:
        return Infinite
    return Duration(nanoseconds=total)


def _number(value: Any, default: int) -> int:
    """Return a number of at least 0; `default` for everything else."""
    text = str(value)
    return int(text) if text.isascii() and text.isdigit() and len(text) <= 20 else default


def _text(profile: QoSProfile) -> str:
    lines = [
        f"- history: {int(profile.history)}",
        f"depth: {profile.depth}",
        f"reliability: {int(profile.reliability)}",
        f"durability: {int(profile.durability)}",
        *_span_lines("deadline", profile.deadline),
        *_span_lines("lifespan", profile.lifespan),
        f"liveliness: {int(profile.liveliness)}",
        *_span_lines("liveliness_lease_duration", profile.liveliness_lease_duration),
        f"avoid_ros_namespace_conventions: {str(profile.avoid_ros_namespace_conventions).lower()}",
    ]
    return "\n  ".join(lines)


def _span_lines(name: str, span: Duration) -> list[str]:
    seconds, nanoseconds = divmod(span.nanoseconds, 10**9)
    return [f"{name}:", f"  sec: {seconds}", f"  nsec: {nanoseconds}"]


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
