"""Ctrl-C and SIGTERM: quiet ends, the right exit codes, and last words that still get through."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import robolink
from robolink import Context, Future, Node, signals
from robolink.exceptions import ExternalShutdownException, InterruptedByUser
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import String
from robolink.signals import SignalHandlerOptions
from tests.support.programs import Program
from tests.support.spins import spin_until

PATIENCE = 30.0


@pytest.fixture(autouse=True)
def _handlers() -> Iterator[None]:
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield
    signals.uninstall_signal_handlers()
    assert before == {number: signal.getsignal(number) for number in before}


@pytest.mark.parametrize("options", list(SignalHandlerOptions))
def test_handlers_are_installed_and_given_back(options: SignalHandlerOptions) -> None:
    before = signal.getsignal(signal.SIGINT)
    signals.install_signal_handlers(options)
    assert signals.get_current_signal_handlers_options() == options
    assert (signal.getsignal(signal.SIGINT) is not before) is bool(options & SignalHandlerOptions.SIGINT)
    signals.uninstall_signal_handlers()
    assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.NO


def test_a_ctrl_c_is_not_lost_while_they_are_given_back(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(number: int, handler: Any) -> None:
        signal.raise_signal(signal.SIGINT)

    signals.install_signal_handlers(SignalHandlerOptions.SIGINT)
    with monkeypatch.context() as patch:
        patch.setattr(signal, "signal", interrupted)
        with pytest.raises(KeyboardInterrupt):
            signals.uninstall_signal_handlers()


def test_only_the_main_thread_can() -> None:
    thread = threading.Thread(target=signals.install_signal_handlers)
    thread.start()
    thread.join(PATIENCE)
    assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.NO


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_the_spin(context: Context, number: int) -> None:
    signals.install_signal_handlers()
    node = Node("node", context=context)

    def interrupt() -> None:
        timer.cancel()  # a second signal is another matter
        signal.raise_signal(number)

    timer = node.create_timer(0.005, interrupt)
    with SingleThreadedExecutor(context=context) as executor:
        executor.add_node(node)
        with pytest.raises(ExternalShutdownException) as first:
            executor.spin()
        assert not context.ok()
        with pytest.raises(ExternalShutdownException) as second:
            executor.spin()
        assert (
            first.type is second.type is (InterruptedByUser if number == signal.SIGINT else ExternalShutdownException)
        )
        with pytest.raises(ExternalShutdownException):
            executor.spin_once()


@pytest.mark.parametrize("spin", ["spin", "spin_once", "spin_until_future_complete", "spin_once_until_future_complete"])
def test_sigterm_is_not_a_ctrl_c_whatever_spins(context: Context, spin: str) -> None:
    signals.install_signal_handlers()
    thread = threading.Timer(0.05, signal.raise_signal, [signal.SIGTERM])
    with SingleThreadedExecutor(context=context) as executor:
        thread.start()
        with pytest.raises(ExternalShutdownException) as met:
            getattr(executor, spin)(*([Future[None]()] if "future" in spin else []))
        thread.join(PATIENCE)
    assert met.type is ExternalShutdownException


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_sigterm_lets_a_multi_threaded_spin_return(context: Context, number: int) -> None:
    signals.install_signal_handlers()
    thread = threading.Timer(0.05, signal.raise_signal, [number])
    with MultiThreadedExecutor(2, context=context) as executor:
        thread.start()
        with pytest.raises(InterruptedByUser) if number == signal.SIGINT else contextlib.nullcontext():
            executor.spin()
        thread.join(PATIENCE)
    assert not context.ok()


def test_only_the_main_thread_meets_a_keyboard_interrupt(context: Context) -> None:
    met: list[BaseException] = []

    def spin() -> None:
        try:
            executor.spin()
        except BaseException as error:
            met.append(error)

    node = Node("node", context=context)
    node.create_timer(0.005, context.interrupt)
    with SingleThreadedExecutor(context=context) as executor:
        executor.add_node(node)
        thread = threading.Thread(target=spin)
        thread.start()
        thread.join(PATIENCE)
    assert [type(each) for each in met] == [ExternalShutdownException]


def test_a_programs_own_handler_is_called_too(context: Context) -> None:
    called: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: called.append(number))
    try:
        signals.install_signal_handlers()
        signal.raise_signal(signal.SIGINT)
        assert called == [signal.SIGINT]
        assert not context.ok()
        signals.uninstall_signal_handlers()
    finally:
        signal.signal(signal.SIGINT, before)


def test_init_installs_them_for_the_default_context_only(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://")
    robolink.init(args=[], context=Context())
    assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.NO
    robolink.init(args=[])
    assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.ALL
    robolink.shutdown()
    assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.NO


HEAD = """
    import sys, threading, time
    import robolink as rclpy
    from robolink.exceptions import ExternalShutdownException
    from robolink.interfaces.std_msgs.msg import String
    from robolink.node import Node

    class Talker(Node):
        def __init__(self):
            super().__init__("talker")
            self.publisher = self.create_publisher(String, "words", 10)
            self.create_timer(0.01, self.tick)
            self.ticks = 0

        def tick(self):
            self.ticks += 1
            if self.ticks == 2:
                print("spinning")
"""

TUTORIAL = """
    def main():
        rclpy.init()
        node = Talker()
        rclpy.spin(node)
        node.destroy_node()
        rclpy.shutdown()

    main()
"""

CAREFUL = """
    def main():
        rclpy.init()
        node = Talker()
        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            node.publisher.publish(String(data="last words"))
        finally:
            node.destroy_node()
            rclpy.try_shutdown()

    main()
"""

MANAGED = """
    try:
        with rclpy.init():
            rclpy.spin(Talker())
    except KeyboardInterrupt:
        sys.exit(3)
"""

THREAD = """
    rclpy.init()
    node = Talker()
    threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
    rate = node.create_rate(100)
    while rclpy.ok():
        rate.sleep()
"""

DEAF = """
    rclpy.init()
    print("spinning")
    while True:
        time.sleep(0.02)  # not for long: Python may notice a signal late that comes just before a sleep begins
"""

LONELY = """
    rclpy.init()
    rate = Talker().create_rate(1.0)
    try:
        print("spinning")
        while rclpy.ok():
            rate.sleep()
        sys.exit(3)
    except KeyboardInterrupt:
        sys.exit(3)
"""

IN_A_CALLBACK = """
    from robolink.callback_groups import MutuallyExclusiveCallbackGroup
    from robolink.executors import MultiThreadedExecutor

    def sleep():
        while True:
            rate.sleep()

    rclpy.init()
    node = Talker()
    rate = node.create_rate(100)
    for _ in range(2):
        node.create_timer(0.01, sleep, callback_group=MutuallyExclusiveCallbackGroup())  # sleeps once: threads are left
    executor = MultiThreadedExecutor(4)
    executor.add_node(node)
    try:
        executor.spin()
    except KeyboardInterrupt:
        sys.exit(3)
"""

BROKEN = """
    rclpy.init()
    node = Talker()
    node.create_timer(0.01, lambda: 1 // 0)
    rclpy.spin(node)
"""


@pytest.mark.processes
@pytest.mark.parametrize(
    ("body", "end", "code"),
    [
        (TUTORIAL, Program.interrupt, 130),
        (TUTORIAL, Program.terminate, 143),
        (CAREFUL, Program.interrupt, 0),
        (CAREFUL, Program.terminate, 0),
        (MANAGED, Program.interrupt, 3),
        (THREAD, Program.interrupt, 130),
        (THREAD, Program.terminate, 143),
        (DEAF, Program.terminate, 143),
        (LONELY, Program.interrupt, 3),
        (LONELY, Program.terminate, 3),
        (IN_A_CALLBACK, Program.interrupt, 3),
        (IN_A_CALLBACK, Program.terminate, 0),  # the spinning returns
    ],
    ids=[
        "tutorial-int",
        "tutorial-term",
        "careful-int",
        "careful-term",
        "managed",
        "thread-int",
        "thread-term",
        "deaf",
        "lonely-int",
        "lonely-term",
        "in-a-callback-int",
        "in-a-callback-term",
    ],
)
def test_a_program_ends_quietly(
    tmp_path: Path, domain: int, body: str, end: Callable[[Program], None], code: int
) -> None:
    with Program(tmp_path, HEAD + body, domain) as program:
        assert program.line() == "spinning"
        end(program)
        assert (program.end(), program.errors) == (code, [])


STUBBORN = """
    rclpy.init()
    node = Talker()
    while True:
        try:
            rclpy.spin_once(node, timeout_sec=0.02)
        except Exception as error:
            print(error)
"""


@pytest.mark.processes
def test_ctrl_c_passes_what_catches_every_exception(tmp_path: Path, domain: int) -> None:
    with Program(tmp_path, HEAD + STUBBORN, domain) as program:
        assert program.line() == "spinning"
        program.interrupt()
        assert (program.end(), program.errors) == (130, [])


@pytest.mark.processes
def test_other_errors_are_shown_as_ever(tmp_path: Path, domain: int) -> None:
    with Program(tmp_path, HEAD + BROKEN, domain) as program:
        assert program.end() == 1
        assert program.errors[-1].startswith("ZeroDivisionError")


MISSPELT = """
    rclpy.init()
    node = Talker()
    node.create_timer(0.01, lambda: String(dta="x"))
    rclpy.spin(node)
"""


@pytest.mark.processes
def test_a_misspelt_field_is_shown_with_the_nearest(tmp_path: Path, domain: int) -> None:
    with Program(tmp_path, HEAD + MISSPELT, domain) as program:
        assert program.end() == 1
        assert program.errors[-1] == "TypeError: Unexpected keyword argument 'dta'. Did you mean: 'data'?"


@pytest.mark.processes
def test_last_words_get_through(tmp_path: Path, domain: int) -> None:
    context = Context()
    context.init([], domain_id=domain)
    with context, SingleThreadedExecutor(context=context) as executor:
        node, got = Node("ear", context=context), list[str]()
        node.create_subscription(String, "words", lambda message: got.append(message.data), 10)
        executor.add_node(node)
        heard = HEAD.replace("self.ticks == 2", "self.publisher.get_subscription_count() > 0")
        with Program(tmp_path, heard + CAREFUL, domain) as program:
            assert program.line() == "spinning"
            program.interrupt()
            assert program.end() == 0
        spin_until(executor, lambda: bool(got))
    assert got == ["last words"]
