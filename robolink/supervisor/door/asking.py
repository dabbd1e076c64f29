"""Find the launchers that run, and ask them: what `launch --status`, `stop` and `restart` do from another shell."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from robolink.exceptions import RobolinkError, shown
from robolink.supervisor.door.runtime import Registration, has_process, registrations, runtime_folder, unregister
from robolink.supervisor.door.talk import Answer, Line, Question, connect

ANSWER_WITHIN = 3.0
"""Seconds; a launcher that is paused (Ctrl-Z) takes a connection and says nothing."""

_VANISHES_WITHIN = 1.0


class LauncherError(RobolinkError, ConnectionError):
    """A launcher does not answer, or refuses; the text says which one and why."""


class LauncherGoneError(LauncherError):
    """A launcher runs no more; what it had left behind has been cleared."""


class Launcher:
    """One that has left word. `name` is its launch file's, `started` when it left word, in UNIX seconds."""

    def __init__(self, place: Path, registration: Registration) -> None:
        self._place = place
        self._registration = registration
        self.name, self.pid, self.file = registration.name, registration.pid, registration.file
        self.started = registration.registered

    def __str__(self) -> str:
        return f"{shown(self.name)} (pid {self.pid})"

    def is_there(self) -> bool:
        """Whether it runs, asked or busy; else what it left is cleared."""
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

    def status(self, within: float | None = None) -> Answer:
        """Ask how its processes are; it may take `within` seconds, or some.

        Raises `LauncherError`, and `LauncherGoneError` when it runs no more.
        """
        return self._ask(Question("status"), within)

    def restart(self, node: str) -> None:
        """Have it start a process anew, which it does after this. Raises what `status` does."""
        self._ask(Question("restart", node))

    def stop_one(self, node: str) -> None:
        """Have it stop a process in order, which it does after this; the others go on. Raises what `status` does."""
        self._ask(Question("stop_one", node))

    def stop(self, patience: float) -> bool:
        """Have it stop; say whether it did within `patience` seconds. Raises `LauncherError`."""
        try:
            with self._conversation() as line:
                line.ask(Question("stop"))
                return line.ends_within(patience)
        except LauncherGoneError:
            return True

    def _ask(self, question: Question, within: float | None = None) -> Answer:
        with self._conversation(within) as line:
            answer = line.ask(question)
        if answer.error:
            raise LauncherError(answer.error)
        return answer

    @contextmanager
    def _conversation(self, within: float | None = None) -> Iterator[Line]:
        seconds = ANSWER_WITHIN if within is None else within
        try:
            with connect(self._registration.address, seconds) as connection:
                line = Line(connection, self._registration.key, time.monotonic() + seconds)
                line.be_greeted()
                yield line
        except LauncherError:
            raise
        except (EOFError, OSError, ValueError, OverflowError, RobolinkError) as error:
            if self._has_gone(soon=isinstance(error, (EOFError, ConnectionResetError))):
                raise LauncherGoneError(f"{self} runs no more") from None
            why = str(error) or type(error).__name__
            raise LauncherError(f"{self} does not answer: {why} (is it paused, by Ctrl-Z?)") from None

    def _has_gone(self, *, soon: bool) -> bool:
        """Whether it runs no more, at least `soon`: one that was killed hangs up a moment before it is gone."""
        deadline = time.monotonic() + (_VANISHES_WITHIN if soon else 0.0)
        while self.is_there():
            if time.monotonic() >= deadline:
                return False
            time.sleep(0.02)
        return True

    def _lives(self) -> bool:
        """Whether the process that left word is there: its number may be another's, but that one began later."""
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
    """Give the launchers of this user that run, oldest first; what killed ones have left is cleared.

    Raises `RuntimeFolderError`.
    """
    found = (each for each in _registered() if each.is_there())
    return sorted(found, key=lambda each: (each.started, each.pid))


def clear_away() -> None:
    """Clear what killed launchers have left, without asking those that seem to run. Raises what `running` does."""
    for each in _registered():
        if not has_process(each.pid):
            each.is_there()


def _registered() -> list[Launcher]:
    return [Launcher(place, registration) for place, registration in registrations(runtime_folder())]
