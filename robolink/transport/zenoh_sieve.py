"""Sieve for messages that come twice: from a session and its successor, or again from a publisher declared anew."""

from __future__ import annotations

import threading
from typing import Any

from robolink.transport.base import Sink

MOST = 4096
"""Number of messages that a sieve remembers, by their attachments of 33 bytes: some 0.5 MB at most."""


class Sieve:
    """Sink that passes each message on once, by its attachment: publisher, number and time; those without pass."""

    def __init__(self, sink: Sink) -> None:
        self._sink = sink
        self._lock = threading.Lock()
        self._seen: dict[bytes, None] = {}

    def __call__(self, arrived: Any) -> None:
        """Pass a sample on unless it is known."""
        attachment = arrived.attachment
        if attachment is not None and not isinstance(attachment, bytes):
            attachment = attachment.to_bytes()
        if not attachment or self._is_new(attachment):
            self._sink(arrived)

    def _is_new(self, attachment: bytes) -> bool:
        with self._lock:
            if attachment in self._seen:
                return False
            self._seen[attachment] = None
            if len(self._seen) > MOST:
                del self._seen[next(iter(self._seen))]
            return True
