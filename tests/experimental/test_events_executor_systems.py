"""Systems of two or three nodes spun by an EventsExecutor: the cases of rclpy's own tests of it, retold.

Each runs in virtual time and, as users' programs do, over Zenoh.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from robolink import Context, Future, Node, Parameter
from robolink.action import ActionClient, ActionServer
from robolink.action.server import ServerGoalHandle
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from robolink.experimental import EventsExecutor
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.std_msgs.msg import Int32
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from robolink.time import Time
from robolink.timer import TimerInfo
from tests.support.spins import done, spin_for, spin_until
from tests.support.transports import KEEP_ALL, Network

LATCHED = QoSProfile(history=HistoryPolicy.KEEP_ALL, durability=DurabilityPolicy.TRANSIENT_LOCAL)
SIM_TIME = [Parameter("use_sim_time", value=True)]
A_WHILE = 0.1
"""Time in seconds in which something would have happened, if it were to."""


@pytest.fixture(params=["virtual", "zenoh"])
def world(request: pytest.FixtureRequest) -> Iterator[Context]:
    """A context in memory and virtual time, and one over Zenoh."""
    if request.param == "virtual":
        yield request.getfixturevalue("virtual")
        return
    network: Network = request.getfixturevalue("zenoh_net")
    made = Context(transport=network.session())
    made.init([])
    with made:
        yield made


@pytest.fixture
def events(world: Context) -> Iterator[EventsExecutor]:
    with EventsExecutor(context=world) as made:
        yield made


@pytest.fixture
def server(world: Context, events: EventsExecutor) -> Node:
    return added(events, "server")


@pytest.fixture
def client(world: Context, events: EventsExecutor) -> Node:
    return added(events, "client")


@pytest.fixture
def clock(events: EventsExecutor) -> SimulatedClock:
    return SimulatedClock(events)


def added(events: EventsExecutor, name: str, **options: Any) -> Node:
    """Make a node and add it."""
    made = Node(name, context=events.context, **options)
    events.add_node(made)
    return made


class SimulatedClock:
    """Publisher of /clock, which goes on when it is told to."""

    def __init__(self, events: EventsExecutor) -> None:
        node = added(events, "clock")
        best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._publisher = node.create_publisher(Clock, "/clock", best_effort)
        self._milliseconds = 0

    def advance(self, milliseconds: int) -> None:
        self._milliseconds += milliseconds
        self._publisher.publish(Clock(clock=self.now.to_msg()))

    @property
    def now(self) -> Time:
        return Time(nanoseconds=self._milliseconds * 10**6)


class Once:
    """Callback that completes a future by its next argument; new futures by `next`."""

    def __init__(self) -> None:
        self.future = self.next()

    def next(self) -> Future[Any]:
        self.future = Future[Any]()
        return self.future

    def __call__(self, argument: Any) -> None:
        if not self.future.done():
            self.future.set_result(argument)


def counts(info: Any) -> tuple[int, int]:
    return info.total_count, info.current_count


# Topics


def test_a_publisher_and_a_subscription_that_meet_and_part(events: EventsExecutor, server: Node, client: Node) -> None:
    message, met, left = Once(), Once(), Once()
    subscription = server.create_subscription(
        Int32, "topic", message, KEEP_ALL, event_callbacks=SubscriptionEventCallbacks(matched=met)
    )
    spin_for(events, A_WHILE)
    assert not met.future.done()

    publisher = client.create_publisher(Int32, "topic", KEEP_ALL, event_callbacks=PublisherEventCallbacks(matched=left))
    assert counts(done(events, met.future)) == (1, 1)
    assert counts(done(events, left.future)) == (1, 1)
    met.next()
    left.next()
    for number in range(50):
        publisher.publish(Int32(data=number))
        assert done(events, message.future).data == number
        message.next()

    server.destroy_subscription(subscription)
    assert counts(done(events, left.future)) == (1, 0)
    left.next()
    publisher.publish(Int32(data=50))
    events.remove_node(server)
    server.destroy_node()
    spin_for(events, A_WHILE)
    assert not any(each.future.done() for each in (met, left, message))


def test_a_coroutine_hears_a_topic(events: EventsExecutor, server: Node, client: Node) -> None:
    message = Once()

    async def hear(heard: Int32) -> None:
        message(heard)

    server.create_subscription(Int32, "topic", hear, KEEP_ALL)
    spin_for(events, A_WHILE)
    publisher = client.create_publisher(Int32, "topic", KEEP_ALL)
    spin_until(events, lambda: publisher.get_subscription_count() == 1)
    publisher.publish(Int32(data=7))
    assert done(events, message.future).data == 7


def test_all_that_was_published_before_comes_to_a_late_subscription(events: EventsExecutor, server: Node) -> None:
    publisher = server.create_publisher(Int32, "topic", LATCHED)
    for number in range(5):
        publisher.publish(Int32(data=number))
    late, heard = Node("late", context=events.context), list[int]()
    late.create_subscription(Int32, "topic", lambda message: heard.append(message.data), LATCHED)
    spin_for(events, A_WHILE)
    assert heard == []  # its node is not spun yet
    events.add_node(late)
    spin_until(events, lambda: len(heard) == 5)
    spin_for(events, A_WHILE)
    assert heard == [0, 1, 2, 3, 4]
    publisher.publish(Int32(data=5))
    spin_until(events, lambda: len(heard) == 6)


# Services


def test_each_request_is_answered_until_the_server_has_gone(events: EventsExecutor, server: Node, client: Node) -> None:
    request = Once()

    def add(asked: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        request(asked)
        response.sum = asked.a + asked.b
        return response

    server.create_service(AddTwoInts, "add", add)
    adder = client.create_client(AddTwoInts, "add")
    spin_until(events, adder.service_is_ready)
    for number in range(50):
        answer = adder.call_async(AddTwoInts.Request(a=number, b=1))
        assert done(events, request.future).a == number
        request.next()
        assert done(events, answer).sum == number + 1

    events.remove_node(server)
    server.destroy_node()
    answer = adder.call_async(AddTwoInts.Request())
    spin_for(events, A_WHILE)
    assert not request.future.done()
    assert not answer.done()


def test_a_service_awaits_a_timer_of_simulated_time(
    events: EventsExecutor, client: Node, clock: SimulatedClock
) -> None:
    server, request = added(events, "simulated", parameter_overrides=SIM_TIME), Once()

    async def serve(asked: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        request(asked)
        rung = Future[None]()
        timer = server.create_timer(1.0, lambda: rung.set_result(None), callback_group=ReentrantCallbackGroup())
        await rung
        server.destroy_timer(timer)
        response.sum = asked.a
        return response

    server.create_service(AddTwoInts, "add", serve)
    adder = client.create_client(AddTwoInts, "add")
    spin_until(events, adder.service_is_ready)
    answer = adder.call_async(AddTwoInts.Request(a=7))
    assert done(events, request.future).a == 7
    spin_for(events, A_WHILE)
    assert not answer.done()
    clock.advance(1000)
    assert done(events, answer).sum == 7


# Timers


def test_timers_tick_by_the_clock_of_their_node(events: EventsExecutor, clock: SimulatedClock) -> None:
    real, simulated = added(events, "real"), added(events, "simulated", parameter_overrides=SIM_TIME)
    infos: dict[str, list[TimerInfo]] = {"real": [], "simulated": []}

    def note_real(info: TimerInfo) -> None:
        infos["real"].append(info)

    def note_simulated(info: TimerInfo) -> None:
        infos["simulated"].append(info)

    real.create_timer(0.02, note_real)
    simulated.create_timer(0.1, note_simulated)
    spin_until(events, lambda: len(infos["real"]) > 3)
    assert infos["simulated"] == []
    assert all(each.actual_call_time >= each.expected_call_time for each in infos["real"])

    for _ in range(99):
        clock.advance(1)
    spin_for(events, A_WHILE)
    assert infos["simulated"] == []
    clock.advance(1)
    spin_until(events, lambda: len(infos["simulated"]) == 1)
    (info,) = infos["simulated"]
    assert info.actual_call_time.nanoseconds == info.expected_call_time.nanoseconds == clock.now.nanoseconds
    for tick in range(2, 50):
        clock.advance(100)
        spin_until(events, lambda tick=tick: len(infos["simulated"]) == tick)  # type: ignore[misc]


def test_of_two_timers_due_at_once_the_first_can_cancel_the_other(
    events: EventsExecutor, clock: SimulatedClock
) -> None:
    simulated, calls = added(events, "simulated", parameter_overrides=SIM_TIME), list[str]()

    def cancel_both() -> None:
        calls.append("called")
        for timer in timers:
            timer.cancel()

    timers = [simulated.create_timer(0.01, cancel_both) for _ in range(2)]
    spin_for(events, A_WHILE)
    assert calls == []
    for _ in range(2):
        clock.advance(10)
        spin_for(events, 0.0)  # the time that has come, and the timers for which it has
        assert calls == ["called"]


# Actions


class Steps:
    """Action server whose goals go on step by step, when the test says so."""

    def __init__(self, node: Node) -> None:
        self.goal = Once()
        self.sequence: list[int] = []
        ActionServer(
            node, Fibonacci, "fibonacci", self._execute, handle_accepted_callback=self._accept, result_timeout=10
        )

    def _accept(self, handle: ServerGoalHandle) -> None:
        self.sequence = [0, 1]
        self.goal(handle)

    def step(self, handle: ServerGoalHandle) -> None:
        self.sequence.append(sum(self.sequence[-2:]))
        handle.publish_feedback(Fibonacci.Feedback(sequence=self.sequence))

    def _execute(self, handle: ServerGoalHandle) -> Fibonacci.Result:
        handle.succeed()
        return Fibonacci.Result(sequence=self.sequence)


def test_goals_are_executed_and_the_last_is_forgotten_in_simulated_time(
    events: EventsExecutor, client: Node, clock: SimulatedClock
) -> None:
    node = added(events, "simulated", parameter_overrides=SIM_TIME)
    steps, feedback = Steps(node), Once()
    clock.advance(0)
    sender = ActionClient(client, Fibonacci, "fibonacci")
    spin_until(events, sender.server_is_ready)
    for order in range(1, 15):
        acknowledged = sender.send_goal_async(
            Fibonacci.Goal(order=order), feedback_callback=lambda message: feedback(message.feedback)
        )
        handle: ServerGoalHandle = done(events, steps.goal.future)
        assert handle.request.order == order
        steps.goal.next()
        result = done(events, acknowledged).get_result_async()
        while len(steps.sequence) <= order:
            feedback.next()
            steps.step(handle)
            assert done(events, feedback.future).sequence.tolist() == steps.sequence
        feedback.next()
        handle.execute()
        assert len(done(events, result).result.sequence) == max(order + 1, 2)
        assert not feedback.future.done()

    assert handle.status == GoalStatus.STATUS_SUCCEEDED
    clock.advance(9999)
    spin_for(events, A_WHILE)
    assert handle.status == GoalStatus.STATUS_SUCCEEDED
    clock.advance(2)
    spin_for(events, A_WHILE)
    assert handle.status == GoalStatus.STATUS_UNKNOWN

    events.remove_node(node)
    node.destroy_node()
    acknowledged = sender.send_goal_async(Fibonacci.Goal(order=5))
    spin_for(events, A_WHILE)
    assert not steps.goal.future.done()
    assert not acknowledged.done()
