"""Contexts: init, domain, arguments, shutdown and who is told."""

from __future__ import annotations

import gc
import threading

import pytest

from robolink import Context, Node, VirtualTime, logging
from robolink.arguments.command_line import UnknownROSArgsError
from robolink.context import ContextError
from robolink.exceptions import InvalidHandle, NotInitializedException
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32
from robolink.logging import LoggingSeverity
from robolink.transport.memory import Bus, MemoryTransport

PATIENCE = 30.0


def made() -> Context:
    return Context(transport=MemoryTransport(bus=Bus()))


@pytest.mark.processes
@pytest.mark.usefixtures("known_as_robolink")
def test_a_question_that_comes_after_the_end_is_told_so(domain: int) -> None:
    context = Context(transport="zenoh")
    context.init([], domain_id=domain)
    publisher = Node("node", context=context).create_publisher(Int32, "topic", 10)
    context.shutdown()
    with pytest.raises(
        InvalidHandle, match=r"the publisher of topic has been destroyed: robolink\.shutdown\(\) ends all"
    ):
        publisher.get_subscription_count()


def test_a_context_is_ok_between_init_and_shutdown() -> None:
    context = made()
    assert not context.ok()
    context.init([])
    assert context.ok()
    context.shutdown()
    assert not context.ok()
    context.try_shutdown()


def test_init_twice_and_shutdown_too_early_or_twice_are_refused() -> None:
    context = made()
    with pytest.raises(ContextError, match="must be initialized"):
        context.shutdown()
    context.init([])
    with pytest.raises(RuntimeError, match="only be called once"):
        context.init([])
    context.shutdown()
    with pytest.raises(RuntimeError, match="must be initialized"):
        context.shutdown()
    with pytest.raises(RuntimeError, match="only be called once"):
        context.init([])


def test_nothing_works_before_init() -> None:
    context = made()
    with pytest.raises(NotInitializedException):
        _ = context.transport
    with pytest.raises(NotInitializedException):
        context.get_domain_id()
    with pytest.raises(NotInitializedException):
        Node("node", context=context)


def test_the_domain_comes_from_the_argument_or_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "42")
    by_environment, by_argument = made(), made()
    by_environment.init([])
    by_argument.init([], domain_id=7)
    assert (by_environment.get_domain_id(), by_argument.get_domain_id()) == (42, 7)
    by_environment.shutdown()
    by_argument.shutdown()


@pytest.mark.parametrize(
    ("text", "argument", "expected"),
    [
        ("many", None, r"ROS_DOMAIN_ID.*0 to 232.*'many'"),
        ("233", None, "0 to 232, got 233"),
        ("0", -1, "lower than zero"),
        ("0", 300, "got 300"),
    ],
)
def test_an_impossible_domain_is_refused(
    monkeypatch: pytest.MonkeyPatch, text: str, argument: int | None, expected: str
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", text)
    context = made()
    with pytest.raises(ContextError, match=expected):
        context.init([], domain_id=argument)
    assert not context.ok()


def test_arguments_are_read(log_lines: list[Record]) -> None:
    context = made()
    context.init(["--ros-args", "--log-level", "chatty:=debug", "-r", "__node:=renamed"])
    assert logging.get_logger_level("chatty") is LoggingSeverity.DEBUG
    assert Node("node", context=context).get_name() == "renamed"
    context.shutdown()
    with pytest.raises(UnknownROSArgsError, match="--unknown"):
        made().init(["--ros-args", "--unknown"])


def test_all_are_told_of_the_end_once() -> None:
    context, told = made(), list[str]()

    class Listener:
        def hear(self) -> None:
            told.append("method")

    listener, gone = Listener(), Listener()
    context.init([])
    context.on_shutdown(lambda: told.append("function"))
    context.on_shutdown(listener.hear)
    context.on_shutdown(gone.hear)
    del gone
    gc.collect()
    context.shutdown()
    context.try_shutdown()
    assert told == ["function", "method"]
    with pytest.raises(TypeError, match="callable"):
        context.on_shutdown("text")  # type: ignore[arg-type] # what is tested


def test_the_end_destroys_nodes_and_their_tokens_vanish() -> None:
    bus = Bus()
    context = Context(transport=MemoryTransport(bus=bus))
    context.init([])
    Node("one", context=context)
    node = Node("two", context=context)
    node.create_subscription(Int32, "topic", lambda _: None, 10)
    assert len(bus.tokens) > 2
    context.shutdown()
    assert not bus.tokens
    assert list(node.subscriptions) == []
    node.destroy_node()


def test_an_interrupted_context_still_publishes(bus: Bus) -> None:
    other = Context(transport=MemoryTransport(bus=bus))
    other.init([])
    context = Context(transport=MemoryTransport(bus=bus))
    context.init([])
    got: list[Int32] = []
    subscription = Node("listener", context=other).create_subscription(Int32, "topic", got.append, 10)
    publisher = Node("talker", context=context).create_publisher(Int32, "topic", 10)
    context.interrupt()
    context.interrupt()
    assert not context.ok()
    assert context.interrupted
    publisher.publish(Int32(data=1))
    other.inbox.sweep()
    assert len(subscription.mailbox) == 1
    context.shutdown()
    other.shutdown()


def test_an_interrupt_may_come_while_its_own_thread_holds_any_lock() -> None:
    context, lock, told = made(), threading.Lock(), list[str]()
    context.init([])

    def on_end() -> None:
        with lock:
            told.append("end")

    context.on_shutdown(on_end)
    with lock:  # what the main thread is in the middle of when a signal comes
        context.interrupt()
    context.shutdown()
    assert told == ["end"]


def test_whoever_is_told_of_an_interrupt_may_end_the_context() -> None:
    context = made()
    context.init([])
    context.on_shutdown(context.try_shutdown)
    context.interrupt()
    context.try_shutdown()
    with pytest.raises(NotInitializedException):
        _ = context.transport


def test_two_threads_may_end_a_context() -> None:
    context, refused = made(), list[ContextError]()
    context.init([])
    for index in range(20):
        Node(f"node_{index}", context=context)

    def end() -> None:
        try:
            context.shutdown()
        except ContextError as error:
            refused.append(error)

    threads = [threading.Thread(target=end) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
    assert len(refused) == 3


def test_a_context_is_a_context_manager() -> None:
    with made() as context:
        assert context.ok()
    assert not context.ok()


def test_numbers_and_nodes_are_counted(context: Context) -> None:
    assert [context.next_id() for _ in range(3)] == ["0", "1", "2"]
    node = Node("node", context=context)
    assert context.nodes == [node]
    del node
    assert context.nodes == []  # without a collection


def test_logs_are_stamped_with_virtual_time(log_lines: list[Record]) -> None:
    context = Context(transport=MemoryTransport(bus=Bus()), time=VirtualTime(start=5))
    context.init([])
    context.time.sleep(10)
    logging.get_logger("node").info("hello")
    context.shutdown()
    logging.get_logger("node").info("later")
    assert log_lines[0].stamp_ns == 15
    assert log_lines[1].stamp_ns > 10**18


def test_nodes_are_destroyed_in_the_order_in_which_they_were_made() -> None:
    """What they still publish then belongs to a run that is the same each time."""
    destroyed: list[str] = []

    class Leaving(Node):
        def destroy_node(self) -> None:
            destroyed.append(self.get_name())
            super().destroy_node()

    context = Context(transport="memory://leaving")
    context.init([])
    nodes = [Leaving(f"node_{number}", context=context) for number in range(20)]
    nodes.pop(7).destroy_node()
    context.shutdown()
    assert destroyed == ["node_7", *(f"node_{number}" for number in range(20) if number != 7)]
