"""Protocol of the exercises that the page's panel `learn` shows: what the view's server needs of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Protocol

from robolink.view.protocol.requests import LearnCommand

Operation = dict[str, Any]
"""Operation of the protocol for pages: its name under `op`, and its fields."""


class Exercises(Protocol):
    """Exercises with automatic checks. The server's loop calls all methods but `obey`."""

    def begin(self, tell: Callable[[Operation], object]) -> None:
        """Begin to watch the files; `tell`, which any thread may call, sends an operation to all pages."""

    def state(self) -> Operation:
        """Return the list of the exercises, as a new page is told it."""

    def obey(self, command: LearnCommand, name: str) -> Iterable[Operation]:
        """Do what a page asks for, on a thread beside the loop; return what this page alone is told.

        Args:
            command: The request.
            name: Name of an exercise; with `language` the language.

        Raises:
            RobolinkError: with the reason, if that cannot be.
        """

    def close(self) -> None:
        """End what runs; nothing is told any more."""
