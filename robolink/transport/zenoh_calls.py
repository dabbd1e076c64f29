"""Both sides of a call over Zenoh: the pending one, and the query that a server answers."""

from __future__ import annotations

import threading
from typing import Any

import zenoh

from robolink.exceptions import OverwrittenError, SessionReplacedError, TransportError
from robolink.system.terminal import shown
from robolink.transport.base import Sample, Sink, refuse_giant
from robolink.transport.zenoh_declare import close_gate, quietly
from robolink.transport.zenoh_handles import LARGE

LOST = object()
"""Item of a call's sink in place of an answer that cannot come any more."""


class ZenohCall:
    """A pending call. Giving up is final: neither replies nor the end come after it."""

    def __init__(self, cancel: zenoh.CancellationToken, gate: Any, end: Any) -> None:
        self._cancel, self._gate, self._end = cancel, gate, end
        self._lock, self._has_closed = threading.Lock(), False

    def lose(self) -> None:
        """End it now, since its session is left; unless it has ended, the sink gets LOST, and then the end."""
        with self._lock:
            if not self._has_closed:  # the end is called once at most: nothing comes of this after it
                self._end.__setstate__((_tell_lost, (self._gate.func,), {}, None))
        quietly(self._cancel.cancel)

    def close(self) -> None:
        """Cancel the call. Safe to call twice."""
        with self._lock:
            self._has_closed = True
            close_gate(self._gate)
            close_gate(self._end)
        quietly(self._cancel.cancel)


def _tell_lost(sink: Sink) -> None:
    sink(LOST)
    sink(None)


class ZenohQuery:
    """Server's side of a call; freeing it closes it."""

    def __init__(self, raw: zenoh.Query) -> None:
        self._raw, self._key = raw, raw.key_expr
        try:
            self.payload, self.attachment = content(raw.payload), content(raw.attachment)
        except OverwrittenError:
            self.close()
            raise

    def reply(self, payload: bytes, attachment: bytes) -> None:
        """Send a reply, from any thread. Does nothing when the caller is gone. Raises TransportError for giants."""
        if len(payload) >= LARGE:
            refuse_giant(f"the answer to a call of {self._key}", payload)
        quietly(lambda: self._raw.reply(self._key, payload, attachment=attachment))

    def close(self) -> None:
        """Finish the call: no more replies will come."""
        quietly(self._raw.drop)


def content(raw: zenoh.ZBytes | None) -> bytes:
    """Return the bytes, empty for None. Raises OverwrittenError if they are no longer what was sent."""
    if raw is None:
        return b""
    copied, shared = raw.to_bytes(), raw.as_shm()
    if shared is not None and not shared.is_valid():
        raise OverwrittenError
    return copied


def content_of_reply(reply: Any) -> Sample:
    """Return the sample of a reply; raises TransportError for an error reply, SessionReplacedError for LOST."""
    if reply is LOST:
        raise SessionReplacedError
    sample = reply.ok
    if sample is not None:
        return Sample(content(sample.payload), content(sample.attachment))
    error = reply.err
    text = content(error.payload).decode(errors="replace") if error is not None else ""
    raise TransportError(f"the server replied with an error: {shown(text, 200)}")
