"""View: the thread with the server's loop, its port, and the handshake of each connection."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import http
import logging
import secrets
import socket
import sys
import threading
import weakref
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import quote, urlsplit

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.protocol import State

from robolink.exceptions import RobolinkError
from robolink.system import clocks, waits
from robolink.view.channels import Source
from robolink.view.protocol.answers import SUBPROTOCOLS
from robolink.view.server.access import HEADERS, Access, Verdict, bracketed, find, is_any
from robolink.view.server.client import Client
from robolink.view.server.hub import MOST_CLIENTS, Hub
from robolink.view.server.learning import Exercises

if TYPE_CHECKING:
    from websockets.typing import Subprotocol

PORT = 8765
"""Default port: Foxglove's, so that its clients find the server by themselves."""

MOST_PORTS = 20
"""Ports that are tried, from the default one on, while they are in use."""

LARGEST_REQUEST = 16 * 2**20
"""Upper bound of one message of a client, in bytes."""

AT_ONCE = 500
"""Messages of one client that are worked on before the others get their turn."""

BUSY_FOR = 0.01
"""Time in seconds after which they get it, too; as long as the work took, the client then waits."""

SENT_AHEAD = 512 * 1024
"""Size of a connection's buffer in the system, in bytes: what is in there is too late to be replaced by newer."""

_BUSY = {errno.EADDRINUSE} | ({errno.EACCES} if sys.platform == "win32" else set())
"""Error numbers of a port that is in use, or that Windows keeps for itself: Hyper-V has whole ranges of them."""

STARTED_WITHIN = 10.0


class ViewError(RobolinkError, OSError):
    """The server cannot listen: its port is in use, or its address is none of this machine's."""


class Settings(NamedTuple):
    """Settings of a server."""

    host: str = "127.0.0.1"
    """Address to listen at."""
    port: int | None = None
    """Port; None takes the default one, or the next that is free; 0 any."""
    token: str = ""
    """Secret that lets a client change something; "" makes one."""
    read_only: bool = False
    """True if nobody may change anything."""


class View:
    """Server of the page and of Foxglove's protocol, on a thread of its own.

    Args:
        source: Where the messages come from.
        settings: Where it listens, and who may do what.
        exercises: Exercises for the page's panel `learn`; None for none.
    """

    def __init__(
        self,
        source: Source,
        settings: Settings = Settings(),  # noqa: B008 - it cannot change
        exercises: Exercises | None = None,
    ) -> None:
        self._source, self._host, self._port = source, settings.host, settings.port
        token = settings.token or secrets.token_urlsafe(18)
        self._access = Access(settings.host, 0, token, settings.read_only)
        self.hub = Hub(source, settings.host, secrets.token_hex(8), exercises, read_only=settings.read_only)
        """Its clients."""
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ready = threading.Event()
        self._error: BaseException | None = None
        self._end = asyncio.Event()
        self._is_closed = False
        self._connections: weakref.WeakSet[ServerConnection] = weakref.WeakSet()
        self._thread = threading.Thread(target=self._run, name="robolink view", daemon=True)

    def start(self) -> View:
        """Start, and return once clients can connect. Raises ViewError if it cannot listen."""
        self._thread.start()
        try:
            waits.wait(self._ready, STARTED_WITHIN)
        except BaseException:  # Ctrl-C: nobody else could close it
            self.close()
            raise
        if self._error is not None:
            raise self._error
        return self

    def close(self) -> None:
        """Stop what clients drive, and end. Safe to call twice."""
        self._is_closed = True  # before the look at the loop, which looks at it in turn once it is there
        loop = self._loop
        if loop is not None and self._thread.is_alive():
            with contextlib.suppress(RuntimeError):
                loop.call_soon_threadsafe(self._end.set)
        if self._thread.is_alive():
            waits.join(self._thread, 3.0)

    def __enter__(self) -> View:
        return self.start()

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def port(self) -> int:
        """Port that it listens at."""
        return self._access.port

    @property
    def token(self) -> str:
        """Secret that lets a client change something."""
        return self._access.token

    @property
    def exposed(self) -> bool:
        """True if others than this machine may reach it."""
        return self._access.exposed

    @property
    def address(self) -> str:
        """Address of the page, with the token."""
        host = "localhost" if is_any(self._host) else bracketed(self._host)
        return f"http://{host}:{self.port}/?token={quote(self.token, safe='')}"

    # The loop

    def _run(self) -> None:
        try:
            asyncio.run(self._main())
        except BaseException as error:  # noqa: BLE001 - raised by `start`
            self._error = error
        finally:
            self._ready.set()

    async def _main(self) -> None:
        self._loop = asyncio.get_running_loop()
        if self._is_closed:
            return
        server = await self._listen()
        try:
            self._access = self._access._replace(port=next(iter(server.sockets)).getsockname()[1])
            await self._show()
        finally:
            await self._close(server)

    async def _show(self) -> None:
        """Let clients see the source until the end."""
        try:
            self._source.begin(self.hub)
            self.hub.begin()
            ticking = asyncio.create_task(self.hub.run())
            self._ready.set()
            try:
                await self._end.wait()
            finally:
                self.hub.close()
                ticking.cancel()
        finally:
            self._source.close()

    async def _listen(self) -> Server:
        ports = [self._port] if self._port is not None else range(PORT, PORT + MOST_PORTS)
        for port in ports:
            try:
                return await self._listen_at(port)
            except OSError as error:
                if error.errno not in _BUSY:
                    why = error.strerror or str(error)
                    raise ViewError(f"cannot listen at {self._host} port {port}: {why}") from None
        if self._port is not None:
            raise ViewError(f"port {self._port} is in use: leave --port out, and the next free one is taken")
        raise ViewError(f"ports {PORT} to {PORT + MOST_PORTS - 1} are all in use: choose one by --port")

    async def _listen_at(self, port: int) -> Server:
        quiet = logging.Logger("robolink.view.websockets", logging.CRITICAL)

        def connected(*given: Any, **named: Any) -> ServerConnection:
            made = ServerConnection(*given, **named)
            self._connections.add(made)
            return made

        server: Server = await serve(
            self._serve,
            self._host,
            port,
            subprotocols=[*map(_subprotocol, SUBPROTOCOLS)],
            compression=None,
            process_request=self._answer,
            max_size=LARGEST_REQUEST,
            max_queue=2,
            ping_interval=5,
            ping_timeout=10,
            close_timeout=1,
            server_header=None,
            create_connection=connected,  # type: ignore[arg-type]
            logger=quiet,
        )
        return server

    async def _close(self, server: Server) -> None:
        """End all connections: browsers open some in advance that say nothing; a stalled page never answers."""
        server.close()
        for each in list(self._connections):
            if each.state is State.CONNECTING:
                _abort(each)
        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(server.wait_closed(), 1.0)
        for each in list(self._connections):
            _abort(each)
        await asyncio.sleep(0)  # in which what was aborted is closed

    # HTTP

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Answer a request of HTTP; None lets a WebSocket through."""
        headers = request.headers
        try:
            verdict = self._judge(request)
        except Exception:  # noqa: BLE001 - headers that come twice, and other nonsense
            return _response(http.HTTPStatus.BAD_REQUEST, "a request that cannot be read")
        if verdict.refusal:
            return _response(http.HTTPStatus.FORBIDDEN, verdict.refusal)
        connection.robolink_verdict = verdict  # type: ignore[attr-defined]
        if headers.get("Upgrade", "").lower() == "websocket":
            if len(self.hub.clients) >= MOST_CLIENTS:
                return _response(http.HTTPStatus.SERVICE_UNAVAILABLE, f"there are {MOST_CLIENTS} clients already")
            return None
        path = urlsplit(request.path).path
        if path == "/" and verdict.by_address:
            cookie = f"{self._access.cookie}={quote(self._access.token, safe='')}; HttpOnly; SameSite=Strict; Path=/"
            return _response(http.HTTPStatus.SEE_OTHER, "", {"Location": "/", "Set-Cookie": cookie})
        found = find(path)
        if found is None:
            return _response(http.HTTPStatus.NOT_FOUND, "there is no such file")
        return _response(http.HTTPStatus.OK, found.body, {"Content-Type": found.content_type})

    def _judge(self, request: Request) -> Verdict:
        headers = request.headers
        cookies = "; ".join(headers.get_all("Cookie"))
        return self._access.judge(request.path, headers.get("Host", ""), headers.get("Origin"), cookies)

    # WebSocket

    async def _serve(self, connection: ServerConnection) -> None:
        verdict: Verdict = connection.robolink_verdict  # type: ignore[attr-defined]
        _send_less_ahead(connection.transport)
        name = str(connection.remote_address)
        client = Client(self.hub, OpenWire(connection), str(connection.subprotocol), trusted=verdict.trusted, name=name)
        try:
            self.hub.join(client)
            await self._receive(connection, client)
        except ConnectionClosed:
            pass
        except Exception as error:  # noqa: BLE001 - no client may end the server
            self.hub.fail(error)
        finally:
            self.hub.part(client)

    async def _receive(self, connection: ServerConnection, client: Client) -> None:
        count, spent = 0, 0.0
        async for message in connection:
            begin = clocks.monotonic()
            client.receive(message)
            spent += clocks.monotonic() - begin
            count += 1
            if count >= AT_ONCE or spent > BUSY_FOR:  # a flood: what is read from memory never waits
                await asyncio.sleep(max(0.02 if count >= AT_ONCE else 0.0, spent))
                count, spent = 0, 0.0


class OpenWire:
    """Transport of a connection, until its closing handshake begins: after that only the library writes.

    Frames are written straight to the transport, which costs half of what the library's `send` does.
    """

    def __init__(self, connection: ServerConnection) -> None:
        self._connection, self._transport = connection, connection.transport
        self.write = self._transport.write
        self.get_write_buffer_size = self._transport.get_write_buffer_size
        self.abort = self._transport.abort

    def is_closing(self) -> bool:
        """True once nothing more can be sent."""
        return self._connection.state is not State.OPEN or self._transport.is_closing()


def _abort(connection: ServerConnection) -> None:
    with contextlib.suppress(AttributeError):  # accepted just now, and without a transport yet
        connection.transport.abort()


def _subprotocol(name: str) -> Subprotocol:
    from websockets.typing import Subprotocol

    return Subprotocol(name)


def _send_less_ahead(wire: asyncio.Transport) -> None:
    found: Any = wire.get_extra_info("socket")
    if found is not None:
        with contextlib.suppress(OSError):
            found.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SENT_AHEAD)


def _response(code: http.HTTPStatus, body: str | bytes, more: dict[str, str] | None = None) -> Response:
    raw = f"{body}\n".encode() if isinstance(body, str) else body
    given = {"Content-Type": "text/plain; charset=utf-8", "Content-Length": str(len(raw))} | HEADERS | (more or {})
    return Response(code.value, code.phrase, Headers(given), raw)
