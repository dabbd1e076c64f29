"""How processes end that have sessions open: nothing is lost, nothing aborts, whatever breaks into it and whenever."""

from __future__ import annotations

import os
import queue
import signal
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

PATIENCE = 30.0

SESSIONS = """
import signal, sys, threading, time
from robolink.transport import lifetime

class Session:
    def __init__(self, name, during=lambda: None):
        self.name, self.during = name, during
        lifetime.watch_over(self)

    def close(self):
        lifetime.forget(self)
        self.during()
        print("closed", self.name, flush=True)

"""
LONG_END = """
import types

class Slow:
    sleep = staticmethod(time.sleep)
    def __del__(self):
        self.sleep(0.5)  # lets go of Python's lock where who takes it is ended

late = sys.modules["late"] = types.ModuleType("late")
late.slow = Slow()
"""


def run(*arguments: str, environ: dict[str, str] | None = None) -> tuple[int, list[str], str]:
    """Run Python: the exit code, the lines that it printed, sorted, and what it complained of."""
    environ = {**os.environ, **(environ or {})}
    done = subprocess.run(
        [sys.executable, *arguments], env=environ, capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    return done.returncode, sorted(done.stdout.split("\n")[:-1]), done.stderr


def program(text: str) -> tuple[int, list[str], str]:
    return run("-c", SESSIONS + textwrap.dedent(text))


# --- signals at the exit --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["default_int_handler", "SIG_IGN"])
def test_a_second_ctrl_c_does_not_break_into_what_the_exit_does(kind: str) -> None:
    text = f"""
        signal.signal(signal.SIGINT, signal.{kind})
        sessions = [Session(name, lambda: signal.raise_signal(signal.SIGINT)) for name in "abc"]
    """
    assert program(text) == (0, ["closed a", "closed b", "closed c"], "")


def test_an_exit_in_another_thread_closes_too() -> None:
    """As in a Python that another program embeds."""
    text = """
        session = Session("a")
        thread = threading.Thread(target=lifetime.close_all)
        thread.start()
        thread.join()
    """
    assert program(text) == (0, ["closed a"], "")


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
        patch.setattr(zenoh, "_leave", interrupted)
        with pytest.raises(KeyboardInterrupt):
            session.close()
    with pytest.raises(TransportClosedError):
        session.announce("a/token")
    assert session in lifetime._open
    assert not session._session.is_closed()
    session.close()
    assert session not in lifetime._open
    assert session._session.is_closed()


class InterruptedHoldings(Holdings):
    """Holdings in which a Ctrl-C comes while a publisher is being made."""

    def topic(self, key: str) -> Topic:
        raise KeyboardInterrupt


def test_a_session_has_no_half_made_handle_to_close() -> None:
    holdings = InterruptedHoldings()
    with pytest.raises(KeyboardInterrupt):
        ZenohOutlet(holdings, "key", Publishers(object(), object()))
    assert holdings.end("the end") == []


# --- threads at the exit --------------------------------------------------------------------------------------------


def test_what_goes_on_in_a_thread_keeps_its_session_when_the_main_thread_ends() -> None:
    text = """
        def work():
            while threading.main_thread().is_alive():
                time.sleep(0.001)
            print("after the main thread", flush=True)
            session.during = lambda: print("and then", flush=True)

        session = Session("a")
        threading.Thread(target=work).start()
    """
    assert program(text) == (0, ["after the main thread", "and then", "closed a"], "")


def test_a_multi_threaded_executor_goes_on_when_the_main_thread_ends() -> None:
    """In rclpy its thread dies of an error then; here it would drop one callback after the other, for ever."""
    text = """
        from robolink import Context, Node
        from robolink.callback_groups import ReentrantCallbackGroup
        from robolink.executors import MultiThreadedExecutor
        from robolink.interfaces.std_srvs.srv import Trigger
        from robolink.transport.memory import MemoryTransport

        def tick():
            if not threading.main_thread().is_alive():
                print(client.call(Trigger.Request(), timeout_sec=30.0), flush=True)
                context.shutdown()

        context = Context(transport=MemoryTransport())
        context.init()
        node = Node("node", context=context)
        group = ReentrantCallbackGroup()
        node.create_service(Trigger, "go", lambda request, response: response, callback_group=group)
        client = node.create_client(Trigger, "go", callback_group=group)
        node.create_timer(0.001, tick, callback_group=group)
        executor = MultiThreadedExecutor(context=context)
        executor.add_node(node)
        threading.Thread(target=executor.spin).start()
    """
    code, [answer], complaints = program(text)
    assert (code, complaints) == (0, "")
    assert "Trigger_Response" in answer


@pytest.mark.parametrize("lines", [(0, 1), (1, 0)], ids=["opened first", "registered first"])
def test_what_a_program_does_at_its_exit_still_has_its_session(lines: tuple[int, int]) -> None:
    text = (
        'session = Session("a")',
        'atexit.register(lambda: setattr(session, "during", lambda: print("bye before", flush=True)))',
    )
    assert program("\n".join(["import atexit", *(text[at] for at in lines)])) == (0, ["bye before", "closed a"], "")


def test_the_exit_waits_once_for_what_does_not_end() -> None:
    text = """
        class Endless(threading.Thread):
            def join(self, timeout=None):
                print("waits" if timeout else "looks", flush=True)
                super().join(timeout)

        lifetime.LAST_WAIT = 0.1
        thread = Endless(target=threading.Event().wait, daemon=True)
        lifetime.outlive(thread)
        thread.start()
    """
    assert program(text) == (0, ["looks", "waits"], "")


class Entity:
    """Something of Zenoh's."""

    def undeclare(self) -> None:
        """Be gone."""


def test_a_daemon_thread_that_the_exit_ends_frees_nothing_of_zenohs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Freeing it is work in Zenoh: about one of 50 programs was aborted whose threads closed what they had declared."""
    used, asked = Entity(), Entity()
    outlet = ZenohOutlet(Holdings(), "key", Publishers(used, asked))
    left = [weakref.ref(used), weakref.ref(asked)]
    del used, asked
    monkeypatch.setattr(lifetime, "_ending", True)
    monkeypatch.setattr(lifetime, "_last", [])

    def work() -> None:
        with pytest.raises(SystemExit):
            outlet.close()

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    thread.join(PATIENCE)
    assert all(each() is not None for each in left)


def test_calls_that_the_exit_ends_are_not_told_that_nobody_answers(
    domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A thread that spins would warn of it, when the program is over and all is well."""
    asked, arrived = queue.SimpleQueue[Any](), queue.SimpleQueue[Any]()
    session = ZenohTransport(domain)
    session.serve("a/service", asked.put)
    session.call("a/service", b"", b"", arrived.put)
    query = asked.get(timeout=PATIENCE)
    assert len(session._ends) == 1
    monkeypatch.setattr(lifetime, "_ending", True)
    session.close()
    deadline = time.monotonic() + PATIENCE
    while session._ends and time.monotonic() < deadline:  # until Zenoh has let go of it
        time.sleep(0.001)
    assert not session._ends
    assert arrived.empty()
    del query


def test_the_exit_waits_for_a_daemon_thread_that_opens_a_session_and_closes_it() -> None:
    text = """
        import atexit
        is_exiting, is_inside = threading.Event(), threading.Event()

        def work():
            global late
            with lifetime.inside:
                is_inside.set()
                is_exiting.wait()
                time.sleep(0.2)
                late = Session("late")

        session = Session("early")
        atexit.register(is_exiting.set)
        threading.Thread(target=work, daemon=True).start()
        is_inside.wait()
    """
    assert program(text) == (0, ["closed early", "closed late"], "")


BUSY = {
    "opens": """
        session = ZenohTransport(domain)
        session.tokens("@ros2_lv/0/**")
        session.close()
    """,
    "publishes": """
        outlet.put(bytes(1000), b"")
    """,
    "declares": """
        everything.subscribe(key, latched, arrived.put).close()
        everything.advertise(key, latched).close()
        everything.watch("@ros2_lv/0/**", lambda token, alive: None).close()
    """,
    "calls": """
        everything.call("a/service", b"", b"", arrived.put)
    """,
}


@pytest.mark.processes
@pytest.mark.parametrize("does", BUSY)
def test_daemon_threads_that_use_zenoh_neither_abort_the_exit_nor_complain(domain: int, does: str) -> None:
    text = f"""
import queue
from robolink.qos import QoSProfile
from robolink.transport.zenoh import ZenohTransport

domain, key, arrived = {domain}, "0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported", queue.SimpleQueue()
plain, latched = QoSProfile(depth=10), QoSProfile(depth=1, durability=1)
everything = ZenohTransport(domain)
everything.serve("a/service", arrived.put)
outlet = everything.advertise(key, plain)
rounds = queue.SimpleQueue()

def work():
    while True:
{textwrap.indent(textwrap.dedent(BUSY[does]), " " * 8)}
        rounds.put(None)

for _ in range(2):
    threading.Thread(target=work, daemon=True).start()
for _ in range(3):
    rounds.get(timeout=30)
"""
    assert run("-c", SESSIONS + LONG_END + text) == (0, [], "")


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


def test_a_ctrl_c_that_python_loses_comes_again(tmp_path: Path) -> None:
    """As in the imports of 3.13, about one of 200 Ctrl-Cs of a command's start was lost."""
    node = tmp_path / "node.py"
    node.write_text(textwrap.dedent(LOSING))
    assert run("-m", "robolink", "run", str(node)) == (130, [], "")


def test_other_errors_that_reach_nobody_are_told_as_ever(tmp_path: Path) -> None:
    node = tmp_path / "node.py"
    text = textwrap.dedent(LOSING).replace("signal.raise_signal(signal.SIGINT)", "1 / 0").partition("while")[0]
    node.write_text(text + "def main():\n    pass\n")
    code, said, complaint = run("-m", "robolink", "run", str(node))
    assert (code, said) == (0, [])
    assert complaint.startswith("Exception ignored in")
    assert "ZeroDivisionError" in complaint
