"""Server of the control socket: other shells ask for the status, to restart or stop a process, or to stop all."""

from __future__ import annotations

import contextlib
import os
import socket
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Protocol

from robolink.exceptions import RobolinkError, nearest
from robolink.supervisor.control.client import clear_away
from robolink.supervisor.control.protocol import AF_UNIX, Connection, Request, Response, connect, listen
from robolink.supervisor.control.registry import (
    Registration,
    files_at,
    new_place,
    register,
    runtime_folder,
    unregister,
)
from robolink.supervisor.events import Status
from robolink.system import clocks, waits

PATIENCE = 3.0
"""Timeout of a client's request and of taking its response, in seconds."""
MOST_CLIENTS = 16
"""Most clients that are served at once; others wait in the socket's backlog."""


class Controlled(Protocol):
    """Interface of the controlled supervisor; all of it is thread-safe and returns at once."""

    leavings: list[Path]
    """Files that the guardian removes if this process is killed; where there is none, the next launcher does."""

    def status(self) -> Sequence[Status]:
        """Return the state of each process."""

    def restart(self, name: str) -> object:
        """Restart one process."""

    def why_not_restarted(self, name: str) -> str:
        """Return why `restart` would do nothing now; '' if it would do something."""

    def stop_one(self, name: str) -> object:
        """Stop one process; the others go on."""

    def why_not_stopped(self, name: str) -> str:
        """Return why `stop_one` would do nothing now; '' if it would do something."""

    def stop(self) -> object:
        """Stop the whole system."""

    def say(self, text: str) -> object:
        """Print a line to the user."""


class Control:
    """Control server of a launcher, active inside a `with`; if it cannot start, it says so and the system runs on.

    `members` are the nodes that share a process, by the process's name; `nodes` are the full names of all that it
    starts at once, on a `domain`: another launcher tells who has the same. One thread accepts clients, and each client
    has a thread for at most `patience` seconds: none polls, and none can block the launcher.
    """

    def __init__(
        self,
        controlled: Controlled,
        *,
        name: str,
        file: str = "",
        members: Mapping[str, Sequence[str]] | None = None,
        nodes: Sequence[str] = (),
        domain: int = 0,
        patience: float = PATIENCE,
    ) -> None:
        self._controlled = controlled
        self._name, self._file = _as_text(name), _as_text(file)
        self._nodes, self._domain = tuple(map(_as_text, nodes)), domain
        self._members = {process: list(nodes) for process, nodes in (members or {}).items()}
        self._patience = patience
        self._key = os.urandom(32).hex()
        self._places = threading.BoundedSemaphore(MOST_CLIENTS)
        self._clients: set[socket.socket] = set()
        self._waiting_for_our_end: list[socket.socket] = []
        self._lock = threading.Lock()
        self._closing = threading.Event()
        self._listener: _Listener | None = None
        self._thread = threading.Thread(target=self._accept, name="control", daemon=True)

    def __enter__(self) -> Control:
        try:
            self._listener = _Listener(self._registration)
        except (OSError, ValueError, RobolinkError) as error:  # ValueError: a folder whose name is not text
            self._controlled.say(f"no other shell can ask for the status, restart or stop: {error}")
        else:
            self._controlled.leavings += self._listener.files
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._listener is None:
            return
        self._closing.set()
        self._listener.close()
        with self._lock:
            for client in self._clients:
                with contextlib.suppress(OSError):
                    client.shutdown(socket.SHUT_RDWR)
        waits.join(self._thread, 1.0)
        for client in self._waiting_for_our_end:
            client.close()

    def _registration(self, address: str | int) -> Registration:
        now = clocks.time_of_day()
        return Registration(os.getpid(), self._name, self._file, address, self._key, now, self._nodes, self._domain)

    def _accept(self) -> None:
        assert self._listener is not None
        with contextlib.suppress(OSError, RobolinkError):
            clear_away()
        with self._listener.socket as listener:
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
            peer = Connection(client, self._key, clocks.monotonic() + self._patience)
            peer.greet()
            request = peer.hear()
            peer.answer(self._answer(request))
            stays = request.ask == "stop"  # the connection's end then tells the client of ours
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

    def _answer(self, request: Request) -> Response:
        supervisor = self._controlled
        if request.ask == "restart":
            return self._about(request.node, "restarted", supervisor.why_not_restarted, supervisor.restart)
        if request.ask == "stop_one":
            return self._about(request.node, "stopped", supervisor.why_not_stopped, supervisor.stop_one)
        if request.ask == "stop":
            supervisor.stop()
        return Response(nodes=list(supervisor.status()), members=self._members)

    def _about(self, name: str, done: str, why_not: Callable[[str], str], act: Callable[[str], object]) -> Response:
        """Act on one process, unless it does not exist or there is a reason why not; return the response."""
        names = [each.name for each in self._controlled.status()]
        if name not in names:
            return Response(error=f"no node named '{name}' in '{self._name}'{nearest(name, names)}")
        if reason := why_not(name):
            return Response(error=f"'{name}' of '{self._name}' is not {done}: {reason}")
        act(name)
        return Response()


def _as_text(name: str) -> str:
    """Return a file's name with a question mark for each byte that is not valid UTF-8: JSON has no other text."""
    return name.encode(errors="replace").decode()


class _Listener:
    """Listening socket and its registration. Raises OSError and `RuntimeFolderError`."""

    def __init__(self, registration: Callable[[str | int], Registration]) -> None:
        self._place = new_place(runtime_folder())
        self.files = files_at(self._place)
        self.socket, self._address = listen(str(self._place.with_suffix(".sock")))
        try:
            if AF_UNIX is not None:
                self._place.with_suffix(".sock").chmod(0o600)
            register(self._place, registration(self._address))
        except BaseException:
            self.socket.close()
            unregister(self._place)
            raise

    def close(self) -> None:
        """Unregister, and wake the thread that waits for a client by connecting: that works on every system."""
        try:
            connect(self._address, 0.5).close()
        except OSError:  # somebody removed the socket
            with contextlib.suppress(OSError):
                self.socket.shutdown(socket.SHUT_RDWR)
        unregister(self._place)
