"""What is declared with Zenoh, and with which options: rmw_zenoh's where it has any."""

from __future__ import annotations

import contextlib
import functools
import sys
import threading
from collections.abc import Callable
from typing import Any, NamedTuple

import zenoh

from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.transport import lifetime
from robolink.transport.base import Sink

MOST_BETWEEN = 1 << 16
"""Samples of a latched topic, or news of tokens, that wait for their thread; when there are more, Zenoh waits."""

FOR_EVER = 1e9
"""Seconds, 31 years: time is up to whoever waits for an answer."""


class Publishers(NamedTuple):
    """What publishes, and what knows whether anybody listens: one object unless samples are kept."""

    used: Any
    asked: Any


def declare_publishers(session: zenoh.Session, key: str, qos: QoSProfile) -> Publishers:
    """Declare what a resolved profile asks for; for a peer without room it waits a little, then drops.

    Also when it is RELIABLE and KEEP_ALL, where rmw_zenoh has Zenoh block: that stops all that this session sends to
    that peer, and whoever sends it, for seconds, and then ends the link.
    """
    reliable = qos.reliability is ReliabilityPolicy.RELIABLE
    options: dict[str, Any] = {
        "congestion_control": zenoh.CongestionControl.DROP,
        "reliability": zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT,
    }
    plain = session.declare_publisher(key, **options)
    if qos.durability is not DurabilityPolicy.TRANSIENT_LOCAL:
        return Publishers(plain, plain)
    ext = zenoh.ext
    keeping = ext.declare_advanced_publisher(
        session,
        key,
        cache=ext.CacheConfig(max_samples=qos.depth),
        publisher_detection=True,
        sample_miss_detection=ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=0.5) if reliable else None,
        **options,
    )
    return Publishers(keeping, plain)


def declare_subscriber(session: zenoh.Session, key: str, gate: Sink, qos: QoSProfile) -> Any:
    """Declare what hears other sessions, and the own one too where there is a history: that is all Zenoh's then."""
    if qos.durability is not DurabilityPolicy.TRANSIENT_LOCAL:
        return session.declare_subscriber(key, direct(gate), allowed_origin=zenoh.Locality.REMOTE)
    ext = zenoh.ext
    reliable = qos.reliability is ReliabilityPolicy.RELIABLE
    # Not called directly: an advanced subscriber is locked while it calls, and would wait for Python; an advanced
    # publisher of the same process that is undeclared meanwhile keeps Python and waits for that lock.
    subscriber = ext.declare_advanced_subscriber(
        session,
        key,
        zenoh.handlers.FifoChannel(MOST_BETWEEN),
        history=ext.HistoryConfig(detect_late_publishers=True, max_samples=qos.depth),
        recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True) if reliable else None,
        subscriber_detection=True,
    )
    _follow(subscriber.handler, gate, "robolink latched")
    return subscriber


def _follow(channel: Any, sink: Sink, name: str) -> None:
    """Give what arrives to the sink, on a thread of its own, until what the channel is of is gone.

    Zenoh would start such a thread too, but nobody could wait for that one, and it aborts a process whose interpreter
    ends before it has.
    """
    thread = threading.Thread(target=_hand_on, args=(channel, sink), name=name, daemon=True)
    lifetime.outlive(thread)
    try:
        thread.start()
    except RuntimeError:  # Python 3.12 starts no threads any more at exit
        lifetime.end_if_daemon()
        raise


def _hand_on(channel: Any, sink: Sink) -> None:
    with contextlib.suppress(zenoh.ZError):
        for sample in channel:
            try:
                sink(sample)
            except Exception:  # noqa: BLE001 - one that is lost must not lose those behind it
                sys.excepthook(*sys.exc_info())


def declare_server(session: zenoh.Session, key: str, gate: Sink) -> Any:
    """Declare what answers calls."""
    return session.declare_queryable(key, direct(gate), complete=True)


def call(
    session: zenoh.Session, key: str, payload: bytes, attachment: bytes, gate: Sink, end: Callable[[], object]
) -> zenoh.CancellationToken:
    """Ask; `end` is called after the last reply, or at once when nobody serves."""
    cancel: zenoh.CancellationToken = zenoh.CancellationToken()
    session.get(
        key,
        direct(gate, end),
        payload=payload,
        attachment=attachment,
        target=zenoh.QueryTarget.ALL_COMPLETE,
        consolidation=zenoh.ConsolidationMode.NONE,
        timeout=FOR_EVER,
        cancellation_token=cancel,
    )
    return cancel


def declare_token(session: zenoh.Session, token: str) -> Any:
    """Show a token."""
    return session.liveliness().declare_token(token)


def declare_watch(session: zenoh.Session, pattern: str, changed: Sink) -> Any:
    """See tokens come and go, those already there first; `changed` is called on a thread of its own."""
    watch = _declare_tokens(session, pattern, zenoh.handlers.FifoChannel(MOST_BETWEEN))
    _follow(watch.handler, changed, "robolink watch")
    return watch


def declare_look(session: zenoh.Session, pattern: str, arrived: Sink) -> Any:
    """See tokens as `declare_watch` does; `arrived`, which should be C, is called on Zenoh's thread."""
    return _declare_tokens(session, pattern, direct(arrived))


def _declare_tokens(session: zenoh.Session, pattern: str, handler: Any) -> Any:
    return session.liveliness().declare_subscriber(pattern, handler, history=True)


def ask(session: zenoh.Session, pattern: str, answered: Callable[[], object], timeout: float) -> None:
    """Have all peers tell their tokens; `answered()` when they have, or after `timeout` seconds."""
    session.liveliness().get(pattern, direct(bool, answered), timeout=timeout)


def direct(callback: Callable[[Any], object], drop: Callable[[], object] | None = None) -> Any:
    """Let Zenoh's own thread call; anything but C costs five times the price of the message there."""
    return zenoh.handlers.Callback(callback, drop, indirect=False)


def make_gate(sink: Any, *arguments: object) -> functools.partial[object]:
    """Wrap `sink` in something in C that can be closed without a moment in between."""
    # Not partial(sink): a partial of a partial is merged, and this one must not copy what the other one holds.
    return functools.partial(sink.__call__, *arguments)


def close_gate(gate: Any) -> None:
    """Let nothing through any more: Zenoh does not wait for its callbacks when something is undeclared."""
    gate.__setstate__((bool, (), {}, None))  # bool takes anything or nothing, and does nothing


def quietly(action: Callable[[], object]) -> None:
    """Undeclare or close what may be closed already."""
    # RuntimeError: zenoh-python's "Already borrowed", when another thread is at work on the same object, which
    # then goes as soon as that thread lets go of it.
    with contextlib.suppress(zenoh.ZError, RuntimeError), lifetime.inside:
        action()


def is_matching(publisher: Any) -> bool:
    """Tell whether anybody subscribes, as far as this session knows."""
    try:
        return bool(publisher.matching_status.matching)  # the status itself is always true
    except zenoh.ZError:  # closed
        return False
