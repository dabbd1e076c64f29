"""Exercises in the view's server: what pages ask is done beside the loop, and all pages are told what comes of it."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable

from robolink.view.exercises import Exercises, Operation
from robolink.view.protocol import answers
from robolink.view.protocol.requests import Learn


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
            told = await asyncio.get_running_loop().run_in_executor(None, do, request.command, request.name)
        for each in told:
            say(text_of(each))

    def close(self) -> None:
        """End what runs."""
        self._exercises.close()


def text_of(operation: Operation) -> str:
    """Return an operation as text."""
    return answers.text(**operation)
