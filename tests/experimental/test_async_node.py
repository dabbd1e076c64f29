"""Nodes on asyncio's event loop: how they begin and end, and what goes wrong in between."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

import robolink
from robolink import Context
from robolink.exceptions import InvalidHandle
from robolink.executors import SingleThreadedExecutor
from robolink.experimental import AsyncNode
from robolink.experimental.groups import TaskGroup
from robolink.interfaces.example_interfaces.msg import Int32
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from tests.support.loops import run, until


def numbered(groups: BaseException) -> list[str]:
    """Return the texts of the exceptions in a group."""
    return [str(each) for each in groups.exceptions]  # type: ignore[attr-defined]


def test_messages_calls_and_timers_come_by_the_event_loop(context: Context) -> None:
    async def serve(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        await asyncio.sleep(0)
        response.success = not request.data
        return response

    async def main() -> tuple[list[int], bool, int]:
        got: list[int] = []
        async with AsyncNode("one", context=context) as one, AsyncNode("two", context=context) as two:
            two.create_subscription(Int32, "number", lambda message: got.append(message.data), 10)
            two.create_service(SetBool, "invert", serve)
            publisher, client = one.create_publisher(Int32, "number", 10), one.create_client(SetBool, "invert")
            ticks: list[None] = []
            one.create_timer(0.001, lambda: ticks.append(None))
            await client.wait_for_service()
            publisher.publish(Int32(data=3))
            answer = await client.call(SetBool.Request(data=True))
            await until(lambda: got and len(ticks) > 2)
            return got, answer.success, len(ticks)

    got, success, ticks = run(main())
    assert (got, success) == ([3], False)
    assert ticks > 2


def test_a_callback_runs_once_at_a_time_unless_it_is_concurrent(context: Context) -> None:
    async def most_at_once(concurrent: bool) -> int:
        running, most, seen = 0, 0, 0

        async def on_number(message: Int32) -> None:
            nonlocal running, most, seen
            running += 1
            most = max(most, running)
            await asyncio.sleep(0.001)
            running -= 1
            seen += 1

        async with AsyncNode("node", context=context) as node:
            node.create_subscription(Int32, "number", on_number, 10, concurrent=concurrent)
            publisher = node.create_publisher(Int32, "number", 10)
            for number in range(3):
                publisher.publish(Int32(data=number))
            await until(lambda: seen == 3)
        return most

    assert run(most_at_once(False)) == 1
    assert run(most_at_once(True)) == 3


def test_the_oldest_messages_give_way_while_a_callback_is_busy(context: Context) -> None:
    got: list[int] = []

    async def main() -> None:
        may_go_on = asyncio.Event()

        async def on_number(message: Int32) -> None:
            got.append(message.data)
            await may_go_on.wait()

        async with AsyncNode("node", context=context) as node:
            node.create_subscription(Int32, "number", on_number, 2)
            publisher = node.create_publisher(Int32, "number", 10)
            publisher.publish(Int32(data=0))
            await until(lambda: got)
            for number in (1, 2, 3):
                publisher.publish(Int32(data=number))
            await asyncio.sleep(0)
            may_go_on.set()
            await until(lambda: len(got) == 3)

    run(main())
    assert got == [0, 2, 3]


def test_what_a_callback_raises_ends_the_node_and_its_block(context: Context) -> None:
    def fail(message: Int32) -> None:
        raise ValueError("bad number")

    async def main() -> None:
        async with AsyncNode("node", context=context) as node:
            node.create_subscription(Int32, "number", fail, 10)
            node.create_publisher(Int32, "number", 10).publish(Int32())
            await asyncio.Event().wait()

    with pytest.raises(Exception, match="unhandled errors in a TaskGroup") as caught:
        run(main())
    assert numbered(caught.value) == ["bad number"]
    assert context.nodes == []


def test_a_node_that_was_made_before_the_loop_takes_what_waited(context: Context) -> None:
    got: list[int] = []
    node = AsyncNode("early", context=context)

    def on_number(message: Int32) -> None:
        got.append(message.data)
        node.destroy_node()

    node.create_subscription(Int32, "number", on_number, 10)
    node.create_publisher(Int32, "number", 10).publish(Int32(data=5))
    run(node.run())
    assert got == [5]


def test_a_node_runs_once(context: Context) -> None:
    node = AsyncNode("node", context=context)

    async def main() -> None:
        async with node:
            with pytest.raises(RuntimeError, match="node /node is already running: enter it once"):
                await node.run()
            node.destroy_node()
        with pytest.raises(InvalidHandle, match="the node has been destroyed"):
            await node.run()

    run(main())
    for make in (
        lambda: node.create_publisher(Int32, "topic", 1),
        lambda: node.create_subscription(Int32, "topic", print, 1),
        lambda: node.create_service(Trigger, "service", print),
        lambda: node.create_client(Trigger, "service"),
        lambda: node.create_timer(1.0, print),
    ):
        with pytest.raises(InvalidHandle, match="the node has been destroyed"):
            make()


def test_no_executor_spins_it(context: Context) -> None:
    executor: Any = SingleThreadedExecutor(context=context)
    node: Any = AsyncNode("node", context=context)
    for spin in (executor.add_node, robolink.spin, robolink.spin_once):
        with pytest.raises(TypeError, match=r"node /node is an AsyncNode, which asyncio runs .*async with node"):
            spin(node)


def test_its_end_cancels_callbacks_and_calls_under_way(context: Context) -> None:
    cancelled: list[str] = []

    async def wait(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            cancelled.append("callback")
            raise
        return response

    async def main() -> None:
        async with AsyncNode("node", context=context) as node, TaskGroup() as group:
            node.create_service(Trigger, "wait", wait)
            call = group.create_task(node.create_client(Trigger, "wait").call(Trigger.Request()))
            sleep = group.create_task(node.get_clock().sleep(1e3))
            await asyncio.sleep(0.01)
            node.destroy_node()
            await asyncio.wait([call, sleep])
            cancelled.extend(name for name, task in (("call", call), ("sleep", sleep)) if task.cancelled())

    run(main())
    assert sorted(cancelled) == ["call", "callback", "sleep"]


def test_an_entity_leaves_its_node_when_it_is_destroyed(context: Context) -> None:
    node = AsyncNode("node", context=context)
    before = [*node.publishers], [*node.subscriptions], [*node.services], [*node.clients], [*node.timers]
    for made in (
        node.create_publisher(Int32, "topic", 1),
        node.create_subscription(Int32, "topic", print, 1),
        node.create_service(Trigger, "service", print),
        node.create_client(Trigger, "service"),
        node.create_timer(1.0, print),
    ):
        made.destroy()
        made.destroy()
    assert before == ([*node.publishers], [*node.subscriptions], [*node.services], [*node.clients], [*node.timers])


def test_the_end_of_the_context_ends_run(context: Context) -> None:
    async def main() -> None:
        node = AsyncNode("node", context=context)
        asyncio.get_running_loop().call_later(0.01, context.shutdown)
        await node.run()

    run(main())


def test_a_call_of_a_node_that_does_not_run_says_so(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.experimental.async_client.GRACE", 0.01)
    node = AsyncNode("node", context=context)
    client = node.create_client(Trigger, "service")
    with pytest.raises(RuntimeError, match="service /service: nobody takes the answer, since the node does not run"):
        run(client.call(Trigger.Request()))


def test_a_call_may_begin_before_its_node_runs(context: Context) -> None:
    def serve(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = True
        return response

    async def main() -> bool:
        node = AsyncNode("node", context=context)
        node.create_service(Trigger, "service", serve)

        async def call() -> bool:
            answer = await node.create_client(Trigger, "service").call(Trigger.Request())
            node.destroy_node()
            return bool(answer.success)

        return (await asyncio.gather(call(), node.run()))[0]

    assert run(main())
