"""Zenoh declarations (publishers, subscribers, queryables, liveliness tokens), with rmw_zenoh's options."""

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
from robolink.transport.gates import make_gate
from robolink.transport.history import latched_depth
from robolink.transport.reach import mode_of

MOST_BETWEEN = 1 << 16
"""Capacity of the queue of a latched topic, or of token changes; when it is full, Zenoh waits."""

FOR_EVER = 1e9
"""Timeout of a call in Zenoh, in seconds (31 years): the caller decides how long it waits."""


class Publishers(NamedTuple):
    """Zenoh's publisher, and the one that knows whether anybody listens: one object unless samples are kept."""

    used: Any
    matcher: Any
    declare_remote: Callable[[], Any]
    """Declares one that knows whether any other session listens."""


def declare_publishers(session: zenoh.Session, key: str, qos: QoSProfile) -> Publishers:
    """Declare the publisher of a resolved profile; for a peer with a full buffer it waits a little, then drops.

    Also when it is RELIABLE and KEEP_ALL, where rmw_zenoh has Zenoh block: that stops everything that this session
    sends to that peer, and its senders, for seconds, and then ends the link.
    """
    reliable = qos.reliability is ReliabilityPolicy.RELIABLE
    options: dict[str, Any] = {
        "congestion_control": zenoh.CongestionControl.DROP,
        "reliability": zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT,
    }
    plain = session.declare_publisher(key, **options)
    declare_remote = functools.partial(session.declare_publisher, key, allowed_destination=zenoh.Locality.REMOTE)
    if qos.durability is not DurabilityPolicy.TRANSIENT_LOCAL:
        return Publishers(plain, plain, declare_remote)
    ext = zenoh.ext
    keeping = ext.declare_advanced_publisher(
        session,
        key,
        cache=ext.CacheConfig(max_samples=latched_depth(qos)),
        publisher_detection=True,
        sample_miss_detection=ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=0.5) if reliable else None,
        **options,
    )
    return Publishers(keeping, plain, declare_remote)


def declare_subscriber(session: zenoh.Session, key: str, gate: Sink, qos: QoSProfile) -> Any:
    """Declare a subscriber to other sessions, and to this one too if there is a history, which is Zenoh's then."""
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
        history=ext.HistoryConfig(detect_late_publishers=True, max_samples=latched_depth(qos)),
        recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True) if reliable else None,
        subscriber_detection=True,
    )
    follow(subscriber.handler, gate, "robolink latched")
    return subscriber


def follow(channel: Any, sink: Sink, name: str) -> None:
    """Pass items of a channel to the sink, on a background thread, until the channel's declaration is gone.

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
    """Declare a queryable, which answers calls."""
    return session.declare_queryable(key, direct(gate), complete=True)


def call(
    session: zenoh.Session, key: str, payload: bytes, attachment: bytes, gate: Sink, end: Callable[[], object]
) -> zenoh.CancellationToken:
    """Send a query; `end` is called after the last reply, or at once when nobody serves."""
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
    """Declare a liveliness token."""
    return session.liveliness().declare_token(token)


def declare_watch(session: zenoh.Session, pattern: str, changed: Sink) -> tuple[Any, Sink]:
    """Subscribe to token changes, existing tokens first; `changed` is called on a background thread.

    Returns the gate that leads to it, too.
    """
    watch, feed = _declare_tokens(session, pattern, zenoh.handlers.FifoChannel(MOST_BETWEEN)), make_gate(changed)
    follow(watch.handler, feed, "robolink watch")
    return watch, feed


def declare_look(session: zenoh.Session, pattern: str) -> Any:
    """Subscribe to token changes, which wait in a channel for whoever looks."""
    return _declare_tokens(session, pattern, zenoh.handlers.FifoChannel(MOST_BETWEEN))


def _declare_tokens(session: zenoh.Session, pattern: str, handler: Any) -> Any:
    # Of Rust only: Zenoh reports what is there already on the thread that ends the task of an advanced publisher, too,
    # and zenoh-python keeps Python until that has ended.
    return session.liveliness().declare_subscriber(pattern, handler, history=True)


def ask(session: zenoh.Session, pattern: str, timeout: float) -> Any:
    """Query the tokens of all peers; `is_over` of the result when they have answered, or after `timeout` seconds."""
    # Of Rust only: Zenoh drops this handler while it has locked its session, where one of Python would wait for Python;
    # an advanced subscriber that is undeclared meanwhile keeps Python and waits for that lock (zenoh 1.10.2).
    return session.liveliness().get(pattern, zenoh.handlers.RingChannel(1), timeout=timeout)


def is_over(question: Any) -> bool:
    """Return True if nothing more comes from a channel, the result of `ask`."""
    try:
        with lifetime.inside:
            question.try_recv()
    except zenoh.ZError:
        return True
    return False


def taken(channel: Any) -> Any:
    """Return the next item of a channel, None if none is there, or its session is closed."""
    try:
        with lifetime.inside:
            return channel.try_recv()
    except zenoh.ZError:
        return None


def direct(callback: Callable[[Any], object], drop: Callable[[], object] | None = None) -> Any:
    """Return a handler for Zenoh's own thread, where anything but C costs five times as much as the message."""
    return zenoh.handlers.Callback(callback, drop, indirect=False)


def quietly(action: Callable[[], object]) -> None:
    """Run a clean-up action, ignoring Zenoh's errors: the entity may be closed already."""
    # RuntimeError: zenoh-python's "Already borrowed", when another thread is at work on the same object, which
    # then goes as soon as that thread lets go of it.
    try:  # no `suppress`, since every answer to a call comes here twice
        with lifetime.inside:
            action()
    except (zenoh.ZError, RuntimeError):
        pass


def open_session(config: zenoh.Config) -> zenoh.Session:
    """Open a session. A client waits for its router in it, for up to 10 s if that is silent: Ctrl-C ends that wait."""
    is_client = mode_of(config) == "client"
    opens = functools.partial(zenoh.open, config)
    made: zenoh.Session = lifetime.interruptible(opens, close_session) if is_client else opens()
    return made


def close_session(session: Any) -> None:
    """Close a session, ignoring errors, as `quietly` does; but the exit does begin it."""
    with contextlib.suppress(zenoh.ZError, RuntimeError):
        session.close()


def is_matching(publisher: Any) -> bool:
    """True if a subscription is known to this session."""
    try:
        return bool(publisher.matching_status.matching)  # the status itself is always true
    except zenoh.ZError:  # closed
        return False
