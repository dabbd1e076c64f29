"""The door of a running launcher: other shells ask how its processes are, to restart or stop one, or for its end."""

from __future__ import annotations

import contextlib
import os
import socket
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Protocol

from robolink.exceptions import RobolinkError, nearest
from robolink.supervisor.door.asking import clear_away
from robolink.supervisor.door.runtime import Registration, files_at, new_place, register, runtime_folder, unregister
from robolink.supervisor.door.talk import AF_UNIX, Answer, Line, Question, connect, listen
from robolink.supervisor.events import Status

PATIENCE = 3.0
"""Seconds that a client has to ask and to take its answer."""
MOST_CLIENTS = 16
"""So many are served at once; others wait at the door."""


class Controlled(Protocol):
    """What is controlled; all of it may be called from any thread and returns at once."""

    leavings: list[Path]
    """Files that somebody removes if this process is killed; where nobody can, the next launcher does."""

    def status(self) -> Sequence[Status]:
        """Say how each process is."""

    def restart(self, name: str) -> object:
        """Start one anew."""

    def why_not_restarted(self, name: str) -> str:
        """Say why that would do nothing now; '' if it would."""

    def stop_one(self, name: str) -> object:
        """Stop one; the others go on."""

    def why_not_stopped(self, name: str) -> str:
        """Say why that would do nothing now; '' if it would."""

    def stop(self) -> object:
        """End them all."""

    def say(self, text: str) -> object:
        """Tell the user."""


class Control:
    """Lets a launcher be asked, inside a `with`; where that is impossible, says so once and the launcher runs on.

    `members` are the nodes that share a process, by the process's name. A thread waits for clients, and each of these
    has one while it is served, for `patience` seconds at most: none wakes up by itself or can hold the launcher up.
    """

    def __init__(
        self,
        controlled: Controlled,
        *,
        name: str,
        file: str = "",
        members: Mapping[str, Sequence[str]] | None = None,
        patience: float = PATIENCE,
    ) -> None:
        self._controlled = controlled
        self._name, self._file = _as_text(name), _as_text(file)
        self._members = {process: list(nodes) for process, nodes in (members or {}).items()}
        self._patience = patience
        self._key = os.urandom(32).hex()
        self._places = threading.BoundedSemaphore(MOST_CLIENTS)
        self._clients: set[socket.socket] = set()
        self._waiting_for_our_end: list[socket.socket] = []
        self._lock = threading.Lock()
        self._closing = threading.Event()
        self._door: _Door | None = None
        self._thread = threading.Thread(target=self._accept, name="control", daemon=True)

    def __enter__(self) -> Control:
        try:
            self._door = _Door(self._name, self._file, self._key)
        except (OSError, ValueError, RobolinkError) as error:  # ValueError: a folder whose name is no text
            self._controlled.say(f"no other shell can ask for the status, restart or stop: {error}")
        else:
            self._controlled.leavings += self._door.files
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._door is None:
            return
        self._closing.set()
        self._door.close()
        with self._lock:
            for client in self._clients:
                with contextlib.suppress(OSError):
                    client.shutdown(socket.SHUT_RDWR)
        self._thread.join(1.0)
        for client in self._waiting_for_our_end:
            client.close()

    def _accept(self) -> None:
        assert self._door is not None
        with contextlib.suppress(OSError, RobolinkError):
            clear_away()
        with self._door.listener as listener:
            while not self._closing.is_set():
                self._places.acquire()
                try:
                    client, _ = listener.accept()
                except OSError:  # out of file descriptors, say; or it is the end
                    self._places.release()
                    self._closing.wait(1.0)
                    continue
                if self._closing.is_set():
                    client.close()
                else:
                    self._admit(client)

    def _admit(self, client: socket.socket) -> None:
        """Serve a client on a thread of its own."""
        with self._lock:
            self._clients.add(client)
        try:
            threading.Thread(target=self._serve, args=(client,), name="control client", daemon=True).start()
        except RuntimeError:  # no more threads
            self._dismiss(client)

    def _serve(self, client: socket.socket) -> None:
        stays = False
        try:
            line = Line(client, self._key, time.monotonic() + self._patience)
            line.greet()
            question = line.hear()
            line.answer(self._answer(question))
            stays = question.ask == "stop"  # the connection's end then tells the client of ours
        except (OSError, EOFError, RobolinkError):  # none of ours, or gone
            pass
        finally:
            self._dismiss(client, stays=stays)

    def _dismiss(self, client: socket.socket, *, stays: bool = False) -> None:
        with self._lock:
            self._clients.discard(client)
            stays = stays and not self._closing.is_set()
            if stays:
                self._waiting_for_our_end.append(client)
        if not stays:
            client.close()
        self._places.release()

    def _answer(self, question: Question) -> Answer:
        asked = self._controlled
        if question.ask == "restart":
            return self._about(question.node, "restarted", asked.why_not_restarted, asked.restart)
        if question.ask == "stop_one":
            return self._about(question.node, "stopped", asked.why_not_stopped, asked.stop_one)
        if question.ask == "stop":
            asked.stop()
        return Answer(nodes=list(asked.status()), members=self._members)

    def _about(self, name: str, done: str, why_not: Callable[[str], str], act: Callable[[str], object]) -> Answer:
        """Do something with one process, unless it is not there or there is a reason why not."""
        names = [each.name for each in self._controlled.status()]
        if name not in names:
            return Answer(error=f"no node named '{name}' in '{self._name}'{nearest(name, names)}")
        if reason := why_not(name):
            return Answer(error=f"'{name}' of '{self._name}' is not {done}: {reason}")
        act(name)
        return Answer()


def _as_text(name: str) -> str:
    """Give a file's name with a question mark for each byte that is no letter in UTF-8: JSON has no other."""
    return name.encode(errors="replace").decode()


class _Door:
    """A socket that listens, and the word that is left of it. Raises OSError and `RuntimeFolderError`."""

    def __init__(self, name: str, file: str, key: str) -> None:
        self._place = new_place(runtime_folder())
        self.files = files_at(self._place)
        self.listener, self._address = listen(str(self._place.with_suffix(".sock")))
        try:
            if AF_UNIX is not None:
                self._place.with_suffix(".sock").chmod(0o600)
            register(self._place, Registration(os.getpid(), name, file, self._address, key, time.time()))
        except BaseException:
            self.listener.close()
            unregister(self._place)
            raise

    def close(self) -> None:
        """Take the word back, and wake whoever waits here for a client: being one does so on every system."""
        try:
            connect(self._address, 0.5).close()
        except OSError:  # somebody removed the socket
            with contextlib.suppress(OSError):
                self.listener.shutdown(socket.SHUT_RDWR)
        unregister(self._place)
