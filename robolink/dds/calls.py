"""Calls under way, and the queries by which servers of the same session get them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.system.waits import fork_lock
from robolink.transport.base import Sink, refuse_giant
from robolink.transport.gates import close_gate, make_gate


class Call:
    """A call under way: it ends when each server has answered or gone, or when the caller gives up.

    A server of another participant that lives and never answers keeps it open: DDS has no sign for that.
    """

    def __init__(self, key: str, sink: Sink, on_end: Callable[[Call], object]) -> None:
        self.key = key
        self._gate: Any = make_gate(sink)
        self._on_end = on_end
        self._lock = fork_lock()
        self._waiting: list[object] = []
        """Servers that have not answered yet: GUIDs of others' request readers, and queries of this session."""
        self._is_open, self._is_sent = True, False
        self.on_over: list[Callable[[], object]] = []
        """Functions by which the client forgets the call."""

    def expect(self, server: object) -> None:
        """Expect an answer."""
        with self._lock:
            self._waiting.append(server)

    def sent(self) -> None:
        """Note that all servers have been asked; without any the call ends here."""
        with self._lock:
            self._is_sent = True
            self._end_if_done()

    def answer(self, payload: bytes, attachment: bytes) -> None:
        """Hand over a reply, unless the call has ended."""
        with self._lock:
            if self._is_open:
                self._gate((payload, attachment))

    def finish(self, server: object) -> None:
        """Expect no more of a server."""
        with self._lock:
            if server in self._waiting:
                self._waiting.remove(server)
                self._end_if_done()

    def finish_one_of(self, prefix: bytes) -> None:
        """Expect no more of one server of a participant, which has answered."""
        with self._lock:
            for server in self._waiting:
                if isinstance(server, bytes) and server[:12] == prefix:
                    self.finish(server)
                    return

    def _end_if_done(self) -> None:
        if self._is_sent and not self._waiting:
            self.end()

    def end(self) -> None:
        """End the call: its sink gets None, once."""
        with self._lock:
            if not self._is_open:
                return
            self._is_open = False
            self._gate(None)
        self.close()

    def close(self) -> None:
        """Abandon the call: nothing comes any more. Safe to call twice."""
        with self._lock:
            self._is_open = False
            close_gate(self._gate)
        for forget in self.on_over:
            forget()
        self._on_end(self)


class LocalQuery:
    """Server's side of a call from its own session; freeing it closes it."""

    def __init__(self, payload: bytes, attachment: bytes, call: Call) -> None:
        self.payload, self.attachment = payload, attachment
        self._call = call
        # Not the query itself, which is closed when nothing refers to it any more.
        self._place = object()
        call.expect(self._place)

    def reply(self, payload: bytes, attachment: bytes) -> None:
        """Send a reply, from any thread. Does nothing when the caller is gone."""
        refuse_giant(f"the answer to a call of {self._call.key}", payload)
        self._call.answer(payload, attachment)

    def close(self) -> None:
        """Finish the call: no more replies will come."""
        self._call.finish(self._place)

    __del__ = close
