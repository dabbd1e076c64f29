"""Recording of the running system into a bag, begun and ended by clients; its state is told once a second."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Callable
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import TYPE_CHECKING, Any

from robolink.exceptions import RobolinkError
from robolink.view.protocol import answers
from robolink.view.protocol.requests import ProtocolError, Record
from robolink.view.sources.live import LiveSource

if TYPE_CHECKING:
    from robolink.bag.recording import Recording


class Recorder:
    """The one recording that the server makes at a time, of all topics.

    Args:
        system: System that is recorded.
        tell: Function that sends an operation in JSON to all clients that know this one.
        folder: Folder for the bags; by default where the server was started.
    """

    def __init__(self, system: LiveSource, tell: Callable[[str], object], folder: Path | None = None) -> None:
        self._system, self._tell, self._folder = system, tell, folder or Path.cwd()
        self._recording: Recording | None = None
        self._busy = asyncio.Lock()

    async def obey(self, request: Record) -> None:
        """Begin or end a recording. Raises RobolinkError with the reason if it cannot be."""
        async with self._busy:
            if request.command == "start":
                await self._start(request.path)
            elif request.command == "stop":
                await self._stop()
            else:
                raise ProtocolError(f"record: no command {request.command[:60]!r}; there are start and stop")

    async def _start(self, name: str | None) -> None:
        if self._recording is not None:
            raise ProtocolError(f"record: {self._recording.path} is being recorded already")
        from robolink.bag.recording import Recording, Selection

        path = self._folder / _checked(name or time.strftime("rosbag2_%Y_%m_%d-%H_%M_%S"))
        made = Recording(self._system.node, path, Selection(all_topics=True))
        try:
            await asyncio.get_running_loop().run_in_executor(None, made.start)
        except (RobolinkError, OSError) as error:
            self._tell(state("off", str(path), error=str(error)))
            raise ProtocolError(f"record: {error}") from None
        self._recording = made
        self.tick()

    async def _stop(self) -> None:
        recording, self._recording = self._recording, None
        if recording is None:
            raise ProtocolError("record: nothing is being recorded")
        await asyncio.get_running_loop().run_in_executor(None, recording.stop)
        self._tell(_state_of(recording, "off"))

    def tick(self) -> None:
        """Send the state of a recording; to be called once a second."""
        if self._recording is None:
            return
        if self._recording.figures().error:  # it has ended by itself
            recording, self._recording = self._recording, None
            self._tell(_state_of(recording, "off"))
        else:
            self._tell(self.state())

    def state(self) -> str:
        """Return the state as a new client is told it."""
        return _state_of(self._recording, "on") if self._recording is not None else state("off")

    def close(self) -> None:
        """End a recording that is under way, so that its bag is whole."""
        recording, self._recording = self._recording, None
        if recording is not None:
            with contextlib.suppress(RobolinkError, OSError):
                recording.stop()


def state(word: str, path: str | None = None, **more: Any) -> str:
    """Return the operation `recording`: on or off, and what there is to say of it."""
    return answers.text("recording", state=word, path=path, **more)


def _state_of(recording: Recording, word: str) -> str:
    figures = recording.figures()
    return state(
        word,
        str(figures.path),
        seconds=round(figures.seconds, 1),
        bytes=figures.bytes,
        messages=figures.messages,
        dropped=sum(figures.dropped.values()),
        error=figures.error or None,
    )


def _checked(name: str) -> str:
    """Return the name of a bag below the folder of bags; raises ProtocolError for one that leads out of it."""
    for path in (PurePosixPath(name), PureWindowsPath(name)):
        if path.anchor or ".." in path.parts or not path.name or "\0" in name:
            raise ProtocolError(
                f"record: {name[:200]!r} is not a name for a bag in the folder where the server was started"
            )
    return name
