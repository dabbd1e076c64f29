"""A filter that one strange message does not bring to its end."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.cli.output import tell
from robolink.exceptions import DecodeError, TransportError


class Leniently:
    """A filter that lets nothing through of which it cannot tell; why is told on standard error, once."""

    def __init__(self, passes: Callable[[Any], bool]) -> None:
        self._passes = passes
        self._told = False

    def __call__(self, message: Any) -> bool:
        """Whether a message passes."""
        from robolink.cli.topic.filter import FilterError

        try:
            return self._passes(message)
        except FilterError as error:
            self._tell(f"{error} (a message is left out; the next ones are left out silently)")
            return False

    def decoded(self, decode: Callable[[], Any]) -> Any:
        """Give what is decoded; None of what cannot be."""
        try:
            return decode()
        except (DecodeError, TransportError) as error:
            self._tell(f"a message cannot be read: {error} (the next ones are left out silently)")
            return None

    def _tell(self, text: str) -> None:
        if not self._told:
            self._told = True
            tell(f"robolink: {text}")
