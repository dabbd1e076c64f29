"""Services and clients: calls from everywhere, also from within callbacks, and what becomes of those without answer."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest

from robolink import Context, Node
from robolink.callback_groups import MutuallyExclusiveCallbackGroup
from robolink.exceptions import ServiceError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from tests.support.spins import done, spin_for, spin_until

PATIENCE = 30.0
ON = SetBool.Request(data=True)


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    executor.add_node(made)
    return made


@pytest.fixture
def server(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("server", context=virtual)
    executor.add_node(made)
    made.create_service(SetBool, "switch", switch)
    return made


def switch(request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
    response.success = request.data
    response.message = "switched"
    return response


@pytest.fixture
def spun(context: Context) -> Iterator[SingleThreadedExecutor]:
    """An executor in real time that another thread spins."""
    executor = SingleThreadedExecutor(context=context)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    yield executor
    executor.shutdown()
    thread.join(PATIENCE)


def test_a_call_is_answered(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    future = node.create_client(SetBool, "switch").call_async(ON)
    assert not future.done()
    answer = done(executor, future)
    assert (answer.success, answer.message) == (True, "switched")


def test_the_end_of_all_answers_takes_no_turn(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    client = node.create_client(SetBool, "switch")
    for _ in range(3):
        done(executor, client.call_async(ON))
        assert not executor._queue_.ready
        assert not client.is_waiting


def test_a_call_that_was_cancelled_stays_so_when_its_answer_comes(
    node: Node, server: Node, executor: SingleThreadedExecutor
) -> None:
    client = node.create_client(SetBool, "switch")
    future = client.call_async(ON)
    future.cancel()
    assert not client.is_waiting
    spin_for(executor, 0.5)
    assert (future.done(), future.cancelled(), future.result()) == (False, True, None)


def test_an_answer_comes_while_the_clients_own_group_is_busy(node: Node, server: Node) -> None:
    group, answers = MutuallyExclusiveCallbackGroup(), list[str]()
    client = node.create_client(SetBool, "switch", callback_group=group)
    assert client.callback_group is group
    assert group.has_entity(client)
    timer = node.create_timer(0.1, lambda: answers.append(client.call(ON).message), group)
    executor = node.executor
    assert executor is not None
    spin_until(executor, lambda: bool(answers))
    assert answers == ["switched"]
    timer.cancel()


def test_several_calls_at_once_each_get_their_own_answer(
    node: Node, server: Node, executor: SingleThreadedExecutor
) -> None:
    client = node.create_client(SetBool, "switch")
    futures = [client.call_async(SetBool.Request(data=index % 2 == 0)) for index in range(6)]
    assert client.get_pending_request(3) is futures[2]
    assert [done(executor, each).success for each in futures] == [True, False] * 3
    with pytest.raises(KeyError):
        client.get_pending_request(3)


def test_a_callback_hears_of_the_answer(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    heard: list[str] = []
    future = node.create_client(SetBool, "switch").call_async(ON)
    future.add_done_callback(lambda each: heard.append(str(each.result())))
    spin_for(executor, 0.1)
    assert len(heard) == 1
    assert "switched" in heard[0]


def test_a_thread_may_call_while_another_spins(context: Context, spun: SingleThreadedExecutor) -> None:
    server, node = Node("server", context=context), Node("node", context=context)
    server.create_service(SetBool, "switch", switch)
    spun.add_node(server)
    assert node.create_client(SetBool, "switch").call(ON, timeout_sec=PATIENCE).success
    spun.add_node(node)
    assert node.create_client(SetBool, "switch").call(ON, timeout_sec=PATIENCE).success


def test_a_callback_may_call_what_the_same_executor_serves(
    node: Node, server: Node, executor: SingleThreadedExecutor
) -> None:
    """rclpy hangs here."""
    client, answers = node.create_client(SetBool, "switch"), list[Any]()

    def callback() -> None:
        answers.append(client.call(ON))
        timer.cancel()

    timer = node.create_timer(0.1, callback)
    spin_for(executor, 0.3)
    assert [each.success for each in answers] == [True]


def test_a_call_in_a_call_in_a_callback(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    outer, inner = node.create_client(Trigger, "outer"), server.create_client(SetBool, "switch")

    def serve_outer(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.message = "outer " + inner.call(ON).message
        return response

    server.create_service(Trigger, "outer", serve_outer, callback_group=MutuallyExclusiveCallbackGroup())
    node.create_timer(0.1, lambda: answers.append(outer.call(Trigger.Request()).message))
    answers: list[str] = []
    spin_for(executor, 0.15)
    assert answers == ["outer switched"]


def test_only_services_run_while_a_callback_waits(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    trace: list[str] = []
    client = node.create_client(SetBool, "switch")

    def callback() -> None:
        trace.append("call")
        client.call(ON)
        trace.append("answer")

    node.create_timer(0.1, callback)
    server.create_timer(0.1, lambda: trace.append("timer"))
    spin_for(executor, 0.15)
    assert trace == ["call", "answer", "timer"]


def test_a_call_that_would_wait_for_itself_is_refused_at_once(node: Node, executor: SingleThreadedExecutor) -> None:
    node.create_service(SetBool, "own", switch)
    client = node.create_client(SetBool, "own")
    node.create_timer(0.1, lambda: client.call(ON))
    with pytest.raises(ServiceError, match="/own is served only by the callback group that this call keeps busy"):
        spin_for(executor, 0.2)
    assert executor.context.time.now() < 2 * 10**8


def test_it_is_not_refused_where_another_executor_serves_it_too(context: Context, spun: SingleThreadedExecutor) -> None:
    node, other = Node("node", context=context), Node("other", context=context)
    node.create_service(SetBool, "own", switch)
    other.create_service(SetBool, "own", switch)
    spun.add_node(other)
    client, answers = node.create_client(SetBool, "own"), list[Any]()
    node.create_timer(0.001, lambda: answers.append(client.call(ON, timeout_sec=PATIENCE)))
    with SingleThreadedExecutor(context=context) as executor:
        executor.add_node(node)
        spin_until(executor, lambda: bool(answers))
    assert answers[0].success


def test_a_group_of_its_own_lets_a_node_call_itself(node: Node, executor: SingleThreadedExecutor) -> None:
    node.create_service(SetBool, "own", switch, callback_group=MutuallyExclusiveCallbackGroup())
    client, answers = node.create_client(SetBool, "own"), list[Any]()
    node.create_timer(0.1, lambda: answers.append(client.call(ON)))
    spin_for(executor, 0.15)
    assert [each.success for each in answers] == [True]


def test_a_coroutine_may_call_and_serve(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    client, outer, answers = node.create_client(SetBool, "switch"), node.create_client(Trigger, "outer"), list[Any]()

    async def serve_outer(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        answer = await client.call_async(ON)
        response.message = f"awaited {answer.message}" if answer else ""
        return response

    async def on_timer() -> None:
        timer.cancel()
        answers.append(await outer.call_async(Trigger.Request()))

    node.create_service(Trigger, "outer", serve_outer, callback_group=MutuallyExclusiveCallbackGroup())
    timer = node.create_timer(0.1, on_timer)
    spin_for(executor, 0.2)
    assert [each.message for each in answers] == ["awaited switched"]
    node.create_timer(0.1, lambda: answers.append(outer.call(Trigger.Request()))).timer_period_ns = 10**9
    spin_for(executor, 0.2)
    assert [each.message for each in answers] == ["awaited switched"] * 2
