"""A server whose start comes to nothing leaves no port open and no thread behind."""

from __future__ import annotations

import socket
import threading

import pytest

from robolink.exceptions import NotInitializedException
from robolink.system import waits
from robolink.view.server import Settings, View
from tests.support.ports import free_port
from tests.support.view_clients import WITHIN, Shown

CONTROL_C = KeyboardInterrupt("Ctrl-C")


def is_open(port: int) -> bool:
    """Return whether somebody listens; nobody is connected to, whom a server that ends at once would have to let go."""
    with socket.socket() as own:
        try:
            own.bind(("127.0.0.1", port))
        except OSError:
            return True
    return False


@pytest.mark.parametrize("listens", [False, True], ids=["at once", "once it listens"])
def test_ctrl_c_while_it_starts_ends_it(listens: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    port = free_port()
    system = Shown(port=port)
    view, begin, may_begin = system.view, system.view._main, threading.Event()
    wait, join = waits.wait, waits.join

    async def late() -> None:
        assert may_begin.wait(WITHIN)
        await begin()

    def interrupted(event: threading.Event, seconds: float | None = None) -> bool:
        if event is not view._ready:
            return wait(event, seconds)
        if listens:
            may_begin.set()
            assert event.wait(WITHIN)
            assert is_open(port)
        raise CONTROL_C

    def joined(thread: threading.Thread, seconds: float | None = None) -> bool:
        may_begin.set()
        return join(thread, seconds)

    monkeypatch.setattr(view, "_main", late)
    monkeypatch.setattr(waits, "wait", interrupted)
    monkeypatch.setattr(waits, "join", joined)
    with pytest.raises(KeyboardInterrupt, match="Ctrl-C"):
        view.start()
    assert not view._thread.is_alive()
    assert not is_open(port)
    system.source.context.shutdown()
    system.context.shutdown()


def test_a_source_that_has_ended_before_it_began_leaves_no_port_open() -> None:
    system = Shown()
    system.source.context.shutdown()
    port = free_port()
    with pytest.raises(NotInitializedException):
        View(system.source, Settings(port=port)).start()
    assert not is_open(port)
    system.context.shutdown()
