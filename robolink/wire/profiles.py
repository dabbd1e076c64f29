"""Encoding of QoS profiles in liveliness tokens."""

from __future__ import annotations

import functools
from enum import IntEnum
from typing import Any, TypeVar

from robolink.constants import S_TO_NS
from robolink.duration import Duration, Infinite
from robolink.exceptions import WireError
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_system_default,
    resolved,
)
from robolink.wire.text import LONGEST, parse_number, quoted

_PolicyT = TypeVar("_PolicyT", bound=IntEnum)


def format_qos(qos: QoSProfile) -> str:
    """Encode a profile for a token; values that equal rmw_zenoh's defaults are left empty.

    >>> format_qos(QoSProfile(depth=10))
    '::,10:,:,:,,'
    """
    values = tuple(_key(getattr(qos, name)) for name in QoSProfile.__slots__)
    text = _QOS_TEXTS.get(values)
    if text is None:
        text = _formatted_qos(qos)
        if len(_QOS_TEXTS) < MOST_PROFILES:
            _QOS_TEXTS[values] = text
    return text


def _key(value: Any) -> Any:
    """Return a hashable form of a policy's value, for a key of a dictionary: a Duration is not hashable."""
    return value.nanoseconds if isinstance(value, Duration) else value


def _formatted_qos(qos: QoSProfile) -> str:
    full, usual = resolved(qos), _DEFAULTS
    depth = "" if full.depth == usual.depth else str(full.depth)
    return (
        f"{_unless(full.reliability, usual.reliability)}:{_unless(full.durability, usual.durability)}"
        f":{_unless(full.history, usual.history)},{depth}"
        f":{_format_span(full.deadline)}:{_format_span(full.lifespan)}"
        f":{_unless(full.liveliness, usual.liveliness)},{_format_span(full.liveliness_lease_duration)}"
    )


def parse_qos(text: str) -> QoSProfile:
    """Parse the QoS field of an endpoint's token; raises WireError for anything else."""
    fields = [field.split(",") for field in text.split(":")] if len(text) <= LONGEST else []
    if [len(field) for field in fields] != [1, 1, 2, 2, 2, 3]:
        raise WireError(f"a QoS field looks like ::,10:,:,:,,, got {quoted(text)}")
    (reliability,), (durability,), (history, depth), deadline, lifespan, (liveliness, *lease) = fields
    return QoSProfile(
        history=_parsed_policy(history, HistoryPolicy, _DEFAULTS.history),
        depth=(parse_number(depth) if depth else 0) or _DEFAULTS.depth,
        reliability=_parsed_policy(reliability, ReliabilityPolicy, _DEFAULTS.reliability),
        durability=_parsed_policy(durability, DurabilityPolicy, _DEFAULTS.durability),
        lifespan=_parsed_span(lifespan),
        deadline=_parsed_span(deadline),
        liveliness=_parsed_policy(liveliness, LivelinessPolicy, _DEFAULTS.liveliness),
        liveliness_lease_duration=_parsed_span(lease),
    )


_DEFAULTS = resolved(qos_profile_system_default)

# A system has thousands of tokens and a handful of profiles, and reading those takes two thirds of the time.
MOST_PROFILES = 256
shared_qos = functools.lru_cache(maxsize=MOST_PROFILES)(parse_qos)
"""`parse_qos` with an LRU cache: the same text gives the same, shared profile."""

_QOS_TEXTS: dict[tuple[Any, ...], str] = {}
"""Cache of encoded profiles, by their values: encoding one takes longer than the rest of a token."""


def _unless(value: int, usual: int) -> str:
    return "" if value == usual else str(int(value))


def _format_span(span: Duration) -> str:
    if span == Infinite:
        return ","
    seconds, nanoseconds = divmod(span.nanoseconds, S_TO_NS)
    return f"{seconds},{nanoseconds}"


def _parsed_span(fields: list[str]) -> Duration:
    seconds, nanoseconds = divmod(Infinite.nanoseconds, S_TO_NS)
    if fields[0]:
        seconds = parse_number(fields[0])
    if fields[1]:
        nanoseconds = parse_number(fields[1])
    return Duration(nanoseconds=min(seconds * S_TO_NS + nanoseconds, Infinite.nanoseconds))


def _parsed_policy(text: str, kind: type[_PolicyT], usual: _PolicyT) -> _PolicyT:
    try:
        return kind(parse_number(text)) if text else usual
    except ValueError:
        raise WireError(f"{text} is no {kind.__name__}") from None
