"""How processes end that have sessions open: nothing is lost, nothing aborts, whatever breaks into it and whenever."""

from __future__ import annotations

import signal
import socket
import subprocess
import sys
import textwrap
import threading
import time
import weakref
from pathlib import Path
from typing import Any

import pytest

from robolink.exceptions import TransportClosedError
from robolink.transport import lifetime, zenoh
from robolink.transport.zenoh import ZenohTransport
from robolink.transport.zenoh_declare import Publishers
from robolink.transport.zenoh_handles import Holdings, Topic, ZenohOutlet
from tests.support.exits import PATIENCE, program, run

# --- signals at the exit --------------------------------------------------------------------------------------------


@pytest.mark.processes
@pytest.mark.parametrize("kind", ["default_int_handler", "SIG_IGN"])
def test_a_second_ctrl_c_does_not_break_into_what_the_exit_does(kind: str) -> None:
    text = f"""
        signal.signal(signal.SIGINT, signal.{kind})
        sessions = [Session(name, lambda: signal.raise_signal(signal.SIGINT)) for name in "abc"]
    """
    assert program(text) == (0, ["closed a", "closed b", "closed c"], "")


@pytest.mark.processes
def test_an_exit_in_another_thread_closes_too() -> None:
    """As in a Python that another program embeds."""
    text = """
        session = Session("a")
        thread = threading.Thread(target=lifetime.close_all)
        thread.start()
        thread.join()
    """
    assert program(text) == (0, ["closed a"], "")


@pytest.mark.processes
def test_nor_does_it_break_into_the_wait_for_what_still_closes() -> None:
    text = """
        def close():
            time.sleep(0.1)
            signal.raise_signal(signal.SIGINT)
            time.sleep(0.1)
            print("closed", flush=True)

        lifetime.watch_over(Session(""))
        thread = threading.Thread(target=close, daemon=True)
        lifetime.outlive(thread)
        thread.start()
    """
    assert program(text) == (0, ["closed"], "")


@pytest.mark.processes
def test_what_breaks_into_the_exit_before_does_not_keep_it_from_closing() -> None:
    text = """
        session = Session("a")
        threading._register_atexit(lambda: signal.raise_signal(signal.SIGINT))
    """
    code, said, complaint = program(text)
    assert (code, said) == (0, ["closed a"])
    assert "KeyboardInterrupt" in complaint


def test_a_thread_that_was_never_started_is_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """A Ctrl-C may come just before it is started."""
    monkeypatch.setattr(lifetime, "_unfinished", weakref.WeakSet[threading.Thread]())
    ended = threading.Thread(target=time.sleep, args=(0,))
    never = [threading.Thread() for _ in range(5)]
    for each in (*never, ended):
        lifetime.outlive(each)
    ended.start()
    lifetime._wait_for_the_unfinished(time.monotonic() + PATIENCE)
    assert not ended.is_alive()


def test_the_exit_waits_for_a_close_that_a_ctrl_c_broke_off(monkeypatch: pytest.MonkeyPatch) -> None:
    unfinished = weakref.WeakSet[threading.Thread]()
    monkeypatch.setattr(lifetime, "_unfinished", unfinished)
    may_end = threading.Event()

    def close() -> None:
        signal.raise_signal(signal.SIGINT)
        may_end.wait(PATIENCE)

    with pytest.raises(KeyboardInterrupt):
        lifetime.finish(close, 0.1)
    [thread] = unfinished
    assert thread.is_alive()
    may_end.set()
    lifetime._wait_for_the_unfinished(time.monotonic() + PATIENCE)
    assert not thread.is_alive()


def test_a_close_that_a_ctrl_c_broke_off_is_done_again(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    session = ZenohTransport(domain)

    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(zenoh, "leave", interrupted)
        with pytest.raises(KeyboardInterrupt):
            session.close()
    with pytest.raises(TransportClosedError):
        session.announce("a/token")
    assert session in lifetime._open
    assert not session.session.is_closed()
    session.close()
    assert session not in lifetime._open
    assert session.session.is_closed()


class InterruptedHoldings(Holdings):
    """Holdings in which a Ctrl-C comes while a publisher is being made."""

    def topic(self, key: str) -> Topic:
        raise KeyboardInterrupt


def test_a_session_has_no_half_made_handle_to_close() -> None:
    holdings = InterruptedHoldings()
    with pytest.raises(KeyboardInterrupt):
        ZenohOutlet(holdings, "key", Publishers(object(), object(), object))
    assert holdings.end("the end") == []


# --- an interrupt that Python loses ---------------------------------------------------------------------------------

LOSING = """
    import signal, time, weakref

    class Something:
        pass

    something = Something()
    reference = weakref.ref(something, lambda _: signal.raise_signal(signal.SIGINT))
    del something  # what is raised now reaches nobody
    while True:
        time.sleep(0.01)
"""


@pytest.mark.processes
def test_a_ctrl_c_that_python_loses_comes_again(tmp_path: Path) -> None:
    """As in the imports of 3.13, about one of 200 Ctrl-Cs of a command's start was lost."""
    node = tmp_path / "node.py"
    node.write_text(textwrap.dedent(LOSING))
    assert run("-m", "robolink", "run", str(node)) == (130, [], "")


@pytest.mark.processes
def test_other_errors_that_reach_nobody_are_told_as_ever(tmp_path: Path) -> None:
    node = tmp_path / "node.py"
    text = textwrap.dedent(LOSING).replace("signal.raise_signal(signal.SIGINT)", "1 / 0").partition("while")[0]
    node.write_text(text + "def main():\n    pass\n")
    code, said, complaint = run("-m", "robolink", "run", str(node))
    assert (code, said) == (0, [])
    assert complaint.startswith("Exception ignored")
    assert "ZeroDivisionError" in complaint


# --- threads that do not come back ----------------------------------------------------------------------------------


def test_a_ctrl_c_ends_the_wait_for_what_is_opened_and_it_is_closed_when_it_comes() -> None:
    may_open, closed = threading.Event(), threading.Event()

    def make() -> str:
        signal.raise_signal(signal.SIGINT)
        may_open.wait(PATIENCE)
        return "session"

    with pytest.raises(KeyboardInterrupt):
        lifetime.interruptible(make, lambda made: closed.set() if made == "session" else None)
    [thread] = [each for each in lifetime._opening if each.is_alive()]
    assert not closed.is_set()
    may_open.set()
    thread.join(PATIENCE)
    assert closed.is_set()


def test_what_is_opened_is_returned_and_errors_are_raised() -> None:
    def fails() -> None:
        raise OSError("no such network")

    closed: list[object] = []
    assert lifetime.interruptible(lambda: "session", closed.append) == "session"
    with pytest.raises(OSError, match="no such network"):
        lifetime.interruptible(fails, closed.append)
    assert closed == []


@pytest.mark.processes
def test_a_thread_that_stays_inside_zenoh_neither_holds_nor_changes_a_known_end() -> None:
    """Python would end it in Rust's midst, which aborts the process: FATAL: exception not rethrown."""
    text = """
        from robolink.system import exit_code
        lifetime.LAST_WAIT = 0.2
        thread = threading.Thread(target=lambda: time.sleep(60), daemon=True)
        lifetime.outlive(thread)
        thread.start()
        import atexit
        atexit._clear()
        atexit.register(lambda: print("Python would end now"))
        atexit.register(lifetime.close_all)
        exit_code.note(143)
        print("ending")
        sys.exit(0)
    """
    assert program(text) == (143, ["Python would end now", "ending"], "")


@pytest.mark.processes
@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM"])
def test_a_signal_that_nobody_catches_loses_nothing_of_open_files(tmp_path: Path, number: str) -> None:
    text = f"""
        from robolink.signals import install_signal_handlers
        kept = open({str(tmp_path / "kept")!r}, "w")

        def main():
            kept.write("not flushed")
            install_signal_handlers()
            signal.raise_signal(signal.{number})

        main()
    """
    code, *_ = program(text)
    assert code == 128 + getattr(signal, number)
    assert (tmp_path / "kept").read_text() == "not flushed"


@pytest.mark.processes
@pytest.mark.parametrize("streams", ["", "sys.stdout = None", "sys.stdout.close()"])
def test_nothing_is_lost_where_the_process_ends_before_python_has(tmp_path: Path, streams: str) -> None:
    text = f"""
        import atexit, pathlib, tempfile
        from robolink.system import exit_code
        folder = tempfile.TemporaryDirectory(dir={str(tmp_path)!r})
        kept = open({str(tmp_path / "kept")!r}, "w")
        kept.write("not flushed")
        lifetime.LAST_WAIT = 0.2
        thread = threading.Thread(target=lambda: time.sleep(60), daemon=True)
        lifetime.outlive(thread)
        thread.start()
        atexit._clear()
        atexit.register(folder.cleanup)
        atexit.register(pathlib.Path({str(tmp_path / "handled")!r}).touch)
        atexit.register(lifetime.close_all)
        exit_code.note(143)
        {streams}
    """
    assert program(text) == (143, [], "")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["handled", "kept"]
    assert (tmp_path / "kept").read_text() == "not flushed"


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to one process")
def test_a_ctrl_c_ends_a_client_whose_router_is_silent(tmp_path: Path) -> None:
    """Zenoh waits for its handshake, as long as its file says."""
    with socket.create_server(("127.0.0.1", 0)) as silent:
        network = tmp_path / "client.json5"
        place = f"tcp/127.0.0.1:{silent.getsockname()[1]}"
        network.write_text(
            f'{{mode: "client", connect: {{endpoints: ["{place}"], timeout_ms: -1}}, '
            "transport: {unicast: {open_timeout: 600000}}}"
        )
        command = [sys.executable, "-m", "robolink", "--network", str(network), "topic", "list"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            try:
                accepted, _ = silent.accept()
                process.send_signal(signal.SIGINT)
                with accepted:
                    out, err = process.communicate(timeout=PATIENCE)
            finally:
                process.kill()
    assert (process.returncode, out, err) == (130, "", "")
