"""Offered QoS profiles as bags have them: a YAML text of numbers (versions 4 to 8), or a list of words (version 9)."""

from __future__ import annotations

import functools
from collections.abc import Iterable
from typing import Any, TypeVar

from robolink.documents.yamltext import compose, texts
from robolink.duration import Duration, Infinite
from robolink.exceptions import DocumentError
from robolink.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSPolicyEnum, QoSProfile, ReliabilityPolicy

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
