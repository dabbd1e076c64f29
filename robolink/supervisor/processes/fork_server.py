"""Fork server: one process that imports once what many of a system's processes need, and is forked for each of them.

Thirty nodes on two cores spend most of their start on the same imports. So the supervisor may start one process that
does these, has no thread and no session, and is forked by request. Only Linux has what it takes for a process that was
forked elsewhere to become the supervisor's own child, which it waits for like any other (PR_SET_CHILD_SUBREAPER).
`ForkServer` is the supervisor's side, `serve` that of the server and of the processes that it becomes.

A request is a socket message: the length of what follows, the words and variables, and as file descriptors standard
input, output, the lifeline, and a pipe on which the new process waits for one byte, "go". Until that has come it ends
with its supervisor. The answer is its process id, 0 if it could not be forked.
"""

from __future__ import annotations

import contextlib
import json
import os
import selectors
import signal
import socket
import struct
import subprocess
import sys
import threading
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import IO, NamedTuple

from robolink.supervisor.processes.lifeline import VARIABLE, Lifeline
from robolink.system import clocks
from robolink.system.processes import Variables, set_environment

PATIENCE = 30.0
"""Longest wait for an answer, in seconds: the first comes when all is imported. Then processes start without it."""

PATIENCE_AT_END = 1.0
"""That wait once the user asks for the end, in seconds: a server that has been paused must not hold up a Ctrl-C."""

_SLICE = 0.1
"""Longest single wait for an answer, in seconds: no signal ends one, as it may be another thread that gets it."""

NOT_HERE = "processes are forked on Linux only"

TITLE_ROOM = 2000
"""Room for the command line that is shown of a forked process, in bytes."""

_PR_SET_CHILD_SUBREAPER = 36
_LENGTH, _PID = struct.Struct("<I"), struct.Struct("<q")
_DESCRIPTORS = 4
_DEFAULT_STANDARD = (0, 1, 2)


class ForkServerError(OSError):
    """The fork server does not serve; a process has to be started in the usual way."""


class Forked:
    """A process that was forked by the server: like a `Popen` of it, as far as a `Child` needs that."""

    def __init__(self, pid: int, stdout: IO[bytes]) -> None:
        self.pid = pid
        self.stdout = stdout

    def wait(self) -> int:
        """Wait for the process's end; return its exit code, -N after signal N."""
        return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])

    def send_signal(self, number: int) -> None:
        """Send a signal to the process."""
        os.kill(self.pid, number)

    def terminate(self) -> None:
        """Send SIGTERM to the process."""
        self.send_signal(signal.SIGTERM)


class ForkServer:
    """Supervisor's side: starts the server with the first process that is requested.

    Args:
        command: Command line whose processes it can become, such as `("python", "-m", "robolink")`; its own is this
            with `words`, a file descriptor and some padding behind.
        words: Words that make that command call `serve`.
        variables: Names of environment variables that it may set in a process. Others might be read while Python
            starts: a process with such is started in the usual way.
    """

    def __init__(self, command: Sequence[str], words: Sequence[str], variables: Collection[str] = ()) -> None:
        self._command, self._words, self._variables = list(command), list(words), frozenset(variables)
        self._process: subprocess.Popen[bytes] | None = None
        self._connection: socket.socket | None = None
        self._has_failed = sys.platform != "linux"
        self.is_end_requested: Callable[[], bool] = lambda: False
        """Set by the supervisor: returns True once the user asks for the end."""

    def can_become(self, argv: Sequence[str], env: Variables) -> bool:
        """True if a process with this command line, and these further variables, can be forked from the server."""
        begins = list(argv[: len(self._command)]) == self._command
        return begins and self._variables.issuperset(env) and not self._has_failed

    def fork(
        self, argv: Sequence[str], env: Variables, stdin: int, lifeline: Lifeline, whole_env: Mapping[str, str]
    ) -> Forked | None:
        """Start a process in a session of its own; None if the server cannot, now and from then on.

        `env` are its further variables, `whole_env` is the environment of the server, if it is started by this.
        """
        try:
            return self._fork(list(argv), dict(env), stdin, lifeline, whole_env)
        except OSError:
            self.close()
            self._has_failed = True
            return None

    def _fork(
        self, argv: list[str], env: dict[str, str | None], stdin: int, lifeline: Lifeline, whole_env: Mapping[str, str]
    ) -> Forked:
        if sys.platform != "linux":
            raise ForkServerError(NOT_HERE)
        connection = self._connection or self._begin(whole_env)
        request = json.dumps((argv, argv[len(self._command) :], env, lifeline.mark)).encode()
        (reading, stdout), (go, letting_go) = os.pipe(), os.pipe()
        try:
            pid = self._answer(connection, request, [stdin, stdout, lifeline.reading, go])
            if os.waitpid(pid, os.WNOHANG)[0]:  # an OSError if it has not become a child of ours
                raise ForkServerError("it has ended before it began")
            os.write(letting_go, b".")
        except BaseException:
            os.close(reading)
            raise
        finally:
            for each in (stdout, go, letting_go):
                os.close(each)
        return Forked(pid, os.fdopen(reading, "rb"))

    def _answer(self, connection: socket.socket, request: bytes, descriptors: Sequence[int]) -> int:
        """Send a request; return the id of the new process, which is a child of this one. Raises OSError."""
        if sys.platform != "linux":
            raise ForkServerError(NOT_HERE)
        connection.settimeout(PATIENCE)
        _adopt(True)
        try:
            socket.send_fds(connection, [_LENGTH.pack(len(request))], list(descriptors))
            connection.sendall(request)
            self._await(connection)
            (pid,) = _PID.unpack(_exactly(connection, _PID.size))
        finally:
            _adopt(False)
        if pid == 0:
            raise ForkServerError("the server could not fork")
        return int(pid)

    def _await(self, connection: socket.socket) -> None:
        """Wait until the server answers, or has gone; raises ForkServerError when that takes too long."""
        begun = clocks.monotonic()
        with selectors.DefaultSelector() as selector:
            selector.register(connection, selectors.EVENT_READ)
            while not selector.select(_SLICE):
                patience = PATIENCE_AT_END if self.is_end_requested() else PATIENCE
                if clocks.monotonic() - begun > patience:
                    raise ForkServerError("the server does not answer")

    def _begin(self, environ: Mapping[str, str]) -> socket.socket:
        ours, theirs = socket.socketpair()
        self._connection = ours
        with theirs:
            padding = "." * TITLE_ROOM
            self._process = subprocess.Popen(
                [*self._command, *self._words, str(theirs.fileno()), padding],
                env=environ,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                pass_fds=[theirs.fileno()],
                start_new_session=True,
            )
        return ours

    def close(self) -> None:
        """End the server; the processes that were forked from it go on."""
        connection, self._connection = self._connection, None
        process, self._process = self._process, None
        if connection is not None:
            connection.close()
        if process is not None:
            process.kill()
            process.wait()


def serve(descriptor: int) -> list[str]:
    """Fork this process for each request on a socket; return, in each of the new ones, its words behind the command.

    The server itself ends here, with its supervisor, or at once where copies of it would not be like new processes.
    """
    if sys.platform != "linux":
        raise ForkServerError(NOT_HERE)
    if not _is_fit_for_it():
        os._exit(1)
    # A Ctrl-C that the supervisor passes on waits until the new process watches its lifeline.
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    title, connection = ProcessTitle(), socket.socket(fileno=descriptor)
    own = sys.orig_argv
    title.write(own[:-1] if own[-1:] == ["." * TITLE_ROOM] else own)
    while True:
        try:
            header, descriptors, *_ = socket.recv_fds(connection, _LENGTH.size, _DESCRIPTORS)
            request = json.loads(_exactly(connection, _LENGTH.unpack(header)[0]))
        except (OSError, struct.error):  # the supervisor has gone
            os._exit(0)
        report = _forked()
        if report is None:
            connection.close()
            return _become(_Request(*request), descriptors, title)
        for each in descriptors:
            os.close(each)
        with contextlib.suppress(OSError):
            connection.sendall(_PID.pack(report))


class _Request(NamedTuple):
    argv: list[str]
    words: list[str]
    env: dict[str, str | None]
    mark: str


def _is_fit_for_it() -> bool:
    """False if the user's own start of Python (sitecustomize, .pth) has begun what a fork would break.

    Threads are not copied, but the locks that they hold are; and numpy's random numbers would be the same in all nodes.
    """
    try:
        threads = sum(1 for _ in Path("/proc/self/task").iterdir())
    except OSError:
        threads = threading.active_count()
    return threads == 1 and "numpy.random" not in sys.modules


def _forked() -> int | None:
    """Fork; return None in the new process, and its id, 0 for none, in the server, which is not its parent.

    The process in between ends at once, so that the new one becomes a child of the supervisor.
    """
    if sys.platform != "linux":
        raise ForkServerError(NOT_HERE)
    reading, writing = os.pipe()
    try:
        between = os.fork()
    except OSError:
        os.close(reading)
        os.close(writing)
        return 0
    if between:
        os.close(writing)
        os.waitpid(between, 0)
        answer = os.read(reading, _PID.size)
        os.close(reading)
        return int(_PID.unpack(answer)[0]) if answer else 0
    try:
        if os.fork():
            os._exit(0)
        os.close(reading)
        os.setsid()
        os.write(writing, _PID.pack(os.getpid()))
        os.close(writing)
    except BaseException:  # noqa: BLE001 - whatever it is, it must not go on as a second server
        os._exit(1)
    return None


def _become(request: _Request, descriptors: Sequence[int], title: ProcessTitle) -> list[str]:
    """Turn this new process into the requested one, once the supervisor lets it go."""
    stdin, stdout, lifeline, go = descriptors
    if not os.read(go, 1):
        os._exit(0)
    for standard, theirs in zip(_DEFAULT_STANDARD, (stdin, stdout, stdout), strict=True):
        os.dup2(theirs, standard)
    for each in {stdin, stdout, go} - {*_DEFAULT_STANDARD}:
        os.close(each)
    set_environment(request.env)
    os.environ[VARIABLE] = f"{lifeline}:{request.mark}"
    sys.orig_argv[:] = request.argv
    title.write(request.argv)
    return request.words


def _exactly(connection: socket.socket, size: int) -> bytes:
    data = b""
    while len(data) < size:
        more = connection.recv(size - len(data))
        if not more:
            raise ForkServerError("the other side has gone")
        data += more
    return data


def _adopt(is_on: bool) -> None:
    """Become, or be no more, the process to which orphans among this one's descendants are given. Raises OSError."""
    import ctypes

    if ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, ctypes.c_ulong(is_on), 0, 0, 0) != 0:
        raise ForkServerError("no orphans can be adopted here")


_BEGIN, _END = 48, 49
"""Fields of /proc/self/stat, counted from 1: the addresses of the command line's first byte and behind its last."""
_LEAST = 2
"""Smallest room that is written to, in bytes: one for the end of the text, and the last one."""


class ProcessTitle:
    """Room of this process's command line; `write` does nothing where the system does not say where that is."""

    def __init__(self) -> None:
        try:
            fields = Path("/proc/self/stat").read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
            first, end = (int(fields[number - 3]) for number in (_BEGIN, _END))  # the first behind ")" is number 3
        except (OSError, ValueError, IndexError):
            first = end = 0
        self._address, self._room = first, max(0, end - first)

    def write(self, words: Sequence[str]) -> None:
        """Show these words from now on; they are cut where the room ends."""
        if self._address == 0 or self._room < _LEAST:
            return
        import ctypes

        text = " ".join(words).encode(errors="surrogateescape").replace(b"\0", b" ")[: self._room - _LEAST]
        # A last byte that is not zero tells the kernel that this is one text, which ends at the first zero.
        ctypes.memmove(self._address, text.ljust(self._room - 1, b"\0") + b" ", self._room)
