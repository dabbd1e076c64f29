"""Event loops that were closed in the middle of everything: their nodes end without an error, in any thread."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Any

import pytest

from robolink import Context
from robolink.experimental import AsyncNode
from robolink.interfaces.example_interfaces.msg import Int32
from robolink.interfaces.std_srvs.srv import Empty
from robolink.task import Future

pytestmark = pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")


def left_behind(context: Context, future: Future[int]) -> AsyncNode:
    """Return a node that runs, with callbacks, calls and sleeps under way, whose loop was closed."""
    made: list[AsyncNode] = []

    async def stays(*args: object) -> None:
        await asyncio.Event().wait()

    async def awaits() -> None:
        await future

    async def main() -> None:
        node = AsyncNode("node", context=context)
        made.append(node)
        node.create_timer(0.0, stays)
        node.create_subscription(Int32, "numbers", stays, 10)
        node.create_service(Empty, "empty", stays)
        client = node.create_client(Empty, "empty")
        work = [client.call(Empty.Request()), node.get_clock().sleep(100.0), awaits()]
        tasks = [asyncio.ensure_future(each) for each in work]  # noqa: F841 - asyncio keeps no strong reference
        await node.run()

    loop = asyncio.new_event_loop()
    loop.set_exception_handler(lambda loop, details: None)  # it tells of tasks that were left pending
    task = loop.create_task(main())
    loop.run_until_complete(asyncio.sleep(0.02))
    assert not task.done()
    loop.close()
    return made[0]


def in_this_thread(act: Callable[[], object]) -> None:
    act()


def in_another_thread(act: Callable[[], object]) -> None:
    errors: list[BaseException] = []

    def run() -> None:
        try:
            act()
        except BaseException as error:
            errors.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert not errors


@pytest.mark.parametrize("where", [in_this_thread, in_another_thread])
@pytest.mark.parametrize("end", ["node", "context", "entities"])
def test_what_is_left_of_a_node_is_destroyed_without_an_error(
    context: Context, where: Callable[[Callable[[], object]], None], end: str
) -> None:
    future: Future[int] = Future()
    node = left_behind(context, future)
    publisher = node.create_publisher(Int32, "numbers", 10)

    def act() -> None:
        publisher.publish(Int32())
        future.set_result(1)
        if end == "node":
            node.destroy_node()
        elif end == "context":
            context.shutdown()
        else:
            entities: list[Any] = [*node.clients, *node.services, *node.subscriptions, *node.timers]
            for each in entities:
                each.destroy()
            node.destroy_node()

    where(act)
    assert context.nodes == []
