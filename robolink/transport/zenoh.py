"""Zenoh transport: a network between processes and machines, with Eclipse Zenoh as rmw_zenoh uses it.

No Python frame runs on Zenoh's threads for data: they call a `functools.partial` around the sink, and the
sink is meant to be C as well. Raw samples wait in queues until `read` converts them to bytes.
"""

from __future__ import annotations

import functools
import os
import time
import weakref
from collections.abc import Callable, Mapping
from typing import Any

import zenoh

from robolink.exceptions import OverwrittenError
from robolink.networks.settings import SOUGHT_EVERY
from robolink.qos import DurabilityPolicy, QoSProfile, resolved
from robolink.system import clocks, heap
from robolink.transport import lifetime, zenoh_handles, zenoh_readers
from robolink.transport import zenoh_declare as declare
from robolink.transport import zenoh_handles as handles
from robolink.transport.base import Handle, Query, Sample, Sink, Transport, make_sample, refuse_giant
from robolink.transport.gates import close_gate, make_gate
from robolink.transport.joining import join, leave
from robolink.transport.reach import Link, links_of
from robolink.transport.shared_memory import PoolLimit
from robolink.transport.shared_pool import Sharing
from robolink.transport.zenoh_groups import Groups
from robolink.transport.zenoh_handles import Changes, ZenohToken, ZenohWatch, settled

REUNION = SOUGHT_EVERY + 0.05
"""Time in which the peers of an earlier holder of the rendezvous port find the new one, in seconds."""

SMALL = 4096
"""Payload size in bytes below which a message is read with nothing but Zenoh's calls."""

_ZenohSample = zenoh.Sample


class ZenohTransport(Transport):
    """One session on a Zenoh network: this machine's, or what `network` or the environment requests.

    It ends with its session: what leaves the machine goes on in others by `robolink.transport.roaming`.

    Args:
        domain: ROS domain id.
        network: Network, as in `robolink.networks.request.requested`; None is the one that the environment requests.
        environ: Environment; None is the process's own.
        secure: Function that closes each configuration to whoever has no keys, in place of what the environment says.
        named: Addresses of this machine at which others find the session; none for those that Zenoh knows.

    Raises:
        TransportError: when there is no joining the network.
    """

    threaded = True

    def __init__(
        self,
        domain: int = 0,
        network: str | None = None,
        environ: Mapping[str, str] | None = None,
        secure: Callable[[zenoh.Config], object] | None = None,
        named: frozenset[str] = frozenset(),
    ) -> None:
        self.url = "zenoh://"
        lifetime.refuse_if_forked()
        self._holdings = handles.Holdings()
        self._ends: weakref.WeakSet[Sink] = weakref.WeakSet()
        self._calls: weakref.WeakSet[zenoh_handles.ZenohCall] = weakref.WeakSet()
        self._has_left = False
        with lifetime.inside:
            before = clocks.time_of_day()
            with zenoh_readers.enough():
                joined = join(domain, network, dict(os.environ if environ is None else environ), secure, named)
            self.session, self._claim = joined.session, joined.claim
            self.leaves_machine, self.thinned = joined.leaves_machine, joined.thinned
            self._may_group, self._groups = joined.has_own_settings, Groups()
            self._met_at = clocks.monotonic() + (REUNION if joined.holds_port else 0.0)
            self._pools = PoolLimit(before)
            self._holdings.sharing = Sharing(self._pools.shares)
            self.session_id = str(self.session.info.zid())
            lifetime.watch_over(self)

    def advertise(self, key: str, qos: QoSProfile) -> handles.ZenohOutlet:
        """Declare a publisher. With TRANSIENT_LOCAL it retains the last `qos.depth` samples for late joiners."""
        made = self._make(key, declare.declare_publishers, key, resolved(qos))
        return handles.ZenohOutlet(self._holdings, key, made)

    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> Handle:
        """Call `sink` for every sample published on `key`; with TRANSIENT_LOCAL what was retained comes first."""
        gate = make_gate(sink)
        made = self._make(key, declare.declare_subscriber, key, gate, resolved(qos))
        latched = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
        return handles.ZenohSubscription(self._holdings, made, gate, self._holdings.topic(key), latched=latched)

    def serve(self, key: str, sink: Sink) -> Handle:
        """Call `sink` for every call on `key`; `accept` turns what it gets into a Query."""
        grouped = self._groups.serve(key, sink, self._serve) if self._may_group else None
        return grouped or self._serve(key, sink)

    def _serve(self, key: str, sink: Sink) -> Handle:
        gate = make_gate(sink)
        return handles.Declared(self._holdings, [self._make(key, declare.declare_server, key, gate)], gate)

    def call(self, key: str, payload: bytes, attachment: bytes, sink: Sink) -> Handle:
        """Send a request to all servers of `key`. `sink` gets each reply, then None once as the end."""
        refuse_giant(key, payload)
        gate, end = make_gate(sink), make_gate(sink, None)
        self._ends.add(end)
        call = zenoh_handles.ZenohCall(self._make(key, declare.call, key, payload, attachment, gate, end), gate, end)
        self._calls.add(call)
        return call

    def announce(self, token: str) -> Handle:
        """Declare a liveliness token, visible to all watches until it is closed or this process is gone."""
        return ZenohToken(self._holdings, self._make(token, declare.declare_token, token), token)

    def watch(self, pattern: str, on_change: Callable[[str, bool], object]) -> Handle:
        """Call `on_change(token, alive)` for each token that matches `pattern`, on a thread of its own."""

        def on_token(token: str, alive: bool) -> object:
            self._pools.look()  # somebody new has come, perhaps
            return on_change(token, alive)

        changes = Changes(on_token, self._holdings.tokens)
        return ZenohWatch(self._holdings, self._make(pattern, declare.declare_watch, pattern, changes), changes)

    def tokens(self, pattern: str) -> list[str]:
        """Return the tokens that match `pattern`, sorted: also those of peers that this session only just found.

        A session that has just taken the rendezvous port waits for those that may still be there without one.
        """
        time.sleep(max(0.0, self._met_at - clocks.monotonic()))
        subscriber = self._make(pattern, declare.declare_look, pattern)
        try:
            ask = functools.partial(self._make, pattern, declare.ask, pattern)
            return sorted(settled(subscriber.handler, ask, self._peers))
        finally:
            declare.quietly(subscriber.undeclare)

    def declare(self, key: str, action: Callable[[Any], list[Any]], *gates: Sink) -> Handle:
        """Declare something that is not part of Transport, until it or this session is closed.

        Args:
            key: Key, for errors.
            action: Function of Zenoh's session, which returns its declarations.
            gates: Gates through which they call, which are closed with them.
        """
        return handles.Declared(self._holdings, self._make(key, action), *gates)

    def links(self) -> list[Link]:
        """Return the connections to other sessions."""
        with lifetime.inside:
            return links_of(self.session)

    def read(self, arrived: Any) -> Sample:
        """Convert an item of a subscription's or a call's sink to bytes.

        Raises TransportError on an error reply, OverwrittenError for a message that its sender has overwritten.
        """
        kind = type(arrived)
        if kind is _ZenohSample:  # the usual case first, and without calls: this is run once a message
            attachment, payload = arrived.attachment, arrived.payload
            shared = payload.as_shm()
            copied = payload.to_bytes() if shared is None else bytes(shared)  # the latter is one plain copy
            sample = make_sample((copied, b"" if attachment is None else attachment.to_bytes()))
            if shared is not None:
                if not shared.is_valid():  # asked after the copy: it may happen during it
                    raise OverwrittenError(sample.attachment)
                self._pools.look()
            if len(sample[0]) >= heap.LARGE:
                heap.note(len(sample[0]))
            return sample
        if kind is Sample:
            own: Sample = arrived
            return own
        return zenoh_handles.content_of_reply(arrived)

    def opener(self, check: Callable[[bytes], object], decode: Callable[[bytes], Any]) -> Callable[[Any], Any]:
        """Return a function that does `read`, `check` and `decode`; in one frame where the message is small."""
        read = self.read

        def opened(arrived: Any) -> Any:
            if type(arrived) is _ZenohSample and len(raw := arrived.payload) < SMALL and raw.as_shm() is None:
                beside = arrived.attachment
                payload, attachment = raw.to_bytes(), b"" if beside is None else beside.to_bytes()
            else:
                payload, attachment = read(arrived)
            check(attachment)
            return decode(payload)

        return opened

    def size(self, arrived: Any) -> int:
        """Return the payload size, in bytes, of an item of a subscription's sink, without copying it."""
        return len(arrived.payload)

    def attachment(self, arrived: Any) -> bytes:
        """Return the attachment of an item of a subscription's sink, without copying the payload."""
        attachment = arrived.attachment
        if attachment is None:
            return b""
        plain: bytes = attachment if type(arrived) is Sample else attachment.to_bytes()  # a Sample is of this session
        return plain

    def accept(self, arrived: Any) -> Query:
        """Convert an item of a server's sink to a Query. Raises OverwrittenError, and ends the call, as `read` does."""
        return zenoh_handles.ZenohQuery(arrived)

    def close(self) -> None:
        """Undeclare everything and leave the network; calls under way end. Safe to call twice."""
        if self._has_left:
            return
        if lifetime.is_ending():  # whoever waits ends as well, and shall not complain that nobody answers
            for end in lifetime.all_of(self._ends):
                close_gate(end)
        why = f"session {self.session_id} has been closed"
        with self._holdings.lock:
            declared = self._holdings.end(why)
        leave(self._claim, self.session, [entity for handle in declared for entity in handle.shut(why)])
        self._has_left = True  # so late: a Ctrl-C that breaks into this must not keep the exit from doing it
        lifetime.forget(self)

    def lose_calls(self) -> None:
        """End the calls that are under way, whose answers cannot come any more; `read` raises SessionReplacedError."""
        for each in lifetime.all_of(self._calls):
            each.lose()

    def disown(self) -> None:
        """Refuse every further use in a forked child."""
        self._has_left = True
        for handle in self._holdings.end(lifetime.AFTER_FORK):  # not locked: whoever holds the lock may be gone
            handle.disown(lifetime.AFTER_FORK)
        lifetime.leak(self.session)

    def _make(self, key: str, action: Callable[..., Any], *arguments: object) -> Any:
        self._holdings.check()
        try:
            with lifetime.inside:
                return action(self.session, *arguments)
        except zenoh.ZError as error:
            raise self._holdings.failure(key, error) from None

    def _peers(self) -> set[str]:
        with lifetime.inside:
            return {str(peer) for peer in self.session.info.peers_zid()}
