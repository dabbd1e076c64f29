"""Parts of a node on asyncio's event loop: parameters, its clock, transforms, message filters."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from robolink import Context, Parameter
from robolink.clock_type import ClockType
from robolink.companions.message_filters import Subscriber, TimeSynchronizer
from robolink.exceptions import BlockingCallError, TimeSourceChangedError
from robolink.experimental import AsyncClock, AsyncNode
from robolink.interfaces.geometry_msgs.msg import PointStamped, TransformStamped
from robolink.interfaces.rcl_interfaces.msg import ParameterEvent, SetParametersResult
from robolink.interfaces.rcl_interfaces.srv import SetParameters
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.parameter_client import AsyncParameterClient
from robolink.parameter_event_handler import ParameterEventHandler
from robolink.tf2 import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformListener
from robolink.time import Time
from tests.support.loops import run, until

SIM_TIME = [Parameter("use_sim_time", Parameter.Type.BOOL, True)]


def at(seconds: float) -> Clock:
    return Clock(clock=Time(seconds=seconds).to_msg())


# Parameters


def test_parameters_are_set_by_others_and_told(context: Context) -> None:
    async def main() -> tuple[list[bool], list[Any], list[str]]:
        async with AsyncNode("owner", context=context) as owner, AsyncNode("other", context=context) as other:
            owner.declare_parameter("speed", 1.0)

            def refuse_negative(parameters: list[Parameter[Any]]) -> SetParametersResult:
                return SetParametersResult(successful=all(each.value >= 0 for each in parameters))

            owner.add_on_set_parameters_callback(refuse_negative)
            told: list[str] = []
            handler = ParameterEventHandler(other)
            handler.add_parameter_event_callback(
                lambda event: told.extend(each.name for each in event.changed_parameters)
            )
            client = AsyncParameterClient(other, "owner")
            assert await client.wait_for_services(timeout_sec=5.0)
            results: list[bool] = []
            for value in (2.0, -1.0):
                answer = await client.set_parameters([Parameter("speed", value=value)])
                assert answer is not None
                results.extend(each.successful for each in answer.results)
            got = await client.get_parameters(["speed"])
            assert got is not None
            await until(lambda: told)
            return results, [each.double_value for each in got.values], told

    assert run(main()) == ([True, False], [2.0], ["speed"])


def test_parameter_services_and_events_are_those_of_any_node(context: Context) -> None:
    async def main() -> list[str]:
        new: list[str] = []
        async with AsyncNode("node", context=context) as node:
            node.create_subscription(
                ParameterEvent, "/parameter_events", lambda event: new.extend(e.name for e in event.new_parameters), 10
            )
            node.declare_parameter("speed", 1)
            client = node.create_client(SetParameters, "node/set_parameters")
            request = SetParameters.Request(parameters=[Parameter("speed", value=5).to_parameter_msg()])
            assert (await client.call(request)).results[0].successful
            assert node.get_parameter("speed").value == 5
            await until(lambda: new)
        return new

    assert run(main()) == ["speed"]


# Clocks


def test_sleeps_and_timers_follow_clock(context: Context) -> None:
    events: list[str] = []

    async def main() -> None:
        async with AsyncNode("node", context=context, parameter_overrides=SIM_TIME) as node:
            publisher = node.create_publisher(Clock, "/clock", 10)
            clock = node.get_clock()
            publisher.publish(at(10))
            await until(lambda: clock.now().nanoseconds == 10 * 10**9)
            node.create_timer(2.0, lambda: events.append("timer"))
            sleep = asyncio.ensure_future(clock.sleep(1.0))
            sleep.add_done_callback(lambda _: events.append("sleep"))
            await asyncio.sleep(0.01)
            assert events == []
            publisher.publish(at(11))
            await until(lambda: len(events) == 1)
            publisher.publish(at(12))
            await until(lambda: len(events) == 2)

    run(main())
    assert events == ["sleep", "timer"]


@pytest.mark.parametrize("begins", [True, False])
def test_a_sleep_ends_with_an_error_when_the_source_of_time_changes(context: Context, begins: bool) -> None:
    async def main() -> None:
        parameter = Parameter("use_sim_time", value=not begins)
        async with AsyncNode("node", context=context, parameter_overrides=[parameter]) as node:
            change = [Parameter("use_sim_time", value=begins)]
            asyncio.get_running_loop().call_soon(node.set_parameters, change)
            with pytest.raises(TimeSourceChangedError):
                await node.get_clock().sleep(100.0)

    run(main())


@pytest.mark.parametrize("kind", [ClockType.SYSTEM_TIME, ClockType.STEADY_TIME, ClockType.ROS_TIME])
def test_a_clock_of_its_own_sleeps_not_shorter(kind: ClockType) -> None:
    async def main() -> int:
        clock = AsyncClock(clock_type=kind)
        assert clock.clock_type is kind
        before = clock.now()
        await clock.sleep(0.002)
        await clock.sleep(-1.0)
        return (clock.now() - before).nanoseconds

    assert run(main()) >= 2 * 10**6


def test_a_destroyed_clock_sleeps_no_more() -> None:
    async def main() -> None:
        clock = AsyncClock()
        sleep = asyncio.ensure_future(clock.sleep(100.0))
        await asyncio.sleep(0)
        clock.destroy()
        await asyncio.wait([sleep])
        assert sleep.cancelled()
        with pytest.raises(RuntimeError, match="destroyed clock"):
            await clock.sleep(1.0)

    run(main())


# Transforms and filters


def test_a_transform_is_awaited(context: Context) -> None:
    async def main() -> float:
        async with AsyncNode("node", context=context) as node:
            buffer = Buffer()
            TransformListener(buffer, node)
            transform = TransformStamped(child_frame_id="base")
            transform.header.frame_id = "map"
            transform.transform.translation.x = 2.0
            transform.transform.rotation.w = 1.0
            found = asyncio.ensure_future(_looked_up(buffer))
            await asyncio.sleep(0.001)
            with pytest.raises(BlockingCallError):
                buffer.lookup_transform("map", "base", Time(), timeout=_seconds(1.0))
            StaticTransformBroadcaster(node).sendTransform(transform)
            transform.child_frame_id = "other"
            TransformBroadcaster(node).sendTransform(transform)
            return await found

    assert run(main()) == 2.0


async def _looked_up(buffer: Buffer) -> float:
    found = await buffer.lookup_transform_async("map", "base", Time())
    assert found is not None
    return found.transform.translation.x


def _seconds(seconds: float) -> Any:
    from robolink.duration import Duration

    return Duration(seconds=seconds)


def test_filters_take_messages_of_the_node(context: Context) -> None:
    async def main() -> list[tuple[float, float]]:
        pairs: list[tuple[float, float]] = []
        async with AsyncNode("node", context=context) as node:
            left, right = (Subscriber(node, PointStamped, each) for each in ("left", "right"))
            filtered = TimeSynchronizer([left, right], 10)
            filtered.registerCallback(lambda one, other: pairs.append((one.point.x, other.point.x)))
            for topic, x in (("left", 1.0), ("right", 2.0)):
                message = PointStamped()
                message.header.stamp.sec, message.point.x = 5, x
                node.create_publisher(PointStamped, topic, 10).publish(message)
            await until(lambda: pairs)
        return pairs

    assert run(main()) == [(1.0, 2.0)]


@pytest.mark.parametrize("period", [-1.0, float("nan"), float("inf"), 1e300])
def test_a_period_that_is_not_a_time_is_refused(context: Context, period: float) -> None:
    node = AsyncNode("node", context=context)
    with pytest.raises(ValueError, match="a timer's period"):
        node.create_timer(period, print)
