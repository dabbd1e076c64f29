"""robolink doctor: who is on a port."""

from __future__ import annotations

import os
import sys
import time
from contextlib import ExitStack
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.cli.doctor import ports
from robolink.cli.doctor.ports import also_open_at, holder, owner
from robolink.networks import port_probe
from robolink.networks.port_probe import CLIENT, PEER, REFUSES, ROUTER, SILENT, STRANGER, Port, listening, read_answer
from tests.support.ports import PATIENCE, free_port, stranger, zenoh_router

OWN_USER: int = getattr(os, "getuid", int)()


@given(st.binary(max_size=80))
def test_any_answer_can_be_read(answer: bytes) -> None:
    role, session, complete = read_answer(answer)
    assert role in (
        SILENT,
        STRANGER,
        REFUSES,
        ROUTER,
        PEER,
        CLIENT,
    )
    assert bool(session) <= complete


@given(st.sampled_from(range(3)), st.binary(min_size=1, max_size=16), st.integers(0, 40))
def test_zenohs_answer_is_read_once_it_is_there(role: int, session: bytes, cut: int) -> None:
    body = bytes([0x61, 9, (len(session) - 1) << 4 | role]) + session + b"\x0a\x00\x20"
    answer = len(body).to_bytes(2, "little") + body
    known = 5 + len(session)
    found = read_answer(answer[:cut])
    if min(cut, len(answer)) < known:
        assert not found[2]
    else:
        assert found == (("router", "peer", "client")[role], f"{int.from_bytes(session, 'little'):x}", True)


def test_ports_are_told_apart_at_once() -> None:
    free, routers = free_port(), free_port()
    with ExitStack() as stack:
        silent = [stack.enter_context(stranger()) for _ in range(20)]
        chatty = stack.enter_context(stranger(says=b"SSH-2.0-OpenSSH_9.2\r\n"))
        session = stack.enter_context(zenoh_router(routers))
        begin = time.monotonic()
        found = listening([free, *silent, chatty, routers], within=0.5)
        assert time.monotonic() - begin < 5.0  # one after the other, the silent ones take 10 s
    assert found == {
        **{each: Port(each, SILENT) for each in silent},
        chatty: Port(chatty, STRANGER),
        routers: Port(routers, ROUTER, session),
    }


def test_a_stranger_that_hangs_up_is_a_stranger() -> None:
    with stranger(says=b"") as port:
        assert listening([port], within=PATIENCE)[port].role == STRANGER


def test_a_busy_machine_has_its_time_to_say_hello(monkeypatch: pytest.MonkeyPatch) -> None:
    """Saying hello to hundreds of ports may take longer than an answer may: no answer is missed by that."""

    class Late(port_probe._Greeting):
        def __init__(self, number: int, host: str) -> None:
            super().__init__(number, host)
            clock["now"] += 100.0

    clock = {"now": 0.0}
    monkeypatch.setattr(port_probe, "_Greeting", Late)
    monkeypatch.setattr(port_probe, "clocks", SimpleNamespace(monotonic=lambda: clock["now"]))
    with stranger(says=b"") as port:
        assert listening([port], within=PATIENCE)[port].role == STRANGER


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux says whose a port is")
def test_the_process_behind_a_port_is_found_on_linux() -> None:
    with stranger() as port:
        found = holder(port)
        assert found is not None
        assert Path(f"/proc/{found.pid}").samefile("/proc/self")
        assert found.command
    assert holder(free_port()) is None


def test_a_proc_that_cannot_be_read_says_nothing(tmp_path: Path) -> None:
    assert holder(17447, tmp_path) is None
    (tmp_path / "net").mkdir()
    (tmp_path / "net" / "tcp").write_text("header\n garbage\n 0: 0100007F:4427 00000000:0000 0A 0 0 0 0 0 4711\n")
    (tmp_path / "12" / "fd").mkdir(parents=True)
    assert holder(17447, tmp_path) is None


@pytest.mark.skipif(not ports._own_addresses(), reason="this machine has no address but the loopback's")
def test_a_router_that_other_machines_reach_is_told_from_one_that_they_do_not() -> None:
    for host, reached in (("127.0.0.1", False), ("0.0.0.0", True)):
        port = free_port()
        with zenoh_router(port, host):
            found = also_open_at(listening([port], PATIENCE)[port], within=5.0)
        assert bool(found) == reached
        assert set(found) <= set(ports._own_addresses())


def test_something_else_at_another_address_is_not_the_router(monkeypatch: pytest.MonkeyPatch) -> None:
    port = free_port()
    monkeypatch.setattr(ports, "_own_addresses", lambda: ["127.0.0.1", "no such host.invalid"])
    with zenoh_router(port) as session:
        assert also_open_at(Port(port, ROUTER, session), within=5.0) == ("127.0.0.1",)
        assert also_open_at(Port(port, ROUTER, "another"), within=5.0) == ()


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux says whose a port is")
@pytest.mark.parametrize(
    ("user", "named"), [(0, ""), (getattr(os, "getuid", int)(), ""), (4_000_000_000, "user 4000000000")]
)
def test_the_user_behind_a_port_is_named_unless_it_may_be_trusted(user: int, named: str, tmp_path: Path) -> None:
    (tmp_path / "net").mkdir()
    row = f" 0: 0100007F:1D17 00000000:0000 0A 0 0 0 {user} 0 4711"
    (tmp_path / "net" / "tcp").write_text(f"header\n{row}\n garbage\n")
    assert owner(7447, tmp_path) == named
    assert owner(7448, tmp_path) == ""
