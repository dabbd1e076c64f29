"""Client of the control socket: finds running launchers, for `launch --status`, `stop` and `restart`."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from robolink.exceptions import RobolinkError
from robolink.supervisor.control.protocol import Connection, Request, Response, connect
from robolink.supervisor.control.registry import (
    Registration,
    has_process,
    registrations,
    runtime_folder,
    unregister,
)
from robolink.system import clocks
from robolink.system.terminal import shown

ANSWER_WITHIN = 3.0
"""Timeout of a response, in seconds; a launcher that is paused (Ctrl-Z) accepts a connection and is silent."""

_VANISHES_WITHIN = 1.0


class LauncherError(RobolinkError, ConnectionError):
    """A launcher does not answer, or refuses; the text names it and the reason."""


class LauncherGoneError(LauncherError):
    """A launcher no longer runs; its files have been removed."""


class Launcher:
    """A registered launcher. `name` is its launch file's, `started` its time of registration in UNIX seconds."""

    def __init__(self, place: Path, registration: Registration) -> None:
        self._place = place
        self._registration = registration
        self.name, self.pid, self.file = registration.name, registration.pid, registration.file
        self.started = registration.registered
        self.nodes, self.domain = registration.nodes, registration.domain

    def __str__(self) -> str:
        return f"{shown(self.name)} (pid {self.pid})"

    def is_there(self) -> bool:
        """True if it runs, answering or busy; if not, its files are removed."""
        address = self._registration.address
        if not self._place.with_suffix(".json").exists():
            return False
        try:
            connect(address, ANSWER_WITHIN).close()
            is_there = isinstance(address, str) or self._lives()  # a port may be another program's by now
        except FileNotFoundError:
            is_there = False
        except (OSError, ValueError, OverflowError):  # no address; or too many wait there, perhaps since it is paused
            is_there = self._lives()
        if not is_there:
            unregister(self._place)
        return is_there

    def status(self, within: float | None = None) -> Response:
        """Return the state of its processes; `within` is the timeout in seconds, None for the usual one.

        Raises `LauncherError`, and `LauncherGoneError` when it no longer runs.
        """
        return self._ask(Request("status"), within)

    def restart(self, node: str) -> None:
        """Request the restart of a process, which follows later. Raises like `status`."""
        self._ask(Request("restart", node))

    def stop_one(self, node: str) -> None:
        """Request the orderly stop of one process, which follows later; the others go on. Raises like `status`."""
        self._ask(Request("stop_one", node))

    def stop(self, patience: float) -> bool:
        """Stop it; return True if it ended within `patience` seconds. Raises `LauncherError`."""
        try:
            with self._conversation() as peer:
                peer.ask(Request("stop"))
                return peer.ends_within(patience)
        except LauncherGoneError:
            return True

    def _ask(self, request: Request, within: float | None = None) -> Response:
        with self._conversation(within) as peer:
            answer = peer.ask(request)
        if answer.error:
            raise LauncherError(answer.error)
        return answer

    @contextmanager
    def _conversation(self, within: float | None = None) -> Iterator[Connection]:
        seconds = ANSWER_WITHIN if within is None else within
        try:
            with connect(self._registration.address, seconds) as connection:
                peer = Connection(connection, self._registration.key, clocks.monotonic() + seconds)
                peer.be_greeted()
                yield peer
        except LauncherError:
            raise
        except (EOFError, OSError, ValueError, OverflowError, RobolinkError) as error:
            if self._has_gone(soon=isinstance(error, (EOFError, ConnectionResetError))):
                raise LauncherGoneError(f"{self} runs no more") from None
            why = str(error) or type(error).__name__
            raise LauncherError(f"{self} does not answer: {why} (is it paused, by Ctrl-Z?)") from None

    def _has_gone(self, *, soon: bool) -> bool:
        """True if it no longer runs, with `soon` after a moment: a killed one hangs up before it is gone."""
        deadline = clocks.monotonic() + (_VANISHES_WITHIN if soon else 0.0)
        while self.is_there():
            if clocks.monotonic() >= deadline:
                return False
            time.sleep(0.02)
        return True

    def _lives(self) -> bool:
        """True if the registered process is alive; a later process that got its id does not count."""
        import psutil

        try:
            process = psutil.Process(self.pid)
            is_older = process.create_time() < self.started + 1.0
            return is_older and process.status() != psutil.STATUS_ZOMBIE
        except (psutil.NoSuchProcess, ValueError, OverflowError):
            return False
        except psutil.AccessDenied:
            return True


def running() -> list[Launcher]:
    """Return the running launchers of this user, oldest first; files of killed ones are removed.

    Raises `RuntimeFolderError`.
    """
    found = (each for each in _registered() if each.is_there())
    return sorted(found, key=lambda each: (each.started, each.pid))


def clear_away() -> None:
    """Remove the files of killed launchers, without asking those that seem to run. Raises like `running`."""
    for each in _registered():
        if not has_process(each.pid):
            each.is_there()


def _registered() -> list[Launcher]:
    return [Launcher(place, registration) for place, registration in registrations(runtime_folder())]
