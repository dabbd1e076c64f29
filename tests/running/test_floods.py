"""Floods over Zenoh: each message is received in order, or counted, by each way of spinning; none is left behind."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from robolink import Context, Node
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.experimental import AsyncNode, EventsExecutor
from robolink.interfaces.std_msgs.msg import Int32
from tests.support.loops import run, until
from tests.support.transports import Network

BURSTS = (1, 40, 3, 9, 200, 1, 7, 12) * 4
"""Numbers of messages that are sent at once: more and less than a queue's depth, one after the other."""

DEPTH = 10
PATIENCE = 30.0


class Flood:
    """Publisher in a session of its own, and what a subscription has received of it."""

    def __init__(self, network: Network, stack: contextlib.ExitStack) -> None:
        self.contexts = [Context(transport=network.session()) for _ in range(2)]
        for each in self.contexts:
            each.init([])
            stack.enter_context(each)
        self._publisher = Node("sender", context=self.contexts[0]).create_publisher(Int32, "flood", DEPTH)
        self.got: list[int] = []
        self.sent = 0
        self.subscription: Any = None

    def subscribe(self, node: Any) -> None:
        """Let this node receive the flood."""
        self.subscription = node.create_subscription(
            Int32, "flood", lambda message: self.got.append(message.data), DEPTH
        )

    def bursts(self) -> Iterator[Callable[[], bool]]:
        """Send the bursts; yield for each what says that all of it was received or counted."""
        deadline = time.monotonic() + PATIENCE
        while not self._publisher.get_subscription_count() and time.monotonic() < deadline:
            time.sleep(0.001)
        for count in BURSTS:
            for _ in range(count):
                self._publisher.publish(Int32(data=self.sent))
                self.sent += 1
            yield self.is_complete

    def is_complete(self) -> bool:
        """True if the last message was received, and each before it, too, or counted."""
        counted = self.subscription.dropped + self.subscription.lost
        return bool(self.got) and self.got[-1] == self.sent - 1 and len(self.got) + counted == self.sent


@pytest.fixture
def flood(zenoh_net: Network) -> Iterator[Flood]:
    with contextlib.ExitStack() as stack:
        yield Flood(zenoh_net, stack)


def wait_for(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.0005)
    assert condition()


@pytest.mark.parametrize("executor_type", [SingleThreadedExecutor, MultiThreadedExecutor, EventsExecutor])
@pytest.mark.parametrize("spins", ["spin", "spin_once", "spin_some"])
def test_no_message_of_a_flood_is_left_behind(flood: Flood, executor_type: Any, spins: str) -> None:
    node = Node("receiver", context=flood.contexts[1])
    flood.subscribe(node)
    with executor_type(context=flood.contexts[1]) as executor:
        executor.add_node(node)
        ended = threading.Event()

        def spin() -> None:
            while not ended.is_set():
                executor.spin_once(timeout_sec=0.001 if spins == "spin_once" else 0)

        thread = threading.Thread(target=executor.spin if spins == "spin" else spin)
        thread.start()
        try:
            for is_complete in flood.bursts():
                wait_for(is_complete)
        finally:
            ended.set()
            executor.shutdown()
            thread.join()
    assert flood.got == sorted({*flood.got})


def test_no_message_of_a_flood_is_left_behind_on_an_event_loop(flood: Flood) -> None:
    async def main() -> None:
        async with AsyncNode("receiver", context=flood.contexts[1]) as node:
            flood.subscribe(node)
            for is_complete in flood.bursts():
                await until(is_complete)

    run(main())
    assert flood.got == sorted({*flood.got})
