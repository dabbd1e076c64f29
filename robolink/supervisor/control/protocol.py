"""JSON-lines protocol of the control socket, authenticated by a shared key (HMAC-SHA256).

The launcher begins with a nonce; then one line goes each way. A line is its HMAC in hexadecimal, a space, JSON. Every
wait ends at a deadline, and the length of a line is limited.
"""

from __future__ import annotations

import hmac
import os
import socket
import time
from typing import Any, Literal, TypeVar

import msgspec

from robolink.exceptions import RobolinkError
from robolink.supervisor.events import Status
from robolink.system import clocks

LONGEST_QUESTION = 1 << 16
LONGEST_ANSWER = 1 << 24
"""Longest answer, in bytes: far more than the states of ten thousand nodes."""
_NONCE = 32
_LATE = "no word in time"
_QUEUED = 64
"""Backlog of the listening socket: clients that may wait for their turn."""

StructT = TypeVar("StructT", bound=msgspec.Struct)

AF_UNIX: int | None = getattr(socket, "AF_UNIX", None)


class Request(msgspec.Struct, frozen=True):
    """Request to a launcher."""

    ask: Literal["status", "stop", "restart", "stop_one"]
    node: str = ""


class Response(msgspec.Struct, frozen=True):
    """Response: an error, or the state of its processes with the names of the nodes that share one."""

    error: str = ""
    nodes: list[Status] = []
    members: dict[str, list[str]] = {}


class ProtocolError(RobolinkError, ConnectionError):
    """The peer fails authentication, does not follow the protocol, or does not answer in time."""


class Connection:
    """One end of a connection, usable until `deadline` (of `clocks.monotonic`)."""

    def __init__(self, connection: socket.socket, key: str, deadline: float) -> None:
        self._socket = connection
        self._key = bytes.fromhex(key)
        self._deadline = deadline
        self._nonce = b""

    def greet(self) -> None:
        """Start the handshake as the server: send a nonce."""
        self._nonce = os.urandom(_NONCE // 2).hex().encode()
        self._send(self._nonce)

    def be_greeted(self) -> None:
        """Start the handshake as the client: receive the nonce."""
        self._nonce = self._receive(_NONCE)
        if len(self._nonce) != _NONCE:
            raise ProtocolError("no launcher listens there")

    def ask(self, request: Request) -> Response:
        """Send a request and return the response."""
        self._say(b"question", request)
        return self._hear(b"answer", LONGEST_ANSWER, Response)

    def hear(self) -> Request:
        """Receive and return the request."""
        return self._hear(b"question", LONGEST_QUESTION, Request)

    def answer(self, answer: Response) -> None:
        """Send the response."""
        self._say(b"answer", answer)

    def ends_within(self, seconds: float) -> bool:
        """Wait until the peer closes the connection or is gone; return True if it did in this time."""
        self._deadline = clocks.monotonic() + seconds
        try:
            self._receive(0)
        except TimeoutError:
            return False
        except (EOFError, OSError):
            return True
        return False

    def _say(self, what: bytes, value: msgspec.Struct) -> None:
        text = msgspec.json.encode(value)
        self._send(self._proof(what, text) + b" " + text)

    def _hear(self, what: bytes, longest: int, type_: type[StructT]) -> StructT:
        proof, _, text = self._receive(longest).partition(b" ")
        if not hmac.compare_digest(proof, self._proof(what, text)):
            raise ProtocolError("the other side does not know the key")
        try:
            return msgspec.json.decode(text, type=type_)
        except (msgspec.DecodeError, UnicodeDecodeError) as error:
            raise ProtocolError(f"another version of robolink speaks there: {error}") from None

    def _proof(self, what: bytes, text: bytes) -> bytes:
        return hmac.new(self._key, b" ".join((what, self._nonce, text)), "sha256").hexdigest().encode()

    def _send(self, line: bytes) -> None:
        self._socket.settimeout(self._left())
        self._socket.sendall(line + b"\n")

    def _receive(self, longest: int) -> bytes:
        """Return the next line without its newline; no peer sends two at once."""
        line = bytearray()
        while not line.endswith(b"\n"):
            part = self._received(min(longest + 1, 1 << 16))
            if not part:
                raise EOFError("the other side has gone")
            line += part
            if len(line) > longest + 1:
                raise ProtocolError(f"more than {longest} bytes at once")
        return bytes(line[:-1])

    def _received(self, most: int) -> bytes:
        self._socket.settimeout(self._left())
        try:
            return self._socket.recv(most)
        except TimeoutError:
            raise TimeoutError(_LATE) from None

    def _left(self) -> float:
        left = self._deadline - clocks.monotonic()
        if left <= 0:
            raise TimeoutError(_LATE)
        return left


def listen(place: str) -> tuple[socket.socket, str | int]:
    """Listen on a Unix socket at a path or, on Windows, on a free port of the loopback interface.

    Returns the socket and its address.
    """
    if AF_UNIX is not None:
        listener = socket.socket(AF_UNIX, socket.SOCK_STREAM)
        address: Any = place
    else:
        listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        exclusive = getattr(socket, "SO_EXCLUSIVEADDRUSE", None)
        if exclusive is not None:  # else another process of Windows could listen on the same port
            listener.setsockopt(socket.SOL_SOCKET, exclusive, 1)
        address = ("127.0.0.1", 0)
    try:
        listener.bind(address)
        listener.listen(_QUEUED)
    except BaseException:
        listener.close()
        raise
    return listener, place if AF_UNIX is not None else listener.getsockname()[1]


def connect(address: str | int, seconds: float) -> socket.socket:
    """Connect to a launcher; retries for `seconds` while its backlog is full.

    Raises ConnectionRefusedError or FileNotFoundError if nobody listens there, and OSError after `seconds`: macOS also
    refuses, and Linux says to try again, while too many others wait.
    """
    if isinstance(address, int):
        return socket.create_connection(("127.0.0.1", address), seconds)
    if AF_UNIX is None:
        raise FileNotFoundError(f"{address}: this system has no such sockets")
    connection = socket.socket(AF_UNIX, socket.SOCK_STREAM)
    deadline = clocks.monotonic() + seconds
    try:
        connection.settimeout(seconds)
        while not _is_connected(connection, address):
            if clocks.monotonic() >= deadline:
                raise TimeoutError(_LATE)
            time.sleep(0.02)
    except BaseException:
        connection.close()
        raise
    return connection


def _is_connected(connection: socket.socket, address: str) -> bool:
    """Connect; return False if the backlog is full."""
    try:
        connection.connect(address)
    except BlockingIOError:
        return False
    return True
