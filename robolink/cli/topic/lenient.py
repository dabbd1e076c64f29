"""Lenient filter: one message that cannot be read or filtered is left out, and does not end the command."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.cli.shared.output import tell
from robolink.exceptions import DecodeError, TransportError


class Leniently:
    """Filter that leaves out messages on which it fails; the first error is printed on standard error."""

    def __init__(self, passes: Callable[[Any], bool]) -> None:
        self._passes = passes
        self._told = False

    def __call__(self, message: Any) -> bool:
        """Return True if a message passes."""
        from robolink.cli.topic.filter import FilterError

        try:
            return self._passes(message)
        except FilterError as error:
            self._tell(f"{error} (a message is left out; the next ones are left out silently)")
            return False

    def decoded(self, decode: Callable[[], Any]) -> Any:
        """Return a decoded message; None if it cannot be decoded."""
        try:
            return decode()
        except (DecodeError, TransportError) as error:
            self._tell(f"a message cannot be read: {error} (the next ones are left out silently)")
            return None

    def _tell(self, text: str) -> None:
        if not self._told:
            self._told = True
            tell(f"robolink: {text}")
