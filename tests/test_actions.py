"""Actions, server and client together: goals that succeed, fail, are cancelled or rejected, and what of it is told."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from robolink import Context, Future, Node, Time
from robolink.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from robolink.action.client import ClientGoalHandle
from robolink.action.server import GoalEvent, RCLError, ServerGoalHandle
from robolink.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.exceptions import ServiceError
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.qos import qos_profile_action_status_default
from tests.spins import done, spin_for, spin_until

PATIENCE = 30.0
SUCCEEDED, CANCELED, ABORTED = GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED


def fibonacci(goal_handle: ServerGoalHandle) -> Fibonacci.Result:
    """Execute a goal as the tutorials do."""
    feedback = Fibonacci.Feedback(sequence=[0, 1])
    while len(feedback.sequence) <= goal_handle.request.order:
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
            return Fibonacci.Result(sequence=feedback.sequence)
        feedback.sequence.append(feedback.sequence[-1] + feedback.sequence[-2])
        goal_handle.publish_feedback(feedback)
    goal_handle.succeed()
    return Fibonacci.Result(sequence=feedback.sequence)


def numbered(number: int) -> UUID:
    return UUID(uuid=[number] * 16)


def accept(_: Any) -> CancelResponse:
    return CancelResponse.ACCEPT


class Waiting:
    """Executes goals that go on until they are told how to end."""

    def __init__(self) -> None:
        self.handles: list[ServerGoalHandle] = []
        self.futures: list[Future[Callable[[ServerGoalHandle], None]]] = []

    async def __call__(self, handle: ServerGoalHandle) -> Fibonacci.Result:
        self.handles.append(handle)
        self.futures.append(Future())
        end = await self.futures[-1]
        assert end is not None
        end(handle)
        return Fibonacci.Result(sequence=[handle.request.order])


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    executor.add_node(made)
    return made


@pytest.fixture
def server_node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("server", context=virtual)
    executor.add_node(made)
    return made


@pytest.fixture
def client(node: Node) -> ActionClient:
    return ActionClient(node, Fibonacci, "fibonacci")


@pytest.fixture
def serve(server_node: Node) -> Callable[..., ActionServer]:
    def make(execute: Callable[..., Any] = fibonacci, **options: Any) -> ActionServer:
        return ActionServer(server_node, Fibonacci, "fibonacci", execute, **options)

    return make


@pytest.fixture
def waiting() -> Waiting:
    return Waiting()


@pytest.fixture
def spun(context: Context) -> Iterator[SingleThreadedExecutor]:
    """An executor in real time that another thread spins."""
    executor = SingleThreadedExecutor(context=context)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    yield executor
    executor.shutdown()
    thread.join(PATIENCE)


def accepted(executor: SingleThreadedExecutor, client: ActionClient, order: int = 1, **options: Any) -> Any:
    """Send a goal; its handle, once the server has accepted it."""
    handle = done(executor, client.send_goal_async(Fibonacci.Goal(order=order), **options))
    assert handle.accepted
    return handle


# --- The ways that a goal can go ----------------------------------------------------------------------------------


def test_a_goal_is_executed_with_feedback_on_the_way(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve()
    heard: list[list[int]] = []
    handle = accepted(executor, client, 4, feedback_callback=lambda each: heard.append(list(each.feedback.sequence)))
    answer = done(executor, handle.get_result_async())
    assert (answer.status, list(answer.result.sequence)) == (SUCCEEDED, [0, 1, 1, 2, 3])
    assert heard == [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3]]
    assert handle.status == SUCCEEDED


def test_a_result_may_be_asked_for_before_and_after_the_end(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting)
    handle = accepted(executor, client, 7)
    early, late = handle.get_result_async(), handle.get_result_async()
    spin_for(executor, 60.0)
    assert not early.done()
    assert handle.status == GoalStatus.STATUS_EXECUTING
    waiting.futures[0].set_result(ServerGoalHandle.succeed)
    assert [list(done(executor, each).result.sequence) for each in (early, late)] == [[7], [7]]
    assert list(done(executor, handle.get_result_async()).result.sequence) == [7]


def test_a_goal_can_be_rejected(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve(goal_callback=lambda goal: GoalResponse.ACCEPT if goal.order < 10 else GoalResponse.REJECT)
    handle = done(executor, client.send_goal_async(Fibonacci.Goal(order=10)))
    assert (handle.accepted, handle.status) == (False, GoalStatus.STATUS_UNKNOWN)
    assert accepted(executor, client, 9).accepted


def test_a_goal_callback_that_answers_nonsense_rejects(
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    log_lines: list[Record],
) -> None:
    serve(goal_callback=lambda _: True)
    assert not done(executor, client.send_goal_async(Fibonacci.Goal())).accepted
    assert "goal callback returned True, which is no GoalResponse" in log_lines[-1].message


def test_callbacks_may_be_coroutines(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], node: Node
) -> None:
    async def a_while(answer: Any = None) -> Any:
        ticked: Future[None] = Future()
        timer = node.create_timer(1.0, lambda: ticked.set_result(None))
        await ticked
        node.destroy_timer(timer)
        return answer

    async def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        while not handle.is_cancel_requested:
            await a_while()
        handle.canceled()
        return Fibonacci.Result(sequence=[5])

    async def hand_over(handle: ServerGoalHandle) -> None:
        await a_while()
        handle.execute()

    serve(
        execute,
        goal_callback=lambda _: a_while(GoalResponse.ACCEPT),
        handle_accepted_callback=hand_over,
        cancel_callback=lambda _: a_while(CancelResponse.ACCEPT),
    )
    handle = accepted(executor, client)
    assert node.context.time.now() == 10**9
    spin_for(executor, 5.0)
    assert len(done(executor, handle.cancel_goal_async()).goals_canceling) == 1
    assert done(executor, handle.get_result_async()).status == CANCELED


def test_a_goal_that_is_handed_over_is_executed_when_that_is_asked_for(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    kept: list[ServerGoalHandle] = []
    serve(handle_accepted_callback=kept.append)
    handle = accepted(executor, client, 3)
    spin_for(executor, 1.0)
    assert (kept[0].status, handle.status) == (GoalStatus.STATUS_ACCEPTED, GoalStatus.STATUS_ACCEPTED)

    def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        handle.succeed()
        return Fibonacci.Result(sequence=[8])

    kept[0].execute(execute)
    assert list(done(executor, handle.get_result_async()).result.sequence) == [8]
    with pytest.raises(RCLError, match="once only"):
        kept[0].execute()


def test_execution_waits_for_an_executor(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], server_node: Node
) -> None:
    kept: list[ServerGoalHandle] = []
    serve(handle_accepted_callback=kept.append)
    handle = accepted(executor, client, 3)
    executor.remove_node(server_node)
    kept[0].execute()
    assert kept[0].status == GoalStatus.STATUS_EXECUTING
    executor.add_node(server_node)
    assert done(executor, handle.get_result_async()).status == SUCCEEDED


def test_a_callback_that_raises_aborts_the_goal_and_nothing_else(
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    log_lines: list[Record],
) -> None:
    def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        raise ZeroDivisionError("no wheels")

    serve(execute)
    answer = done(executor, accepted(executor, client).get_result_async())
    assert (answer.status, list(answer.result.sequence)) == (ABORTED, [])
    told = [each.message for each in log_lines]
    assert any("ZeroDivisionError: no wheels" in each and "Traceback" in each for each in told)
    assert any("aborted" in each for each in told)
    assert done(executor, accepted(executor, client).get_result_async()).status == ABORTED


def test_a_callback_that_forgets_to_say_how_it_ended_aborts(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve(lambda _: Fibonacci.Result(sequence=[1, 2]))
    answer = done(executor, accepted(executor, client).get_result_async())
    assert (answer.status, list(answer.result.sequence)) == (ABORTED, [1, 2])


@pytest.mark.parametrize("wrong", [None, Fibonacci.Feedback(), "done"])
def test_a_callback_that_returns_no_result_is_told_of(
    wrong: object,
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    log_lines: list[Record],
) -> None:
    def execute(handle: ServerGoalHandle) -> Any:
        handle.succeed()
        return wrong

    serve(execute)
    answer = done(executor, accepted(executor, client).get_result_async())
    assert (answer.status, list(answer.result.sequence)) == (SUCCEEDED, [])
    assert "returned no result: expected Result, got" in log_lines[-1].message


def test_what_cannot_happen_to_a_goal_is_refused(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    kept: list[ServerGoalHandle] = []
    serve(waiting, handle_accepted_callback=kept.append)
    handle = accepted(executor, client)
    for event in (ServerGoalHandle.succeed, ServerGoalHandle.abort, ServerGoalHandle.canceled):
        with pytest.raises(RCLError, match="a goal that is ACCEPTED cannot"):
            event(kept[0])
    kept[0].execute()
    spin_for(executor, 1.0)
    with pytest.raises(RuntimeError, match="EXECUTING cannot CANCELED; possible: CANCEL_GOAL, SUCCEED, ABORT"):
        kept[0].canceled()
    waiting.futures[0].set_result(ServerGoalHandle.succeed)
    done(executor, handle.get_result_async())
    with pytest.raises(RCLError, match="SUCCEEDED cannot ABORT; possible: nothing any more"):
        kept[0].abort()


# --- Cancelling ---------------------------------------------------------------------------------------------------


def test_a_goal_is_cancelled(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting, cancel_callback=accept)
    handle = accepted(executor, client)
    answer = done(executor, handle.cancel_goal_async())
    assert answer.return_code == CancelGoal.Response.ERROR_NONE
    assert [each.goal_id for each in answer.goals_canceling] == [handle.goal_id]
    assert answer.goals_canceling[0].stamp == handle.stamp
    assert waiting.handles[0].is_cancel_requested
    again = done(executor, handle.cancel_goal_async())
    assert (again.return_code, again.goals_canceling) == (CancelGoal.Response.ERROR_GOAL_TERMINATED, [])
    waiting.futures[0].set_result(ServerGoalHandle.canceled)
    assert done(executor, handle.get_result_async()).status == CANCELED


def test_a_server_lets_nobody_cancel_unless_it_says_so(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting)
    answer = done(executor, accepted(executor, client).cancel_goal_async())
    assert (answer.return_code, answer.goals_canceling) == (CancelGoal.Response.ERROR_REJECTED, [])
    assert not waiting.handles[0].is_cancel_requested


def test_a_goal_that_is_not_executed_yet_is_cancelled_and_then_executed(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    kept: list[ServerGoalHandle] = []
    serve(cancel_callback=accept, handle_accepted_callback=kept.append)
    handle = accepted(executor, client, 5)
    done(executor, handle.cancel_goal_async())
    assert kept[0].status == GoalStatus.STATUS_CANCELING
    kept[0].execute()
    assert done(executor, handle.get_result_async()).status == CANCELED


def test_a_goal_that_ends_without_having_been_executed_has_an_empty_result(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    kept: list[ServerGoalHandle] = []
    serve(cancel_callback=accept, handle_accepted_callback=kept.append)
    handle = accepted(executor, client, 5)
    future = handle.get_result_async()
    done(executor, handle.cancel_goal_async())
    kept[0].canceled()
    answer = done(executor, future)
    assert (answer.status, list(answer.result.sequence)) == (CANCELED, [])


def test_a_goal_that_ends_while_it_is_asked_whether_to_cancel_is_not_cancelled(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    def end(handle: ServerGoalHandle) -> CancelResponse:
        handle.succeed()
        return CancelResponse.ACCEPT

    serve(waiting, cancel_callback=end)
    answer = done(executor, accepted(executor, client).cancel_goal_async())
    assert (answer.return_code, answer.goals_canceling) == (CancelGoal.Response.ERROR_REJECTED, [])


def test_many_goals_are_cancelled_by_their_age(
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    waiting: Waiting,
    node: Node,
) -> None:
    server = serve(waiting, cancel_callback=accept)
    handles = []
    for number in range(1, 5):
        spin_for(executor, 1.0)
        handles.append(accepted(executor, client, number, goal_uuid=numbered(number)))
    assert [each.stamp.sec for each in handles] == [1, 2, 3, 4]
    cancel = node.create_client(CancelGoal, "fibonacci/_action/cancel_goal")

    def canceled(info: GoalInfo) -> tuple[int, set[int]]:
        answer = done(executor, cancel.call_async(CancelGoal.Request(goal_info=info)))
        return answer.return_code, {int(each.goal_id.uuid[0]) for each in answer.goals_canceling}

    assert canceled(GoalInfo(goal_id=numbered(9))) == (CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID, set())
    assert canceled(GoalInfo(goal_id=numbered(3), stamp=Time(seconds=1).to_msg())) == (0, {1, 3})
    assert canceled(GoalInfo(stamp=Time(seconds=2).to_msg())) == (0, {2})
    assert canceled(GoalInfo()) == (0, {4})
    assert canceled(GoalInfo()) == (0, set())
    assert [each.status for each in server._goal_handles.values()] == [GoalStatus.STATUS_CANCELING] * 4


# --- What is kept, and what the status topic says -----------------------------------------------------------------


def test_a_result_is_kept_for_a_while(
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    log_lines: list[Record],
) -> None:
    server = serve(result_timeout=5.0)
    first = accepted(executor, client)
    spin_for(executor, 2.0)
    second = accepted(executor, client)
    spin_for(executor, 2.0)
    assert done(executor, first.get_result_async()).status == SUCCEEDED
    spin_for(executor, 2.0)
    assert done(executor, first.get_result_async()).status == GoalStatus.STATUS_UNKNOWN
    assert "unknown, or expired" in log_lines[-1].message
    assert done(executor, second.get_result_async()).status == SUCCEEDED
    spin_for(executor, 2.0)
    assert not server._goal_handles


def test_the_while_begins_at_the_end_of_a_goal(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting, result_timeout=5)
    handle = accepted(executor, client)
    spin_for(executor, 60.0)
    waiting.futures[0].set_result(ServerGoalHandle.abort)
    spin_for(executor, 4.0)
    assert done(executor, handle.get_result_async()).status == ABORTED
    spin_for(executor, 2.0)
    assert waiting.handles[0].status == GoalStatus.STATUS_UNKNOWN
    waiting.handles[0].succeed()  # nothing happens any more
    waiting.handles[0].publish_feedback(Fibonacci.Feedback())


@pytest.mark.parametrize(("timeout", "kept"), [(-1, True), (0, False)])
def test_a_result_may_be_kept_for_ever_or_not_at_all(
    timeout: float,
    kept: bool,
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
) -> None:
    server = serve(result_timeout=timeout)
    handle = accepted(executor, client)
    spin_for(executor, 3600.0)
    assert bool(server._goal_handles) is kept
    expected = SUCCEEDED if kept else GoalStatus.STATUS_UNKNOWN
    assert done(executor, handle.get_result_async()).status == expected


def test_late_comers_learn_of_the_goals(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting)
    handles = [accepted(executor, client, 1), accepted(executor, client, 2)]
    spin_for(executor, 1.0)
    waiting.futures[0].set_result(ServerGoalHandle.succeed)
    spin_for(executor, 1.0)
    late = Node("late", context=executor.context)
    executor.add_node(late)
    heard: list[GoalStatusArray] = []
    topic = "fibonacci/_action/status"
    late.create_subscription(GoalStatusArray, topic, heard.append, qos_profile_action_status_default)
    spin_for(executor, 1.0)
    told = [(each.goal_info.goal_id, each.status) for each in heard[-1].status_list]
    assert told == [(handles[0].goal_id, SUCCEEDED), (handles[1].goal_id, GoalStatus.STATUS_EXECUTING)]


def test_an_id_is_used_once(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve()
    handle = accepted(executor, client, goal_uuid=numbered(1))
    assert not done(executor, client.send_goal_async(Fibonacci.Goal(), goal_uuid=numbered(1))).accepted
    assert handle == ClientGoalHandle(client, numbered(1), handle._goal_response)
    assert "id=" + "01" * 16 in repr(handle)


# --- Feedback -----------------------------------------------------------------------------------------------------


def test_a_goal_is_accepted_before_its_feedback_comes_and_that_comes_before_its_result(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], node: Node
) -> None:
    serve()
    told: list[str] = []

    def on_accepted(future: Future[ClientGoalHandle]) -> None:
        told.append("accepted")
        handle = future.result()
        assert handle is not None
        handle.get_result_async().add_done_callback(lambda _: told.append("result"))

    node.create_timer(1.0, lambda: None)  # other things are ready, too
    goal = client.send_goal_async(Fibonacci.Goal(order=3), feedback_callback=lambda _: told.append("feedback"))
    goal.add_done_callback(on_accepted)
    spin_for(executor, 5.0)
    assert told == ["accepted", "feedback", "feedback", "result"]


def test_feedback_goes_to_the_goal_that_it_is_about(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting)
    heard: dict[int, list[int]] = {1: [], 2: []}

    def hear(number: int) -> Callable[[Any], None]:
        return lambda message: heard[number].extend(message.feedback.sequence)

    handle = accepted(executor, client, 1, feedback_callback=hear(1))
    accepted(executor, client, 2, feedback_callback=hear(2))
    accepted(executor, client, 3)
    for number, goal in enumerate(waiting.handles, 1):
        goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
    spin_for(executor, 1.0)
    assert heard == {1: [1], 2: [2]}
    waiting.futures[0].set_result(ServerGoalHandle.succeed)
    done(executor, handle.get_result_async())
    assert list(client._feedback_callbacks) == [bytes(waiting.handles[1].goal_id.uuid)]
    with pytest.raises(TypeError, match=r"Expected .*Feedback"):
        waiting.handles[1].publish_feedback(Fibonacci.Result())


def test_feedback_and_results_of_strangers_harm_nobody(
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    node: Node,
    log_lines: list[Record],
) -> None:
    serve()
    feedback = node.create_publisher(Fibonacci.Impl.FeedbackMessage, "fibonacci/_action/feedback", 10)
    feedback.publish(Fibonacci.Impl.FeedbackMessage(goal_id=numbered(7)))
    feedback.publish(b"\x00\x01\x00\x00\x01")
    status = node.create_publisher(GoalStatusArray, "fibonacci/_action/status", 10)
    nobody = GoalStatus(goal_info=GoalInfo(goal_id=numbered(7)), status=99)
    status.publish(GoalStatusArray(status_list=[nobody, nobody]))
    status.publish(b"")
    heard: list[Any] = []
    handle = accepted(executor, client, 2, feedback_callback=heard.append)
    assert done(executor, handle.get_result_async()).status == SUCCEEDED
    assert len(heard) == 1
    assert sum("dropped a message" in each.message for each in log_lines) == 2


@pytest.mark.parametrize("part", ["send_goal", "cancel_goal", "get_result"])
def test_requests_that_cannot_be_read_are_refused(
    part: str, executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], node: Node
) -> None:
    serve()
    raw = getattr(client, {"send_goal": "_goal", "cancel_goal": "_cancel", "get_result": "_result"}[part] + "_client")
    answers: list[Any] = []
    node.context.transport.call(raw._key(), b"\x00\x01\x00\x00\xff\xff", raw._endpoint.attachment(), answers.append)
    spin_for(executor, 1.0)
    assert answers == [None]
    assert done(executor, accepted(executor, client).get_result_async()).status == SUCCEEDED


# --- The end of one side ------------------------------------------------------------------------------------------


def test_whoever_waits_is_told_when_the_server_goes(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    server = serve(waiting)
    handle = accepted(executor, client)
    future = handle.get_result_async()
    spin_for(executor, 1.0)
    server.destroy()
    server.destroy()
    spin_until(executor, future.done)
    with pytest.raises(ServiceError, match=r"action /fibonacci, goal [0-9a-f]{32}: no result: .*went away"):
        future.result()
    assert handle.status == GoalStatus.STATUS_UNKNOWN
    assert not waiting.handles[0].is_active
    waiting.futures[0].set_result(ServerGoalHandle.succeed)  # whoever executes it may go on, for nobody
    spin_for(executor, 1.0)
    assert isinstance(spun_to_its_end(executor, handle.cancel_goal_async()), ServiceError)


def spun_to_its_end(executor: SingleThreadedExecutor, future: Future[Any]) -> BaseException | None:
    spin_until(executor, future.done)
    return future.exception()


def test_a_server_goes_on_without_its_client(
    executor: SingleThreadedExecutor, serve: Callable[..., ActionServer], waiting: Waiting, node: Node
) -> None:
    server = serve(waiting, result_timeout=5)
    client = ActionClient(node, Fibonacci, "fibonacci")
    handle = accepted(executor, client)
    future = handle.get_result_async()
    spin_for(executor, 1.0)
    node.destroy_node()
    waiting.futures[0].set_result(ServerGoalHandle.succeed)
    spin_for(executor, 1.0)
    assert not future.done()
    assert waiting.handles[0].status == SUCCEEDED
    spin_for(executor, 10.0)
    assert not server._goal_handles


def test_a_goal_that_nobody_serves_stays_open_and_that_is_told(
    executor: SingleThreadedExecutor, client: ActionClient, log_lines: list[Record]
) -> None:
    assert not client.wait_for_server(timeout_sec=5.0)
    assert executor.context.time.now() == 5 * 10**9
    future = client.send_goal_async(Fibonacci.Goal(), feedback_callback=print)
    spin_for(executor, 1.0)
    assert not future.done()
    assert "/fibonacci: nobody serves this action" in log_lines[-1].message
    assert not client._feedback_callbacks
    with pytest.raises(ServiceError, match="nobody serves"):
        client.send_goal(Fibonacci.Goal())


def test_a_server_counts_when_all_of_it_is_there(
    client: ActionClient, serve: Callable[..., ActionServer], server_node: Node
) -> None:
    for part in ("SendGoal", "GetResult"):
        service = getattr(Fibonacci.Impl, f"{part}Service")
        name = {"SendGoal": "send_goal", "GetResult": "get_result"}[part]
        server_node.create_service(service, f"fibonacci/_action/{name}", print)
    assert not client.server_is_ready()
    serve()
    assert client.server_is_ready()
    assert client.wait_for_server()


def test_a_goal_may_be_given_up_before_it_is_answered(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve()
    future = client.send_goal_async(Fibonacci.Goal())
    future.cancel()
    spin_for(executor, 1.0)
    assert (future.cancelled(), future.done()) == (True, False)


def test_wrong_arguments(client: ActionClient, serve: Callable[..., ActionServer], node: Node) -> None:
    server = serve()
    for send in (client.send_goal, client.send_goal_async):
        with pytest.raises(TypeError, match=r"Expected .*Fibonacci_Goal|Expected .*Goal"):
            send(Fibonacci.Result())
        wrongs: list[Any] = [b"0123456789abcdef", "1", [0] * 16]
        for wrong in wrongs:
            with pytest.raises(TypeError, match=r"goal_uuid: expected a unique_identifier_msgs\.msg\.UUID"):
                send(Fibonacci.Goal(), goal_uuid=wrong)
    for ask in (client._cancel_goal_async, client._get_result_async):
        with pytest.raises(TypeError, match="Expected type ClientGoalHandle"):
            ask(UUID())  # type: ignore[arg-type] # what is tested
    with pytest.raises(TypeError, match="must be callable"):
        server.register_execute_callback(None)  # type: ignore[arg-type] # what is tested
    with pytest.raises(ValueError, match="no action class"):
        ActionClient(node, Fibonacci.Goal, "fibonacci")
    with pytest.raises(ValueError, match="topic name"):
        ActionServer(node, Fibonacci, "fibonacci!", fibonacci)


# --- Callbacks that block -----------------------------------------------------------------------------------------


def test_a_blocking_callback_is_cancelled_where_there_are_several_threads(context: Context) -> None:
    server_node, node = Node("server", context=context), Node("node", context=context)
    began = threading.Event()
    heard: list[Any] = []

    def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        turns = 0
        while not handle.is_cancel_requested:
            handle.publish_feedback(Fibonacci.Feedback(sequence=[turns]))
            began.set()
            turns += 1
            assert not threading.Event().wait(0.005)
        handle.canceled()
        return Fibonacci.Result(sequence=[turns])

    group = ReentrantCallbackGroup()
    ActionServer(server_node, Fibonacci, "fibonacci", execute, callback_group=group, cancel_callback=accept)
    client = ActionClient(node, Fibonacci, "fibonacci")
    with MultiThreadedExecutor(4, context=context) as several, SingleThreadedExecutor(context=context) as executor:
        several.add_node(server_node)
        executor.add_node(node)
        thread = threading.Thread(target=several.spin)
        thread.start()
        handle = accepted(executor, client, feedback_callback=heard.append)
        future = handle.get_result_async()
        assert began.wait(PATIENCE)
        spin_until(executor, lambda: len(heard) > 1, PATIENCE)
        assert len(done(executor, handle.cancel_goal_async()).goals_canceling) == 1
        answer = done(executor, future)
        several.shutdown()
        thread.join(PATIENCE)
    assert answer.status == CANCELED
    assert answer.result.sequence[0] >= 2


def test_a_blocking_callback_in_one_thread_still_tells_how_far_it_is(context: Context) -> None:
    server_node, node = Node("server", context=context), Node("node", context=context)
    go_on = threading.Event()
    heard: list[Any] = []

    def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        handle.publish_feedback(Fibonacci.Feedback(sequence=[1]))
        assert go_on.wait(PATIENCE)
        handle.succeed()
        return Fibonacci.Result()

    ActionServer(server_node, Fibonacci, "fibonacci", execute, cancel_callback=accept)
    client = ActionClient(node, Fibonacci, "fibonacci")
    with SingleThreadedExecutor(context=context) as server, SingleThreadedExecutor(context=context) as executor:
        server.add_node(server_node)
        executor.add_node(node)
        thread = threading.Thread(target=server.spin)
        thread.start()
        handle = accepted(executor, client, feedback_callback=heard.append)
        spin_until(executor, lambda: bool(heard), PATIENCE)
        wish = handle.cancel_goal_async()  # is read only afterwards
        go_on.set()
        assert done(executor, handle.get_result_async()).status == SUCCEEDED
        assert done(executor, wish).return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED
        server.shutdown()
        thread.join(PATIENCE)


# --- Waiting for a goal -------------------------------------------------------------------------------------------


def test_a_goal_may_be_sent_and_waited_for_from_another_thread(context: Context, spun: SingleThreadedExecutor) -> None:
    server_node, node = Node("server", context=context), Node("node", context=context)
    spun.add_node(server_node)
    spun.add_node(node)
    ActionServer(server_node, Fibonacci, "fibonacci", fibonacci, cancel_callback=accept)
    client = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server(PATIENCE)
    heard: list[int] = []
    answer = client.send_goal(
        Fibonacci.Goal(order=6), feedback_callback=lambda each: heard.append(each.feedback.sequence[-1])
    )
    assert list(answer.result.sequence) == [0, 1, 1, 2, 3, 5, 8]
    ended = spun.create_task(lambda: None)
    while not ended.done():
        threading.Event().wait(0.001)
    assert heard == [1, 2, 3, 5, 8]
    assert not client._feedback_callbacks


def test_a_callback_may_wait_for_a_goal_that_its_own_executor_serves(
    executor: SingleThreadedExecutor, node: Node, serve: Callable[..., ActionServer]
) -> None:
    serve()
    client = ActionClient(node, Fibonacci, "fibonacci")
    got: list[Any] = []
    heard: list[int] = []

    def ask() -> None:
        timer.cancel()
        got.append(client.send_goal(Fibonacci.Goal(order=3), feedback_callback=lambda _: heard.append(len(got))))

    timer = node.create_timer(1.0, ask)
    spin_for(executor, 5.0)
    assert list(got[0].result.sequence) == [0, 1, 1, 2]
    assert heard == [1, 1]  # the callback's own group is busy until it ends


def test_feedback_comes_while_a_callback_waits_if_its_group_lets_it(
    executor: SingleThreadedExecutor, node: Node, serve: Callable[..., ActionServer]
) -> None:
    serve()
    client = ActionClient(node, Fibonacci, "fibonacci", callback_group=ReentrantCallbackGroup())
    got: list[Any] = []
    heard: list[int] = []

    def ask() -> None:
        timer.cancel()
        got.append(client.send_goal(Fibonacci.Goal(order=3), feedback_callback=lambda _: heard.append(len(got))))

    timer = node.create_timer(1.0, ask)
    spin_for(executor, 5.0)
    assert (len(got), heard) == (1, [0, 0])


def test_a_goal_that_only_the_waiting_callback_could_serve_is_refused_at_once(
    executor: SingleThreadedExecutor, server_node: Node, serve: Callable[..., ActionServer]
) -> None:
    serve()
    client = ActionClient(server_node, Fibonacci, "fibonacci")
    problems: list[str] = []

    def ask() -> None:
        with pytest.raises(ServiceError) as refused:
            client.send_goal(Fibonacci.Goal(order=3))
        problems.append(str(refused.value))

    server_node.create_timer(1.0, ask)
    spin_for(executor, 1.5)
    assert "is served only by the callback group that this call keeps busy" in problems[0]


def test_a_rejected_goal_has_no_result_to_wait_for(context: Context, spun: SingleThreadedExecutor) -> None:
    node = Node("node", context=context)
    spun.add_node(node)
    ActionServer(node, Fibonacci, "fibonacci", fibonacci, goal_callback=lambda _: GoalResponse.REJECT)
    answer = ActionClient(node, Fibonacci, "fibonacci").send_goal(Fibonacci.Goal())
    assert answer.status == GoalStatus.STATUS_UNKNOWN


def test_a_goal_handle_waits_too(context: Context, spun: SingleThreadedExecutor, waiting: Waiting) -> None:
    node = Node("node", context=context)
    spun.add_node(node)
    ActionServer(node, Fibonacci, "fibonacci", waiting, cancel_callback=accept)
    client = ActionClient(node, Fibonacci, "fibonacci")
    arrived: Any = []
    there = threading.Event()

    def note(future: Future[ClientGoalHandle]) -> None:
        arrived.append(future.result())
        there.set()

    client.send_goal_async(Fibonacci.Goal(order=2)).add_done_callback(note)
    assert there.wait(PATIENCE)
    assert len(arrived[0].cancel_goal().goals_canceling) == 1
    waiting.futures[0].set_result(ServerGoalHandle.canceled)
    assert arrived[0].get_result().status == CANCELED


# --- The node that has an action ----------------------------------------------------------------------------------


def test_an_action_is_none_of_the_nodes_services_and_topics(node: Node, client: ActionClient) -> None:
    server = ActionServer(node, Fibonacci, "fibonacci", fibonacci)
    names = [each.topic_name for each in node.publishers] + [each.topic_name for each in node.subscriptions]
    names += [each.service_name for each in node.services] + [each.service_name for each in node.clients]
    assert not [each for each in names if "_action" in each]
    assert list(node.waitables) == [client, server]
    node.destroy_node()
    assert not list(node.waitables)
    assert server._destroyed


def test_an_action_is_gone_when_it_is_destroyed(node: Node, server_node: Node) -> None:
    with ActionServer(node, Fibonacci, "fibonacci", fibonacci):
        assert server_node.count_services("/fibonacci/_action/send_goal") == 1
    assert not [name for name, _ in server_node.get_service_names_and_types() if "_action" in name]
    assert not [name for name, _ in server_node.get_topic_names_and_types() if "_action" in name]
    assert not list(node.waitables)


def test_an_action_is_renamed_as_a_whole_or_by_its_parts(virtual: Context) -> None:
    arguments = ["--ros-args", "-r", "fibonacci:=sums", "-r", "/lab/sums/_action/status:=/state"]
    node = Node("node", context=virtual, namespace="lab", cli_args=arguments)
    ActionServer(node, Fibonacci, "fibonacci", fibonacci)
    topics = {name for name, _ in node.get_topic_names_and_types() if "sums" in name or "state" in name}
    assert topics == {"/lab/sums/_action/feedback", "/state"}
    services = {name for name, _ in node.get_service_names_and_types() if "_action" in name}
    assert services == {f"/lab/sums/_action/{part}" for part in ("send_goal", "cancel_goal", "get_result")}


def test_the_callbacks_are_in_the_actions_group(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    group = MutuallyExclusiveCallbackGroup()
    seen: list[bool] = []

    def note(answer: Any) -> Callable[[Any], Any]:
        def answered(_: object) -> Any:
            seen.append(not group.can_execute(None))
            return answer

        return answered

    def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        seen.append(group.can_execute(None))
        return fibonacci(handle)

    server = serve(execute, callback_group=group)
    server.register_goal_callback(note(GoalResponse.ACCEPT))
    server.register_cancel_callback(note(CancelResponse.ACCEPT))
    waited: list[ServerGoalHandle] = []

    def keep(handle: ServerGoalHandle) -> None:
        note(None)(handle)
        waited.append(handle)

    server.register_handle_accepted_callback(keep)
    handle = accepted(executor, client)
    done(executor, handle.cancel_goal_async())
    waited[0].execute()
    done(executor, handle.get_result_async())
    assert seen == [True] * 4
    assert group.has_entity(server)
    for register in (
        server.register_goal_callback,
        server.register_cancel_callback,
        server.register_handle_accepted_callback,
    ):
        register(None)
    assert done(executor, accepted(executor, client).get_result_async()).status == SUCCEEDED


def test_results_expire_by_the_nodes_own_clock(virtual: Context, executor: SingleThreadedExecutor) -> None:
    from robolink import Parameter
    from robolink.interfaces.rosgraph_msgs.msg import Clock

    node = Node("node", context=virtual, parameter_overrides=[Parameter("use_sim_time", value=True)])
    executor.add_node(node)
    clock = node.create_publisher(Clock, "/clock", 10)

    def show(seconds: float) -> None:
        clock.publish(Clock(clock=Time(seconds=seconds).to_msg()))
        spin_for(executor, 1.0)

    show(100)
    server = ActionServer(node, Fibonacci, "fibonacci", fibonacci, result_timeout=10)
    handle = accepted(executor, ActionClient(node, Fibonacci, "fibonacci"))
    assert handle.stamp.sec == 100
    spin_for(executor, 60.0)
    show(109)
    assert server._goal_handles
    show(111)
    assert not server._goal_handles


def test_in_virtual_time_goals_have_the_same_ids_each_time() -> None:
    def ids() -> list[bytes]:
        from robolink import VirtualTime
        from robolink.transport.memory import Bus, MemoryTransport

        context = Context(transport=MemoryTransport(bus=Bus()), time=VirtualTime())
        context.init([])
        with context:
            client = ActionClient(Node("node", context=context), Fibonacci, "fibonacci")
            return [bytes(client._request(Fibonacci.Goal()).goal_id.uuid) for _ in range(3)]

    first = ids()
    assert first == ids()
    assert len(set(first)) == 3


def test_events_have_rcls_numbers() -> None:
    assert [each.name for each in GoalEvent] == ["EXECUTE", "CANCEL_GOAL", "SUCCEED", "ABORT", "CANCELED"]
