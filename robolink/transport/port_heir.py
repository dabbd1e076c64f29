"""Heir of the rendezvous port: when the process that listens there has ended, another one of its machine does.

Who names this machine from elsewhere knows no other port. A session of Zenoh's listens on nothing that it did not begin
with, so a second one is opened, which declares nothing: it tells newcomers of all others, by gossip.
"""

from __future__ import annotations

import contextlib
import threading
import time
import weakref
from collections.abc import Callable

import zenoh

from robolink.transport import lifetime
from robolink.transport.port_sharing import PortClaim, is_taken
from robolink.transport.reach import Reach
from robolink.transport.zenoh_declare import close_session

LOOKS_EVERY = 0.5
"""Interval of the looks, in seconds. Two of them must find the port free: a system that ends is gone then."""

CLOSE_WITHIN = 0.15
"""Longest `close`, in seconds; then it goes on in the background."""


def claim_of(claim: PortClaim, port: int, open_session: Callable[[bool], zenoh.Session], within: Reach) -> PortClaim:
    """Return the claim of a session that does not hold the port of its domain: an heir's, if others may come there.

    None with security: permissions that change would not reach the second session.

    Args:
        claim: The session's own.
        port: The port.
        open_session: Function that opens a session, with True one that listens at the port, or raises ZError.
        within: Reach of the session.
    """
    return Heir(port, open_session) if within.multicast and not within.secured else claim


class Heir(PortClaim):
    """Claim of a port that another process holds: it is granted when that one has ended."""

    def __init__(self, port: int, open_session: Callable[[bool], zenoh.Session]) -> None:
        self._port, self._open_session = port, open_session
        self._claim: PortClaim | None = None
        self._sessions: list[zenoh.Session] = []
        self._lock, self._is_over = threading.Lock(), False
        self.granted = False
        lifetime.watch_over(self)
        with contextlib.suppress(RuntimeError):  # Python 3.12 starts no threads any more at exit
            threading.Thread(target=_watch, args=(port, weakref.ref(self)), name="robolink port", daemon=True).start()

    @property
    def waits(self) -> bool:
        """True while the port may come to it."""
        return not self.granted and not self._is_over

    def take(self) -> None:
        """Listen on the port, unless another heir was faster."""
        with self._lock:
            claim = PortClaim(self._port)
            if not claim.granted or not self.waits:
                return
            try:
                with lifetime.inside:
                    self._sessions.append(self._open_session(True))
            except zenoh.ZError:
                claim.release()
            else:
                self._claim, self.granted = claim, True

    def release(self) -> None:
        """Leave the port. Safe to call twice."""
        with self._lock:
            self._is_over = True
            while self._sessions:
                close_session(self._sessions.pop())
            if self._claim:
                self._claim.release()
        lifetime.forget(self)

    def close(self) -> None:
        """Leave the port, in the background if it takes long."""
        lifetime.finish(self.release, CLOSE_WITHIN)

    def disown(self) -> None:
        """Refuse every further use in a forked child."""
        self._is_over = True
        lifetime.leak(self._sessions)


def _watch(port: int, of: weakref.ref[Heir]) -> None:
    was_free = False
    while (heir := of()) is not None and heir.waits:
        is_free = not is_taken(f"tcp/0.0.0.0:{port}")
        if is_free and was_free:
            heir.take()
        was_free = is_free
        del heir  # not kept alive while this sleeps
        time.sleep(LOOKS_EVERY)
