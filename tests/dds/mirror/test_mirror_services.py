"""Services, parameters and actions through a mirror between two networks in memory, in virtual time."""

from __future__ import annotations

from typing import Any

import pytest

from robolink import Node
from robolink.action import ActionClient, ActionServer, CancelResponse
from robolink.dds.mirror.mirror import LINGER
from robolink.dds.mirror.services import REHASHED_FOR
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.message import type_hash
from robolink.parameter import Parameter
from robolink.parameter_client import AsyncParameterClient
from robolink.serialization import deserialize_message, serialize_message
from robolink.wire import (
    NO_HASH,
    DataKey,
    EndpointKind,
    format_key,
    format_token,
    gid_of,
    graph_pattern,
    pack_attachment,
    parse_token,
    unpack_attachment,
)
from tests.support.mirrored import Half, Mirrored, adds, raw_tokens, services


def test_calls_are_answered_whoever_comes_first(pair: tuple[Mirrored, Half, Half]) -> None:
    scene, here, there = pair
    early = there.node("early").create_client(AddTwoInts, "add")
    scene.run(0.1)
    asked = adds(here.node("server"))
    late = there.node("late").create_client(AddTwoInts, "add")
    scene.until(lambda: early.service_is_ready() and late.service_is_ready())
    futures: list[Any] = [
        client.call_async(AddTwoInts.Request(a=a, b=1)) for a, client in enumerate((early, late, early))
    ]
    scene.until(lambda: all(each.done() for each in futures))
    assert [each.result().sum for each in futures] == [1, 2, 3]
    assert sorted(asked) == [(0, 1), (1, 1), (2, 1)]
    assert scene.mirror is not None
    assert all(not flow.calls for flow in services(scene))


def test_the_server_sees_a_client_that_its_own_graph_has(joined: Mirrored) -> None:
    seen: list[Any] = []
    server = joined.a.session()
    client = joined.b.node("asker").create_client(AddTwoInts, "add")
    key = client._endpoint.key
    server.serve(key, seen.append)
    token = raw_tokens(server.session_id)[0]._replace(
        kind=EndpointKind.SERVICE,
        name="/add",
        type_name="example_interfaces/srv/AddTwoInts",
        type_hash=type_hash(AddTwoInts),
    )
    server.announce(format_token(token))
    joined.until(client.service_is_ready)
    future: Any = client.call_async(AddTwoInts.Request(a=1, b=2))
    joined.until(lambda: seen)
    query = server.accept(seen[0])
    sequence, _, gid = unpack_attachment(query.attachment)
    graph = {gid_of(each): parse_token(each) for each in server.tokens(graph_pattern(0))}
    assert graph[gid].node_name == "asker"
    assert sequence == 1
    query.reply(bytes(serialize_message(AddTwoInts.Response(sum=3))), pack_attachment(sequence, 5, gid))
    query.close()
    joined.until(future.done)
    assert future.result().sum == 3


def test_a_server_that_dies_in_the_middle_of_a_call_ends_it(pair: tuple[Mirrored, Half, Half]) -> None:
    scene, here, there = pair
    other = here.new_context()
    adds(Node("server", context=other))  # which nobody spins
    client = there.node("asker").create_client(AddTwoInts, "add")
    scene.until(client.service_is_ready)
    future = client.try_call_async(AddTwoInts.Request(a=1, b=2))
    scene.run(0.2)
    assert not future.done()
    other.transport.close()
    scene.until(future.done, 1.0)
    with pytest.raises(RuntimeError, match="went away"):
        future.result()
    scene.until(lambda: not client.service_is_ready())
    other.try_shutdown()


def test_a_call_ends_with_the_announcement_where_the_network_does_not_end_it(joined: Mirrored) -> None:
    """On DDS a request has no end: a server that goes is only gone from the graph."""
    server = joined.a.session()
    seen: list[Any] = []
    client = joined.b.node("asker").create_client(AddTwoInts, "add")
    server.serve(client._endpoint.key, seen.append)
    token = raw_tokens(server.session_id)[0]._replace(
        kind=EndpointKind.SERVICE,
        name="/add",
        type_name="example_interfaces/srv/AddTwoInts",
        type_hash=type_hash(AddTwoInts),
    )
    announced = server.announce(format_token(token))
    joined.until(client.service_is_ready)
    future = client.try_call_async(AddTwoInts.Request())
    joined.until(lambda: seen)
    announced.close()
    joined.until(future.done, 1.0)
    assert future.exception() is not None


def test_a_mirror_that_ends_ends_the_calls(joined: Mirrored) -> None:
    adds(Node("server", context=(other := joined.a.new_context())))
    client = joined.b.node("asker").create_client(AddTwoInts, "add")
    joined.until(client.service_is_ready)
    future = client.try_call_async(AddTwoInts.Request())
    joined.run(0.2)
    joined.part()
    joined.until(future.done, 1.0)
    assert future.exception() is not None
    other.try_shutdown()


def test_a_client_that_goes_leaves_no_call_behind(joined: Mirrored) -> None:
    adds(Node("server", context=(other := joined.a.new_context())))
    asker = joined.b.node("asker")
    client = asker.create_client(AddTwoInts, "add")
    joined.until(client.service_is_ready)
    client.call_async(AddTwoInts.Request())
    joined.run(0.2)
    assert sum(len(flow.calls) for flow in services(joined)) == 1
    asker.destroy_node()
    joined.run(LINGER + 0.1)
    assert sum(len(flow.calls) for flow in services(joined)) == 0
    other.try_shutdown()


def test_the_same_service_on_both_sides_is_called_once_on_each(joined: Mirrored) -> None:
    asked = [adds(half.node(f"server{number}")) for number, half in enumerate(joined.halves)]
    client = joined.b.node("asker").create_client(AddTwoInts, "add")
    joined.run(0.2)
    future: Any = client.call_async(AddTwoInts.Request(a=1, b=2))
    joined.until(future.done)
    joined.run(0.5)
    assert future.result().sum == 3
    assert asked == [[(1, 2)], [(1, 2)]]
    assert sum(len(flow.calls) for flow in services(joined)) == 0


def test_two_servers_of_one_side_are_called_once_each(joined: Mirrored) -> None:
    asked = [adds(joined.a.node(f"server{number}")) for number in range(2)]
    client = joined.b.node("asker").create_client(AddTwoInts, "add")
    joined.until(client.service_is_ready)
    future: Any = client.call_async(AddTwoInts.Request(a=1, b=2))
    joined.run(0.5)
    assert future.done()
    assert asked == [[(1, 2)], [(1, 2)]]


def test_a_caller_without_a_token_is_answered(joined: Mirrored) -> None:
    adds(joined.a.node("server"))
    probe = joined.b.node("probe").create_client(AddTwoInts, "add")
    joined.until(probe.service_is_ready)
    session = joined.b.session()
    got: list[Any] = []
    asked = pack_attachment(77, 3, b"somebody unknown")
    session.call(probe._endpoint.key, bytes(serialize_message(AddTwoInts.Request(a=4, b=5))), asked, got.append)
    joined.until(lambda: got and got[-1] is None)
    payload, attachment = session.read(got[0])
    assert deserialize_message(payload, AddTwoInts.Response).sum == 9
    assert (unpack_attachment(attachment).sequence, unpack_attachment(attachment).gid) == (77, b"somebody unknown")


def test_a_call_without_the_attachment_ends_unanswered(joined: Mirrored) -> None:
    asked = adds(joined.a.node("server"))
    probe = joined.b.node("probe").create_client(AddTwoInts, "add")
    joined.until(probe.service_is_ready)
    got: list[Any] = []
    joined.b.session().call(probe._endpoint.key, b"", b"short", got.append)
    joined.until(lambda: got == [None])
    assert asked == []


def test_parameters(pair: tuple[Mirrored, Half, Half]) -> None:
    scene, here, there = pair
    here.node("robot").declare_parameter("speed", 1.0)
    client = AsyncParameterClient(there.node("asker"), "robot")
    scene.until(client.services_are_ready)
    future: Any = client.set_parameters([Parameter("speed", value=2.5)])
    scene.until(future.done)
    future = client.get_parameters(["speed"])
    scene.until(future.done)
    assert future.result().values[0].double_value == 2.5


def test_an_action_with_feedback_and_cancel(pair: tuple[Mirrored, Half, Half]) -> None:
    scene, here, there = pair
    goals: list[Any] = []
    server = ActionServer(
        here.node("server"),
        Fibonacci,
        "fibonacci",
        _count_up,
        handle_accepted_callback=goals.append,
        cancel_callback=lambda goal: CancelResponse.ACCEPT,
    )
    client = ActionClient(there.node("asker"), Fibonacci, "fibonacci")
    scene.until(client.server_is_ready)
    feedback: list[Any] = []
    sent: Any = client.send_goal_async(
        Fibonacci.Goal(order=3), lambda each: feedback.append(list(each.feedback.sequence))
    )
    scene.until(sent.done)
    assert sent.result().accepted
    result = sent.result().get_result_async()
    scene.until(lambda: goals)
    goals[0].execute()
    scene.until(result.done)
    assert list(result.result().result.sequence) == [0, 1, 2]
    assert feedback == [[0], [0, 1], [0, 1, 2]]
    sent = client.send_goal_async(Fibonacci.Goal(order=3))
    scene.until(sent.done)
    cancelled: Any = sent.result().cancel_goal_async()
    scene.until(cancelled.done)
    assert len(cancelled.result().goals_canceling) == 1
    server.destroy()
    client.destroy()


def _count_up(goal: Any) -> Any:
    feedback = Fibonacci.Feedback()
    for number in range(goal.request.order):
        feedback.sequence = [*feedback.sequence, number]
        goal.publish_feedback(feedback)
    goal.succeed()
    return Fibonacci.Result(sequence=feedback.sequence)


def test_a_call_that_was_made_before_the_hash_was_known_is_answered(joined: Mirrored) -> None:
    """The client sees a server without a hash, calls that at once, and its own token makes the hash known."""
    server = joined.a.session()
    token = raw_tokens(server.session_id, NO_HASH)[0]._replace(
        kind=EndpointKind.SERVICE, name="/add", type_name="example_interfaces/srv/AddTwoInts"
    )
    seen: list[Any] = []
    server.serve(format_key(DataKey(0, token.name, token.type_name, NO_HASH)), seen.append)
    announced = server.announce(format_token(token))
    joined.run(0.1)
    client = joined.b.node("asker").create_client(AddTwoInts, "add")
    assert client.service_is_ready()
    calls: list[Any] = [client.try_call_async(AddTwoInts.Request(a=1, b=2))]
    joined.run(REHASHED_FOR / 2)
    calls.append(client.try_call_async(AddTwoInts.Request(a=1, b=2)))
    joined.run(REHASHED_FOR + 0.2)
    assert len(seen) == 2
    for arrived in seen:
        query = server.accept(arrived)
        query.reply(bytes(serialize_message(AddTwoInts.Response(sum=3))), query.attachment)
        query.close()
    joined.until(lambda: all(each.done() for each in calls))
    assert [each.result().sum for each in calls] == [3, 3]
    calls.append(client.try_call_async(AddTwoInts.Request()))
    joined.run(0.1)
    announced.close()
    joined.until(calls[-1].done, 1.0)
    assert calls[-1].exception() is not None
