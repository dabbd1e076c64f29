"""Services and clients: calls from everywhere, also from within callbacks, and what becomes of those without answer."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.callback_groups import MutuallyExclusiveCallbackGroup
from robolink.exceptions import ExternalShutdownException, InvalidHandle, ServiceError
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.service import MOST_WAITING
from robolink.transport.memory import Bus, MemoryTransport
from tests.programs import Program
from tests.spins import done, spin_for, spin_until
from tests.transports import until

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


# Calls without answer


def test_calling_nobody_is_an_error_at_once(node: Node, executor: SingleThreadedExecutor) -> None:
    client = node.create_client(SetBool, "nobody")
    with pytest.raises(ServiceError, match="/nobody: nobody serves it"):
        client.call(ON)
    with pytest.raises(ServiceError, match="/nobody: nobody serves it"):
        client.try_call(ON, timeout_sec=3600.0)
    with pytest.raises(ServiceError, match="nobody serves it"):
        done(executor, client.try_call_async(ON))


def test_a_timeout_passes_before_calling_nobody_fails(node: Node, executor: SingleThreadedExecutor) -> None:
    """Programs for rclpy count on their timeout to wait for a server: they try again a few times."""
    client = node.create_client(SetBool, "nobody")
    with pytest.raises(TimeoutError, match=r"/nobody: no answer within 0\.01 s: nobody serves it"):
        client.call(ON, timeout_sec=0.01)
    node.create_timer(1.0, lambda: client.call(ON, timeout_sec=2.0))
    with pytest.raises(TimeoutError, match=r"/nobody: no answer within 2\.0 s: nobody serves it"):
        executor.spin()
    assert executor.context.time.now() == 3 * 10**9


def test_the_future_of_a_call_to_nobody_is_never_done(
    node: Node, server: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    """As in rclpy, where programs ask before the server is there, and again when the future is not done in time."""
    client, awaited = node.create_client(SetBool, "late"), list[Any]()

    async def ask() -> None:
        awaited.append(await client.call_async(ON))

    futures = [client.call_async(ON), client.call_async(ON)]
    executor.create_task(ask)
    spin_for(executor, 3600.0)
    assert [each.done() for each in futures] == [False, False]
    (line,) = log_lines
    assert line.message.startswith("service /late: nobody serves it")
    server.create_service(SetBool, "late", switch)
    assert done(executor, client.call_async(ON)).success
    assert client.get_pending_request(1) is futures[0]
    assert awaited == []
    client.remove_pending_request(futures[0])


def test_a_call_times_out(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    client, late = node.create_client(Trigger, "slow"), executor.create_future()

    async def slow(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        await late
        return response

    server.create_service(Trigger, "slow", slow)
    node.create_timer(0.1, lambda: client.call(Trigger.Request(), timeout_sec=0.5))
    with pytest.raises(TimeoutError, match=r"/slow: no answer within 0\.5 s"):
        executor.spin()
    assert executor.context.time.now() == 6 * 10**8
    with pytest.raises(TimeoutError):
        client.call(Trigger.Request(), timeout_sec=0.01)
    late.set_result(None)
    spin_for(executor, 0.01)


def test_an_exception_in_a_service_ends_the_spin_and_the_call(
    node: Node, server: Node, executor: SingleThreadedExecutor
) -> None:
    server.create_service(Trigger, "broken", lambda request, response: 1 // 0)
    future = node.create_client(Trigger, "broken").try_call_async(Trigger.Request())
    with pytest.raises(ZeroDivisionError):
        executor.spin()
    with pytest.raises(ServiceError):
        done(executor, future)


def test_a_service_must_return_its_response(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    server.create_service(Trigger, "forgetful", lambda request, response: None)
    future = node.create_client(Trigger, "forgetful").try_call_async(Trigger.Request())
    with pytest.raises(TypeError, match=r"/forgetful must return a Trigger\.Response, got None"):
        executor.spin()
    with pytest.raises(ServiceError):
        done(executor, future)


def test_a_service_destroyed_in_its_own_callback_still_answers(
    node: Node, server: Node, executor: SingleThreadedExecutor
) -> None:
    def last(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        server.destroy_service(service)
        response.message = "the last"
        return response

    service = server.create_service(Trigger, "last", last)
    client = node.create_client(Trigger, "last")
    first, second = client.try_call_async(Trigger.Request()), client.try_call_async(Trigger.Request())
    assert done(executor, first).message == "the last"
    with pytest.raises(ServiceError, match="went away"):
        done(executor, second)


def test_whoever_waits_is_told_when_a_service_goes_that_nobody_spins(
    context: Context, node: Node, executor: SingleThreadedExecutor
) -> None:
    idle = Node("idle", context=context)
    service = idle.create_service(Trigger, "never", lambda _, response: response)
    future = node.create_client(Trigger, "never").try_call_async(Trigger.Request())
    idle.destroy_service(service)
    with pytest.raises(ServiceError, match="went away"):
        done(executor, future)


def test_a_flood_of_requests_is_bounded(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    client = node.create_client(SetBool, "switch")
    futures = [client.try_call_async(ON) for _ in range(MOST_WAITING + 2)]
    spin_for(executor, 1.0)
    refused = [index for index, each in enumerate(futures) if each.exception() is not None]
    assert refused == [0, 1]


def test_a_malformed_request_is_told_once_and_ends_the_call(
    bus: Bus, node: Node, server: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    service = next(each for each in server.services if each.srv_name == "/switch")
    answers: list[Any] = []
    session = MemoryTransport(bus=bus)
    for payload in (b"", b"\x00\x01\x00\x00\x07"):
        session.call(service._endpoint.key, payload, b"", answers.append)
    spin_for(executor, 0.1)
    assert answers == [None, None]
    assert service.malformed == 2
    assert [each.message.split(":")[0] for each in log_lines] == ["/switch"]
    assert done(executor, node.create_client(SetBool, "switch").call_async(ON)).success


def test_a_malformed_answer_is_an_error(bus: Bus, node: Node, executor: SingleThreadedExecutor) -> None:
    client, session = node.create_client(SetBool, "strange"), MemoryTransport(bus=bus)

    def reply(query: Any) -> None:
        query.reply(b"nonsense", b"")
        query.close()

    session.serve(client._endpoint.key, reply)
    with pytest.raises(ServiceError, match="/strange: the answer cannot be read"):
        client.call(ON)


def test_a_wrong_request_is_refused(node: Node) -> None:
    client = node.create_client(SetBool, "switch")
    for wrong in (Trigger.Request(), None, {"data": True}):
        with pytest.raises(TypeError, match=r"Expected .*SetBool"):
            client.call_async(wrong)  # type: ignore[arg-type] # what is tested


def test_a_forgotten_call_is_not_completed(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    client = node.create_client(SetBool, "switch")
    future = client.call_async(ON)
    client.remove_pending_request(future)
    spin_for(executor, 0.1)
    assert not future.done()
    assert node.destroy_client(client)
    with pytest.raises(InvalidHandle):
        client.call_async(ON)


def test_answers_follow_a_client_that_moves(node: Node, server: Node, executor: SingleThreadedExecutor) -> None:
    client, other = node.create_client(SetBool, "switch"), SingleThreadedExecutor(context=node.context)
    future = client.call_async(ON)
    other.add_node(node)
    spin_for(executor, 0.1)
    assert not future.done()
    assert done(other, future).success


def test_the_end_of_the_context_ends_a_call(context: Context) -> None:
    server, node = Node("server", context=context), Node("node", context=context)
    service = server.create_service(SetBool, "never_spun", switch)
    client = node.create_client(SetBool, "never_spun")

    def end() -> None:
        until(lambda: len(service.mailbox) == 1)  # it calls
        context.shutdown()

    threading.Thread(target=end).start()
    with pytest.raises((ExternalShutdownException, ServiceError)):
        client.call(ON)


def test_waiting_for_a_service(context: Context, node: Node) -> None:
    client = node.create_client(SetBool, "switch")
    assert not client.service_is_ready()
    assert not client.wait_for_service(timeout_sec=3600.0)
    assert node.context.time.now() == 3600 * 10**9
    real = Node("real", context=context)
    awaited = real.create_client(SetBool, "awaited")
    begin = time.monotonic()
    assert not awaited.wait_for_service(timeout_sec=0.02)
    assert time.monotonic() - begin >= 0.02
    thread = threading.Timer(0.02, real.create_service, (SetBool, "awaited", switch))
    thread.start()
    assert awaited.wait_for_service()
    thread.join(PATIENCE)
    assert awaited.service_name == "/awaited"


def test_the_end_of_the_context_ends_the_wait_for_a_service(context: Context) -> None:
    client = Node("node", context=context).create_client(SetBool, "nobody")
    threading.Timer(0.02, context.shutdown).start()
    assert not client.wait_for_service()


SERVER = """
    import sys
    import robolink as rclpy
    from robolink.interfaces.std_srvs.srv import SetBool

    def switch(request, response):
        if not request.data:
            print("asked")
            import time
            time.sleep(60)
        response.success, response.message = request.data, "from afar"
        return response

    rclpy.init()
    node = rclpy.create_node("server")
    node.create_service(SetBool, "switch", switch)
    print("ready")
    rclpy.spin(node)
"""


@pytest.mark.processes
def test_another_process_serves_and_is_killed_while_it_does(tmp_path: Path, domain: int) -> None:
    context = Context()
    context.init([], domain_id=domain)
    with context, Program(tmp_path, SERVER, domain) as program, SingleThreadedExecutor(context=context) as executor:
        node = Node("node", context=context)
        executor.add_node(node)
        client = node.create_client(SetBool, "switch")
        assert program.line() == "ready"
        assert client.wait_for_service(timeout_sec=PATIENCE)
        assert client.call(ON, timeout_sec=PATIENCE).message == "from afar"
        assert done(executor, client.call_async(ON)).success
        hanging = client.try_call_async(SetBool.Request(data=False))
        assert program.line() == "asked"
        program.kill()
        with pytest.raises(ServiceError, match="the server went away"):
            done(executor, hanging)
