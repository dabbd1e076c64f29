"""Calls without answer: nobody serves, time is up, the server breaks or goes away."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.exceptions import ExternalShutdownException, InvalidHandle, ServiceError, SessionReplacedError
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.std_srvs.srv import SetBool, Trigger
from robolink.service import MOST_WAITING
from robolink.transport.memory import Bus, MemoryTransport
from tests.support.programs import Program
from tests.support.spins import done, spin_for
from tests.support.transports import until

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


def test_calling_nobody_is_an_error_at_once(node: Node, executor: SingleThreadedExecutor) -> None:
    client = node.create_client(SetBool, "nobody")
    with pytest.raises(ServiceError, match="/nobody: nobody serves it"):
        client.call(ON)
    with pytest.raises(ServiceError, match="/nobody: nobody serves it"):
        client.try_call(ON, timeout_sec=3600.0)
    with pytest.raises(ServiceError, match="nobody serves it"):
        done(executor, client.try_call_async(ON))


@pytest.mark.usefixtures("server")
def test_an_answer_that_is_lost_with_its_session_is_an_error_that_says_so(
    node: Node, executor: SingleThreadedExecutor, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lost(*_: object) -> None:
        raise SessionReplacedError

    client = node.create_client(SetBool, "switch")
    monkeypatch.setattr(client._transport, "read", lost)
    with pytest.raises(ServiceError, match=r"/switch: this machine's address .* call again if that does no harm"):
        done(executor, client.try_call_async(ON))
    assert client.malformed == 0


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
    service = next(each for each in server.services if each.service_name == "/switch")
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
