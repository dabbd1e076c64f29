"""What `robolink topic pub` does."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.cli.session import node_of, opened, say
from robolink.exceptions import RobolinkError
from robolink.interfaces import find
from robolink.message import Message, encode, from_builtins
from robolink.task import Future
from robolink.yamlfile import parse

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.publisher import Publisher

MessageT = TypeVar("MessageT", bound=Message)

KEEP_ALIVE = 0.1
"""Seconds that the publisher stays after its last message, so that it arrives."""


LOWEST_RATE = 1e-9
"""Hz: a message in thirty years."""


class RateError(RobolinkError, ValueError):
    """A rate that is none."""


def run(topic: str, type_: str, values: str, *, rate: float, times: int, wait: int | None, print_every: int) -> None:
    """Publish `times` messages, 0 for no end, at `rate` Hz, once `wait` subscriptions are there."""
    if not LOWEST_RATE <= rate < float("inf"):
        raise RateError(f"--rate: expected a number of Hz above 0, got {rate:g}")
    msg_type = find(type_)
    message = message_of(msg_type, values)
    with opened() as context:
        node = node_of(context)
        publisher = node.create_publisher(msg_type, topic, 10)
        _wait(node, publisher, (1 if times else 0) if wait is None else wait)
        say("publisher: beginning loop")
        _loop(node, publisher, message, rate, times, print_every)


def message_of(msg_type: type[MessageT], values: str) -> MessageT:
    """Make a message of YAML. Raises DocumentError or EncodeError that say where, before anybody waits for it."""
    message: MessageT = from_builtins(msg_type, parse(values, name="<values>"))
    encode(message)
    return message


def _wait(node: Node, publisher: Publisher[Any], count: int) -> None:
    graph, context = node.context.graph, node.context
    while publisher.get_subscription_count() < count and context.ok():
        if not graph.wait_for(lambda: publisher.get_subscription_count() >= count or not context.ok(), 1.0):
            say(f"Waiting for at least {count} matching subscription(s)...")


def _loop(node: Node, publisher: Publisher[Any], message: Any, rate: float, times: int, print_every: int) -> None:
    from robolink.executors import SingleThreadedExecutor

    serial, done = itertools.count(1), Future[None]()

    def send() -> None:
        number = next(serial)
        if (number - 1) % print_every == 0:
            say(f"publishing #{number}: {message!r}\n")
        publisher.publish(message)
        if number == times:
            done.set_result(None)

    send()
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    if not done.done():
        node.create_timer(1.0 / rate, lambda: None if done.done() else send())
        executor.spin_until_future_complete(done)
    executor.spin_until_future_complete(Future(), timeout_sec=KEEP_ALIVE)
