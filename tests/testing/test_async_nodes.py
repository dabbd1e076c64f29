"""AsyncNode classes in the system of a test: in virtual time, with faults, ends and starts."""

from __future__ import annotations

import asyncio

import pytest

from robolink.experimental import AsyncNode
from robolink.interfaces.std_msgs.msg import Int32
from robolink.testing import NodeFailure, System


class Talker(AsyncNode):
    """Publishes 1, 2, 3 ... a while after each tick, and says goodbye."""

    def __init__(self) -> None:
        super().__init__("talker")
        self.first = self.declare_parameter("first", 0).value
        self.numbers = self.create_publisher(Int32, "numbers", 10)
        self.create_timer(0.1, self.tick)
        self.work = asyncio.get_running_loop().create_task(self.end())

    async def tick(self) -> None:
        self.first += 1
        await asyncio.sleep(0.05)
        self.numbers.publish(Int32(data=self.first))

    async def end(self) -> None:
        try:
            await asyncio.Event().wait()
        finally:
            self.get_logger().info("goodbye")


class Hearer(AsyncNode):
    def __init__(self) -> None:
        super().__init__("hearer")
        self.heard = list[tuple[int, float]]()
        self.create_subscription(Int32, "numbers", self.hear, 10)

    async def hear(self, number: Int32) -> None:
        await self.get_clock().sleep(0.01)
        self.heard.append((number.data, self.get_clock().now().nanoseconds / 1e9))


def test_a_system_starts_stops_crashes_and_restarts_asynchronous_nodes(tested: System) -> None:
    hearer = tested.start(Hearer)
    talker = tested.start(Talker, namespace="there", parameters={"first": 10}, remappings={"numbers": "/numbers"})
    assert tested.nodes == ["/hearer", "/there/talker"]
    tested.run(0.5)
    assert hearer.heard == [(11, 1.16), (12, 1.26), (13, 1.36), (14, 1.46)]
    tested.stop(talker)
    tested.expect_log("goodbye")
    assert tested.nodes == ["/hearer"]
    talker = tested.restart(talker)
    tested.run(0.5)
    assert [number for number, _ in hearer.heard[4:]] == [11, 12, 13, 14]
    tested.crash(talker)
    tested.run(0.5)
    assert len(hearer.heard) == 8
    assert tested.failures == []
    tested.restart("there/talker")
    tested.run(0.3)
    assert len(hearer.heard) == 10


def test_faults_reach_asynchronous_nodes(tested: System) -> None:
    hearer, _ = tested.start(Hearer), tested.start(Talker)
    tested.faults.lose("numbers", 1.0, during=1.0)
    tested.faults.delay("numbers", 0.25)
    tested.run(2.0)
    assert hearer.heard[0] == (10, 2.31)


class Breaks(AsyncNode):
    def __init__(self) -> None:
        super().__init__("breaks")
        self.create_timer(0.1, self.tick)

    async def tick(self) -> None:
        await asyncio.sleep(0.05)
        raise ValueError("no more")


def test_what_a_callback_raises_fails_the_test_where_it_waits(tested: System) -> None:
    tested.start(Breaks)
    with pytest.raises(NodeFailure, match=r"breaks failed at 0\.15 s: ValueError: no more \(test_async_nodes\.py:"):
        tested.run(1.0)
    (failure,) = tested.failures
    assert (failure.time_ns, type(failure.error)) == (1_150_000_000, ValueError)
