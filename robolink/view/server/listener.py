"""Client as the parts of the server see it: something that is told, and can be told what is wrong."""

from __future__ import annotations

from typing import Protocol

from robolink.view.protocol.subprotocols import ERROR


class Listener(Protocol):
    """Receiver of answers."""

    is_page: bool
    """True for robolink's own page, which is told more."""

    def say(self, text: str) -> None:
        """Send an operation in JSON."""

    def send(self, body: bytes) -> None:
        """Send a binary operation."""

    def complain(self, message: str, level: int = ERROR) -> None:
        """Report, as a status, what is wrong."""
