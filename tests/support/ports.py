"""TCP ports for tests: with a foreign listener, a Zenoh router, or nobody."""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import zenoh

PATIENCE = 30.0


@contextmanager
def stranger(port: int = 0, says: bytes | None = None, *, hears: bool = False) -> Iterator[int]:
    """Something that listens and is silent, or (having read, if `hears`) says this to the first and hangs up."""
    with socket.create_server(("127.0.0.1", port)) as server:
        server.settimeout(PATIENCE)

        def answer() -> None:
            with server.accept()[0] as connection:
                if hears:
                    connection.recv(65536)
                connection.sendall(says or b"")

        thread = threading.Thread(target=answer)
        if says is not None:
            thread.start()
        yield int(server.getsockname()[1])
        if says is not None:
            thread.join()


@contextmanager
def zenoh_router(port: int, host: str = "127.0.0.1") -> Iterator[str]:
    """A router as ROS 2's; its session id."""
    listen = {"mode": "router", "listen": {"endpoints": [f"tcp/{host}:{port}"]}}
    settings = listen | {"scouting": {"multicast": {"enabled": False}}}
    session: Any = zenoh.open(zenoh.Config.from_json5(json.dumps(settings)))
    try:
        yield str(session.info.zid())
    finally:
        session.close()


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return int(server.getsockname()[1])
