"""Threads at the exit of a process with open sessions: none aborts it, whatever they are doing."""

from __future__ import annotations

import queue
import textwrap
import threading
import time
import weakref
from typing import Any

import pytest

from robolink.transport import lifetime
from robolink.transport.zenoh import ZenohTransport
from robolink.transport.zenoh_declare import Publishers
from robolink.transport.zenoh_handles import Holdings, ZenohOutlet
from tests.support.exits import PATIENCE, SESSIONS, program, run

LONG_END = """
import types

class Slow:
    sleep = staticmethod(time.sleep)
    def __del__(self):
        self.sleep(0.5)  # lets go of Python's lock where who takes it is ended

late = sys.modules["late"] = types.ModuleType("late")
late.slow = Slow()
"""


@pytest.mark.processes
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


@pytest.mark.processes
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


@pytest.mark.processes
@pytest.mark.parametrize("lines", [(0, 1), (1, 0)], ids=["opened first", "registered first"])
def test_what_a_program_does_at_its_exit_still_has_its_session(lines: tuple[int, int]) -> None:
    text = (
        'session = Session("a")',
        'atexit.register(lambda: setattr(session, "during", lambda: print("bye before", flush=True)))',
    )
    assert program("\n".join(["import atexit", *(text[at] for at in lines)])) == (0, ["bye before", "closed a"], "")


@pytest.mark.processes
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
    outlet = ZenohOutlet(Holdings(), "key", Publishers(used, asked, object))
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


@pytest.mark.processes
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
