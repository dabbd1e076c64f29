"""Quality of service on DDS: profiles of ROS 2 as RTPS announces them, and which two match."""

from __future__ import annotations

import math

from robolink.constants import S_TO_NS
from robolink.duration import Duration, Infinite
from robolink.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy, resolved
from robolink.rtps import Qos

_AUTOMATIC, _MANUAL_BY_TOPIC = 0, 2
_KEEP_ALL = 0


def announced(profile: QoSProfile) -> Qos:
    """Return the QoS that an endpoint of this profile announces on DDS, with nothing left to the system."""
    full = resolved(profile)
    return Qos(
        reliable=full.reliability is ReliabilityPolicy.RELIABLE,
        transient_local=full.durability is DurabilityPolicy.TRANSIENT_LOCAL,
        depth=_KEEP_ALL if full.history is HistoryPolicy.KEEP_ALL else full.depth,
        deadline=_seconds(full.deadline),
        lifespan=_seconds(full.lifespan),
        liveliness=_AUTOMATIC if full.liveliness is LivelinessPolicy.AUTOMATIC else _MANUAL_BY_TOPIC,
        lease=_seconds(full.liveliness_lease_duration),
    )


def profile_of(qos: Qos) -> QoSProfile:
    """Return the profile that an endpoint of DDS announces; history and depth are the system's where it tells none."""
    is_known = qos.depth >= 0
    history = HistoryPolicy.KEEP_LAST if is_known else HistoryPolicy.SYSTEM_DEFAULT
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL if qos.depth == _KEEP_ALL else history,
        depth=qos.depth if is_known else 0,
        reliability=ReliabilityPolicy.RELIABLE if qos.reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if qos.transient_local else DurabilityPolicy.VOLATILE,
        lifespan=_span(qos.lifespan),
        deadline=_span(qos.deadline),
        liveliness=LivelinessPolicy.AUTOMATIC if qos.liveliness == _AUTOMATIC else LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=_span(qos.lease),
    )


def _seconds(span: Duration) -> float | None:
    return None if span == Infinite else span.nanoseconds / S_TO_NS


def _span(seconds: float | None) -> Duration:
    if seconds is None or not 0 <= seconds < Infinite.nanoseconds / S_TO_NS:
        return Infinite
    return Duration(nanoseconds=round(seconds * S_TO_NS))


def shortcomings(requested: Qos, offered: Qos) -> list[str]:
    """Return the policies by which a reader does not match a writer that offers less; none if they match.

    DDS 1.4, 2.2.3: the values that are "requested versus offered" (RxO).
    """
    found = {
        "reliability": offered.reliable >= requested.reliable,
        "durability": offered.transient_local >= requested.transient_local,
        "deadline": _or_infinite(offered.deadline) <= _or_infinite(requested.deadline),
        "liveliness": offered.liveliness >= requested.liveliness,
        "liveliness lease": _or_infinite(offered.lease) <= _or_infinite(requested.lease),
    }
    return [policy for policy, is_met in found.items() if not is_met]


def _or_infinite(seconds: float | None) -> float:
    return math.inf if seconds is None else seconds
