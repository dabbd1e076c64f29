"""Introspection of an action: the events of its three services, from both ends."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink import Node
from robolink.action import ActionClient, ActionServer
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.service_msgs.msg import ServiceEventInfo
from robolink.qos import qos_profile_system_default
from robolink.service_introspection import ServiceIntrospectionState
from tests.support.goals import accepted
from tests.support.spins import done, spin_for


def test_both_ends_tell_of_goals_and_results_until_they_are_to_be_silent(
    node: Node, client: ActionClient, serve: Callable[..., ActionServer], executor: SingleThreadedExecutor
) -> None:
    server, events = serve(), dict[str, list[int]]()
    for part, srv_type in (("send_goal", "SendGoalService"), ("get_result", "GetResultService")):
        heard: list[int] = events.setdefault(part, [])

        def note(event: Any, heard: list[int] = heard) -> None:
            heard.append(event.info.event_type)

        kind = getattr(Fibonacci.Impl, srv_type).Event
        node.create_subscription(kind, f"/fibonacci/_action/{part}/_service_event", note, 20)
    for end in (client, server):
        end.configure_introspection(node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.METADATA)
    done(executor, accepted(executor, client, 1).get_result_async())
    spin_for(executor, 0.1)
    every = {
        ServiceEventInfo.REQUEST_SENT,
        ServiceEventInfo.REQUEST_RECEIVED,
        ServiceEventInfo.RESPONSE_SENT,
        ServiceEventInfo.RESPONSE_RECEIVED,
    }
    assert {part: set(heard) for part, heard in events.items()} == {"send_goal": every, "get_result": every}
    for end in (client, server):
        end.configure_introspection(node.get_clock(), qos_profile_system_default, ServiceIntrospectionState.OFF)
    events["send_goal"].clear()
    accepted(executor, client, 1)
    spin_for(executor, 0.1)
    assert events["send_goal"] == []
