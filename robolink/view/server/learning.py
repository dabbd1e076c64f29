"""Exercises that the page's panel learn shows: the server's protocol for them, and what pages ask of them."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Iterable
from typing import Any, Protocol

from robolink.view.protocol import answers
from robolink.view.protocol.requests import Learn, LearnCommand

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


class Learning:
    """The exercises of a server.

    Args:
        exercises: The exercises.
        tell: Function that sends an operation in JSON to all pages.
    """

    def __init__(self, exercises: Exercises, tell: Callable[[str], object]) -> None:
        self._exercises, self._tell = exercises, tell
        self._busy = asyncio.Lock()

    def begin(self) -> None:
        """Begin to watch the files, in a running loop."""
        loop = asyncio.get_running_loop()

        def tell(operation: Operation) -> None:
            with contextlib.suppress(RuntimeError):  # the loop has ended
                loop.call_soon_threadsafe(lambda: self._tell(text_of(operation)))

        self._exercises.begin(tell)

    def state(self) -> str:
        """Return the list of the exercises, as a new page is told it."""
        return text_of(self._exercises.state())

    async def obey(self, request: Learn, say: Callable[[str], object]) -> None:
        """Do what a page asks for, one after the other; `say` sends it what it alone is told. Raises RobolinkError."""
        async with self._busy:
            do = self._exercises.obey
            replies = await asyncio.get_running_loop().run_in_executor(None, do, request.command, request.name)
        for each in replies:
            say(text_of(each))

    def close(self) -> None:
        """End what runs."""
        self._exercises.close()


def text_of(operation: Operation) -> str:
    """Return an operation as text."""
    return answers.text(**operation)
