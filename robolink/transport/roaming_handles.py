"""Handles of a roaming transport: what is declared in its present session, and declared again in the next one."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

from robolink.exceptions import TransportClosedError, TransportError
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.system.waits import fork_lock
from robolink.transport import lifetime
from robolink.transport.base import Handle, Sink
from robolink.transport.gates import aim_gate, close_gate, make_gate
from robolink.transport.history import Latch, latched_depth
from robolink.transport.zenoh import ZenohTransport
from robolink.transport.zenoh_handles import Changes, ZenohOutlet
from robolink.transport.zenoh_mending import Mending, Sieve

Retained = Latch[tuple[bytes, bytes]]
"""Payloads and attachments that a publisher has sent."""


class Holdings:
    """Declarations of a roaming transport, until it is closed. They do not refer to it, so that it can be freed."""

    def __init__(self) -> None:
        self.lock = fork_lock()
        self.why_closed = ""
        self._declared: dict[Declaration, None] = {}

    def add(self, declaration: Declaration) -> bool:
        """Add a declaration; False after the end."""
        with self.lock:
            if not self.why_closed:
                self._declared[declaration] = None
            return not self.why_closed

    def remove(self, declaration: Declaration) -> None:
        """Remove a declaration, if it is there."""
        with self.lock:
            self._declared.pop(declaration, None)

    def __contains__(self, declaration: Declaration) -> bool:
        return declaration in self._declared

    def all(self) -> list[Declaration]:
        """Return all declarations, in their order."""
        with self.lock:
            return list(self._declared)

    def end(self, why: str) -> list[Declaration]:
        """Refuse further use; return all that is still declared."""
        with self.lock:
            self.why_closed = self.why_closed or why
            declared, self._declared = list(self._declared), {}
        return declared

    def check(self) -> None:
        """Raise TransportClosedError after the end."""
        if self.why_closed:
            lifetime.end_if_daemon()
            raise TransportClosedError(self.why_closed)


class Declaration:
    """A declaration, until it or its transport is closed.

    Args:
        holdings: Declarations of the transport.
        declare: Function that declares it in a session.
        gate: Gate through which each session calls; None where they call nothing.
    """

    def __init__(
        self, holdings: Holdings, declare: Callable[[ZenohTransport], Handle], gate: Sink | None = None
    ) -> None:
        self._holdings, self._declare, self._gate = holdings, declare, gate
        self._plain: ZenohTransport | None = None
        self._handle: Any = None

    def declare_in(self, plain: ZenohTransport) -> Handle:
        """Declare it in a session, where nothing uses it yet."""
        return self._declare(plain)

    def begin(self, plain: ZenohTransport, handle: Handle) -> None:
        """Use what `declare_in` has made in the first session."""
        self._plain, self._handle = plain, handle
        if not self._holdings.add(self):
            self.close()
            self._holdings.check()

    def adopt(self, plain: ZenohTransport, handle: Handle) -> None:
        """Go on with what `declare_in` has made in this session, unless it is closed; its former one is left soon."""
        with self._holdings.lock:
            if self in self._holdings and self._plain is not plain:
                self._plain = plain
                self._replace(handle)
                return
        handle.close()

    def move_to(self, plain: ZenohTransport) -> None:
        """Go on in this session, unless it is there already."""
        if self._plain is not plain:
            self.adopt(plain, self.declare_in(plain))

    def settle_in(self) -> None:
        """Begin what has to wait until everything has moved to another session."""

    def _replace(self, handle: Any) -> None:
        self._handle = handle

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        self._holdings.remove(self)
        self.end()
        self._handle.close()

    def end(self) -> None:
        """Call nothing any more, whichever session it comes from."""
        if self._gate is not None:
            close_gate(self._gate)


class RoamingOutlet(Declaration):
    """A publisher.

    Args:
        holdings: Declarations of the transport.
        key: Key on which it publishes.
        qos: Its profile.
        cache: What it retains for those who have lost some; None for nothing.
    """

    _handle: ZenohOutlet

    def __init__(self, holdings: Holdings, key: str, qos: QoSProfile, cache: Retained | None) -> None:
        super().__init__(holdings, lambda plain: plain.advertise(key, qos))
        self.key, self.cache = key, cache
        latched = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self._latch = Retained(latched_depth(qos)) if latched else None

    def put(self, payload: bytes, attachment: bytes) -> None:
        """Send to every matching subscription. Raises TransportClosedError after close, TransportError for giants."""
        if self.cache is not None:
            self.cache.retain((payload, attachment), len(payload))
        if self._latch is None:
            handle = self._handle
            try:  # `_put` written out: this is run once a message
                handle.put(payload, attachment)
            except TransportClosedError:
                if handle is self._handle:
                    raise
                self._put(payload, attachment)
            return
        with self._latch.lock:  # as it is retained so it is sent, and nothing falls between two sessions
            self._latch.retain((payload, attachment))
            self._put(payload, attachment)

    def _put(self, payload: bytes, attachment: bytes) -> None:
        handle = self._handle
        try:
            handle.put(payload, attachment)
        except TransportClosedError:
            if handle is self._handle:
                raise
            self._put(payload, attachment)  # it was replaced meanwhile, and its session left

    def _replace(self, handle: ZenohOutlet) -> None:
        if self._latch is None:
            super()._replace(handle)
            return
        with self._latch.lock:
            for payload, attachment in self._latch.last():
                with contextlib.suppress(TransportError):
                    handle.repeat(payload, attachment)
            super()._replace(handle)

    @property
    def matched(self) -> bool:
        """True if a subscription is known, here or elsewhere."""
        return self._handle.matched


class RoamingSubscription(Declaration):
    """A subscription, which delivers once what two sessions bring.

    Args:
        holdings: Declarations of the transport.
        key: Key to which it subscribes.
        qos: Its profile.
        sink: Function that is called with each sample.
        mending: Sink in front of that one, which puts in order what comes again; None where nothing does.
    """

    def __init__(self, holdings: Holdings, key: str, qos: QoSProfile, sink: Sink, mending: Mending | None) -> None:
        self._mending = mending
        self._sink: Sink = mending or sink
        if qos.durability is DurabilityPolicy.TRANSIENT_LOCAL:  # who has moved, anywhere, sends again what it retains
            self._sink = Sieve(sink)
        gate = make_gate(self._sink)
        super().__init__(holdings, lambda plain: plain.subscribe(key, qos, gate), gate)

    def sift(self, on: bool) -> None:
        """Deliver nothing twice from now on, or again whatever comes: two sessions may bring the same for a while."""
        with self._holdings.lock:
            if self in self._holdings and type(self._sink) is not Sieve:  # one that is latched always does
                aim_gate(self._gate, Sieve(self._sink) if on else self._sink)

    def end(self) -> None:
        """Deliver nothing any more."""
        if self._mending is not None:  # an answer may be on its way
            self._mending.close()
        super().end()


class RoamingWatch(Declaration):
    """A watch of tokens, which does not report those that only change their session."""

    _handle: _SessionWatch

    def __init__(self, holdings: Holdings, pattern: str, on_change: Callable[[str, bool], object]) -> None:
        self._changes = changes = Changes(on_change)
        super().__init__(holdings, lambda plain: _SessionWatch(plain, pattern, changes))

    def declare_in(self, plain: ZenohTransport) -> Handle:
        """Watch in a session; if it is another one, that reports from now on."""
        if self._plain is not None:
            self._changes.count_again()
        return super().declare_in(plain)

    def _replace(self, handle: Any) -> None:
        self._handle.mute()  # it would report the end of links that the other session has anew
        super()._replace(handle)

    def settle(self) -> None:
        """Report tokens as gone that the new session has not found."""
        self._changes.settle()

    def end(self) -> None:
        """Report nothing any more."""
        self._changes.end()


class _SessionWatch:
    """Watch of one session."""

    def __init__(self, plain: ZenohTransport, pattern: str, changes: Changes) -> None:
        self._changes: Changes | None = changes
        self.close = plain.watch(pattern, self._on_change).close

    def _on_change(self, token: str, alive: bool) -> object:
        return None if self._changes is None else self._changes.change(token, alive)

    def mute(self) -> None:
        """Report nothing any more; not undeclared, which waits where a link stands still."""
        self._changes = None
