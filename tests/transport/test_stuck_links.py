"""TCP connections that stand still: the kernel tells of them, and any answer says that packets pass again."""

from __future__ import annotations

import contextlib
import os
import socket
import struct
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.transport import addresses
from robolink.transport.addresses import PAUSE, Probes, Waiting, pause_of, waiting
from tests.support.transports import until

PLACES = ("10.77.0.1", 7447), ("10.77.0.2", 41668)


def answer(state: int = 1, timer: int = 1, tries: int = 5, kind: int = 20) -> bytes:
    """Return netlink's answer about a connection whose timer ends in ten seconds."""
    return struct.pack("=IHHII", 88, kind, 0, 0, 0) + struct.pack("=BBBB48xI", 2, state, timer, tries, 10_000)


def test_the_kernel_tells_of_connections_that_wait() -> None:
    assert pause_of(answer()) == 10.0
    assert pause_of(answer(timer=4)) == 10.0
    for other in (answer(state=4), answer(timer=2), answer(tries=2), answer(kind=2), answer()[:-5], b""):
        assert pause_of(other) is None


@given(st.binary(max_size=200))
def test_any_answer_of_the_kernels_is_understood(content: bytes) -> None:
    found = pause_of(content)
    assert found is None or found >= 0


@pytest.mark.skipif(sys.platform != "linux", reason="Linux is asked")
@pytest.mark.parametrize("host", ["127.0.0.1", "::1"])
def test_the_kernel_finds_a_connection_by_its_ends(host: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found = list[bytes]()
    monkeypatch.setattr(addresses, "pause_of", found.append)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with (
        socket.create_server((host, 0), family=family) as server,
        socket.create_connection(server.getsockname()[:2]) as end,
    ):
        here, there = end.getsockname()[:2], end.getpeername()[:2]
        assert waiting([(here, there), (there, ("no address", 0)), (here, (host, 1))]) == []
    connected, nobody = found
    assert struct.unpack_from("=HxxxxxxxxxxBB", connected, 4) == (20, family, 1)
    assert struct.unpack_from("=H", nobody, 4) == (2,)


def test_other_systems_are_not_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(addresses, "question", None)
    monkeypatch.setattr(sys, "platform", "darwin")
    assert waiting([PLACES]) == []


@pytest.mark.parametrize("listens", [True, False])
def test_an_answer_of_any_kind_says_that_packets_pass(listens: bool) -> None:
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        if listens:
            server.listen()
        probes, waits = Probes(), Waiting(("127.0.0.1", 1), server.getsockname(), PAUSE + 1)
        until(lambda: probes.passes([waits]))
        assert not probes.passes([])
        assert not probes.passes([waits._replace(pause=PAUSE)])
        probes.close()


def test_a_process_with_many_open_files_can_probe_too() -> None:
    resource = pytest.importorskip("resource", reason="Windows has other limits, and is not asked")
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard != resource.RLIM_INFINITY and hard < 1200:
        pytest.skip(f"this system allows {hard} open files")
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, 1200), hard))
    try:
        with contextlib.ExitStack() as files, socket.create_server(("127.0.0.1", 0)) as server:
            for _ in range(1100):
                files.enter_context(Path(os.devnull).open())
            probes, waits = Probes(), Waiting(("127.0.0.1", 1), server.getsockname(), PAUSE + 1)
            until(lambda: probes.passes([waits]))
            probes.close()
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
