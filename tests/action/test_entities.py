"""An action as a part of its node: its names, its callback group, its clock, its end."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink import Context, Node, Time
from robolink.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from robolink.action.server import GoalEvent, ServerGoalHandle
from robolink.callback_groups import MutuallyExclusiveCallbackGroup
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.example_interfaces.action import Fibonacci
from tests.support.goals import SUCCEEDED, accepted, fibonacci
from tests.support.spins import done, spin_for


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
