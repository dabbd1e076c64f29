"""Participant of a DDS domain, with sockets and a thread of its own."""

from __future__ import annotations

import logging
import math
import os
import threading
import time
from collections.abc import Callable, Sequence
from time import perf_counter as steady
from typing import Any

from robolink.rtps import ids
from robolink.rtps.announcements import ParticipantData
from robolink.rtps.core import Accepts, Core, LocalReader, LocalWriter, OnMatch, Sink
from robolink.rtps.discovery import LEASE, Resolve
from robolink.rtps.parameters import Buffer, Locator
from robolink.rtps.reach import Reach
from robolink.rtps.sockets import Sockets
from robolink.rtps.types import Endpoint, Peer, Qos

_LOG = logging.getLogger(__name__)
_NOTHING: tuple[Any, ...] = ()
_AFTER_FAULT = 0.1
"""Seconds after a fault of ours in what was due, until it is tried again."""


class Participant:
    """A participant: makes writers and readers, and knows those of others.

    All methods are thread-safe. Callbacks are called on the participant's thread, which holds no lock then: they may
    call any method, but must not block, since nothing is received meanwhile.
    """

    def __init__(
        self,
        domain: int,
        *,
        name: str = "/",
        user_data: bytes = b"",
        reach: Reach = Reach(),  # noqa: B008 - a NamedTuple
        on_peer: Callable[[Peer, bool], object] | None = None,
        on_endpoint: Callable[[Endpoint, bool], object] | None = None,
    ) -> None:
        """Join a domain.

        Args:
            domain: from 0 to 232.
            name: of the participant, as others show it.
            user_data: what others get with its announcement.
            reach: how far it reaches; if not said, it stays on this machine, over loopback.
            on_peer: is called with other participants that came (True; again if what they say changed) or went.
            on_endpoint: the same for their endpoints.

        Raises:
            ReachError: if no port is free, or there is no such interface or static peer. It is an OSError.
            ValueError: if there is no such domain.
        """
        self.domain = domain
        prefix = ids.VENDOR_ROBOLINK + os.urandom(10)
        self.guid = prefix + ids.PARTICIPANT_ENTITY
        self._sockets = Sockets(domain, reach)
        self._outbox: list[tuple[Locator, list[Buffer], float]] = []
        append = self._outbox.append
        me = ParticipantData(
            prefix,
            metatraffic=(self._sockets.metatraffic,),
            default=(self._sockets.default,),
            lease=LEASE,
            name=name,
            user_data=user_data,
            domain=domain,
        )
        self._core = Core(
            me,
            Resolve(self._sockets.search, self._sockets.bounds.choose),
            lambda address, buffers, pause: append((address, buffers, pause)),
            on_peer=on_peer,
            on_endpoint=on_endpoint,
            epoch=time.time_ns() - int(steady() * 1e9),
        )
        self._lock = threading.Lock()
        """Around the core and the outbox. Nothing is sent, and nobody called, under it: a paced sample sleeps between
        its datagrams, and a callback may want a lock whose holder waits for this one."""
        self._wakes_at = -math.inf
        """When the thread wakes up by itself."""
        self._is_open, self._is_faulty = True, False
        self._thread = threading.Thread(target=self._run, name=f"rtps domain {domain}", daemon=True)
        self._thread.start()

    def writer(
        self,
        topic: str,
        type_name: str,
        qos: Qos = Qos(),  # noqa: B008 - a NamedTuple
        *,
        user_data: bytes = b"",
        accepts: Accepts | None = None,
        on_match: OnMatch | None = None,
    ) -> Writer:
        """Make a writer, and announce it.

        Args:
            topic: as DDS names it.
            type_name: the same.
            qos: what it offers.
            user_data: what others get with its announcement.
            accepts: decides which readers it is matched with, of those that fit: all or none of a participant, since
                one datagram may be for all readers there. It is called on any thread and must not call the participant.
            on_match: is called with readers that it is matched with (True), or was.
        """
        with self._lock:
            local = self._core.add_writer(steady(), topic, type_name, qos, user_data, accepts, on_match)
            sent, is_wake = self._finish()
        self._send(sent, is_wake)
        return Writer(self, local)

    def reader(
        self,
        topic: str,
        type_name: str,
        qos: Qos,
        sink: Sink,
        *,
        user_data: bytes = b"",
        accepts: Accepts | None = None,
        on_match: OnMatch | None = None,
    ) -> Reader:
        """Make a reader, and announce it.

        Args:
            topic: as DDS names it.
            type_name: the same.
            qos: what it requests.
            sink: is called with each sample, serialized, with its header of 4 bytes.
            user_data: what others get with its announcement.
            accepts: decides which writers it is matched with, of those that fit. It is called on any thread and must
                not call the participant.
            on_match: is called with writers that it is matched with (True), or was.
        """
        with self._lock:
            local = self._core.add_reader(steady(), topic, type_name, qos, sink, user_data, accepts, on_match)
            sent, is_wake = self._finish()
        self._send(sent, is_wake)
        return Reader(self, local)

    def peers(self) -> list[Peer]:
        """Return the other participants."""
        with self._lock:
            return self._core.peers()

    def endpoints(self) -> list[Endpoint]:
        """Return the other participants' endpoints."""
        with self._lock:
            return self._core.endpoints()

    def settled(self) -> bool:
        """Return whether all has been read that known participants announced to have."""
        with self._lock:
            return self._core.is_settled()

    def close(self) -> None:
        """Leave the domain with a goodbye. Safe to call twice, and in callbacks."""
        with self._lock:
            if not self._is_open:
                return
            self._core.goodbye()
            sent, _ = self._finish()
            self._is_open = False
        self._send(sent, True)
        if threading.current_thread() is not self._thread:
            self._thread.join(2)

    # What others call under no lock

    def _put(self, local: LocalWriter, payload: Buffer, related: tuple[bytes, int] | None, timestamp: int) -> int:
        with self._lock:
            if not self._is_open:
                return 0
            number = self._core.put(steady(), local, payload, related, timestamp or time.time_ns())
            sent, is_wake = self._finish()
        self._send(sent, is_wake)
        return number

    def _expect(self, local: LocalReader) -> None:
        with self._lock:
            self._core.expect(steady(), local)
            sent, is_wake = self._finish()
        self._send(sent, is_wake)

    def _remove(self, local: LocalWriter | LocalReader) -> None:
        with self._lock:
            if not self._is_open:
                return
            self._core.remove(steady(), local)
            sent, is_wake = self._finish()
        self._send(sent, is_wake)

    def _finish(self) -> tuple[Sequence[tuple[Locator, list[Buffer], float]], bool]:
        """Return, under the lock, what is to be sent, and whether the thread must be woken up."""
        sent = self._outbox[:]
        self._outbox.clear()
        is_wake = self._core.due < self._wakes_at or bool(self._core.calls)
        if is_wake:
            self._wakes_at = -math.inf  # once is enough
        return sent, is_wake

    def _send(self, sent: Sequence[tuple[Locator, list[Buffer], float]], is_wake: bool) -> None:
        send = self._sockets.send
        for address, buffers, pause in sent:
            send(address, buffers, pause)
        if is_wake:
            self._sockets.wake()

    # The thread

    def _run(self) -> None:
        while self._is_open:
            self._sockets.receive(self._do_due(), self._on_datagram)
        self._sockets.close()

    def _do_due(self) -> float:
        """Do what is due; return for how many seconds there is nothing to do."""
        with self._lock:
            now = steady()
            if now >= self._core.due:
                try:
                    self._core.tick(now)
                except Exception:  # noqa: BLE001 - a fault of ours must not end the participant
                    self._core.due = now + _AFTER_FAULT  # not at once: it may come each time
                    self._log_fault("what was due was not done")
            sent, calls = self._take()
            self._wakes_at = due = self._core.due
        self._act(sent, calls)
        # A callback may have made something due earlier: then it has woken us, and `receive` returns at once.
        return max(due - steady(), 0.0)

    def _on_datagram(self, datagram: memoryview, source: Locator) -> None:
        with self._lock:
            try:
                self._core.receive(steady(), datagram, source)
            except Exception:  # noqa: BLE001 - what anybody sends must not end the participant
                self._log_fault(f"a datagram from {source[0]}:{source[1]} was not understood")
            sent, calls = self._take()
        if sent or calls:
            self._act(sent, calls)

    def _log_fault(self, what: str) -> None:
        """Log a fault of ours, the first only: it may come with each datagram."""
        if not self._is_faulty:
            self._is_faulty = True
            _LOG.exception("%s; more of this kind are not logged", what)

    def _take(self) -> tuple[Sequence[tuple[Locator, list[Buffer], float]], Sequence[Any]]:
        sent = calls = _NOTHING
        if self._outbox:
            sent = tuple(self._outbox)
            self._outbox.clear()
        if self._core.calls:
            calls = tuple(self._core.calls)
            self._core.calls.clear()
        return sent, calls

    def _act(self, sent: Sequence[tuple[Locator, list[Buffer], float]], calls: Sequence[Any]) -> None:
        send = self._sockets.send
        for address, buffers, pause in sent:
            send(address, buffers, pause)
        for function, what, how in calls:
            try:
                function(what, how)
            except Exception:  # noqa: BLE001 - a program's fault must not end the participant
                _LOG.exception("a callback of the DDS participant failed")


class Writer:
    """A participant's writer."""

    def __init__(self, participant: Participant, local: LocalWriter) -> None:
        self.guid = local.guid
        self._participant, self._local = participant, local
        self._order = threading.Lock()
        """Samples of two threads leave in the order of their numbers: else they arrive as if one had been lost."""

    def put(self, payload: Buffer, *, related: tuple[bytes, int] | None = None, timestamp: int = 0) -> int:
        """Send a sample on the caller's thread, and return its number; 0 after the participant was closed.

        It does not wait for readers. A RELIABLE writer keeps what they have not acknowledged: at least the last `depth`
        samples, or with a depth of 0 up to `MOST_STORED` of them. Older ones are lost to a reader that is that slow.

        Args:
            payload: serialized, with its header of 4 bytes. It is kept, not copied.
            related: GUID and number of the sample that this one answers.
            timestamp: nanoseconds since 1970; 0: now.
        """
        with self._order:
            return self._participant._put(self._local, payload, related, timestamp)

    def matched(self) -> list[bytes]:
        """Return the GUIDs of the readers that it is matched with."""
        with self._participant._lock:
            return [*self._local.readers]

    def close(self) -> None:
        """Withdraw it. Safe to call twice."""
        self._participant._remove(self._local)


class Reader:
    """A participant's reader."""

    def __init__(self, participant: Participant, local: LocalReader) -> None:
        self.guid = local.guid
        self._participant, self._local = participant, local

    def matched(self) -> list[bytes]:
        """Return the GUIDs of the writers that it is matched with."""
        with self._participant._lock:
            return [*self._local.writers]

    def expect(self) -> None:
        """Expect a sample soon, such as a reply: if none comes, the writers are asked what they sent.

        Else a sample that was lost, and behind which nothing comes, may be repaired late: a Fast DDS says only every
        3 s what it has sent.
        """
        self._participant._expect(self._local)

    def close(self) -> None:
        """Withdraw it. A sample that is on its way to the sink meanwhile may still come. Safe to call twice."""
        self._participant._remove(self._local)
