"""Asynchronous nodes in virtual time: a service, an action and a faulty network, the same on each Python."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from robolink.faults import read_faults
from robolink.launch import read_launch_file
from robolink.simulate import SimulationResult, simulate

SENSOR = '''
import asyncio
import random
from std_msgs.msg import Int32
from std_srvs.srv import Trigger
from rclpy.experimental import AsyncNode

class Sensor(AsyncNode):
    """Publishes ten times a second; calibrating takes a while, and one at a time."""

    def __init__(self):
        super().__init__("sensor")
        self.values, self.count, self.ready = self.create_publisher(Int32, "values", 10), 0, asyncio.Lock()
        self.create_timer(0.1, self.measure)
        self.create_service(Trigger, "calibrate", self.calibrate, concurrent=True)

    async def measure(self):
        self.count += 1
        await asyncio.sleep(random.uniform(0.0, 0.05))
        self.values.publish(Int32(data=self.count))

    async def calibrate(self, request, response):
        async with self.ready:
            await self.get_clock().sleep(0.2)
        response.success, response.message = True, str(self.count)
        return response
'''

MOVER = '''
import asyncio
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse
from rclpy.experimental import AsyncNode

class Mover(AsyncNode):
    """Counts up to the order of a goal, with feedback."""

    def __init__(self):
        super().__init__("mover")
        accept = lambda goal: CancelResponse.ACCEPT
        ActionServer(self, Fibonacci, "move", self.move, cancel_callback=accept)

    async def move(self, goal):
        result = Fibonacci.Result()
        for number in range(goal.request.order):
            if goal.is_cancel_requested:
                goal.canceled()
                return result
            result.sequence.append(number)
            goal.publish_feedback(Fibonacci.Feedback(sequence=result.sequence))
            await asyncio.sleep(0.1)
        goal.succeed()
        return result
'''

PLANNER = """
import asyncio
import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.experimental import AsyncNode
from std_msgs.msg import Int32, String
from std_srvs.srv import Trigger

async def calibrating(node, said):
    client = node.create_client(Trigger, "calibrate")
    await client.wait_for_service()
    while True:
        try:
            answer = await asyncio.wait_for(client.call(Trigger.Request()), 0.4)
            said.publish(String(data="calibrated " + answer.message))
        except asyncio.TimeoutError:
            said.publish(String(data="no answer"))
        await node.get_clock().sleep(1.0)

async def moving(node, said):
    client, order = ActionClient(node, Fibonacci, "move"), 0
    await client.wait_for_server()
    while True:
        order = order % 9 + 1
        try:
            goal = await asyncio.wait_for(client.send_goal_async(Fibonacci.Goal(order=order)), 2.0)
            if order == 9:
                await asyncio.sleep(0.35)
                await asyncio.wait_for(goal.cancel_goal_async(), 2.0)
            result = (await asyncio.wait_for(goal.get_result_async(), 2.0)).result
            said.publish(String(data=f"moved {list(result.sequence)}"))
        except asyncio.TimeoutError:
            node.get_logger().warning(f"nothing came of {order}")
        await asyncio.sleep(0.5)

async def main():
    async with AsyncNode("planner") as node:
        said, values = node.create_publisher(String, "said", 10), asyncio.Queue()
        node.create_subscription(Int32, "values", lambda value: values.put_nowait(value.data), 10)
        tasks = [asyncio.create_task(each(node, said)) for each in (calibrating, moving)]
        try:
            while True:
                said.publish(String(data=f"sensed {await values.get()}"))
        finally:
            for each in tasks:
                each.cancel()

with rclpy.init():
    asyncio.run(main())
"""

SYSTEM = "nodes:\n  - node: ./sensor.py\n  - node: ./mover.py\n    respawn: true\n  - node: ./planner.py\n"

FAULTS = """
messages:
  - {topic: values, loss: 0.1, burst: 3, latency: 0.02, jitter: 0.01}
  - {service: calibrate, loss: 0.1, latency: 0.05, jitter: 0.1}
  - {service: "move/**", latency: 0.01, jitter: 0.02, loss: 0.02}
crashes:
  - {node: mover, at: 20.0, restart_after: 3.0}
clocks:
  - {node: planner, offset: 0.5, drift: 0.001}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, text in {"sensor.py": SENSOR, "mover.py": MOVER, "planner.py": PLANNER, "system.yaml": SYSTEM}.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "faults.yaml").write_text(FAULTS)
    return tmp_path


def live(folder: Path, seconds: float, seed: int = 1) -> SimulationResult:
    faults = read_faults(folder / "faults.yaml").value
    return simulate(read_launch_file(folder / "system.yaml"), duration=seconds, seed=seed, faults=faults)


KNOWN = "7a92710ce9dfadca554345d61282958a1f7e476aae05cbdacd16f3e8a5136b37"


def test_a_minute_of_three_asynchronous_nodes_is_the_same_on_every_python(folder: Path) -> None:
    took, result = float("inf"), live(folder, 60.0)
    for _ in range(2):
        begin = time.process_time()
        assert live(folder, 60.0).hash == result.hash
        took = min(took, time.process_time() - begin)
    assert result.hash == KNOWN
    assert (result.failures, result.real_time, result.errors) == ([], [], 0)
    assert result.messages["/said"] > 500 < result.messages["/values"]
    assert result.messages["/move/_action/feedback"] > 50
    assert all(each.lost and each.late for each in result.faults)
    assert took < 0.5


def test_another_seed_is_another_life(folder: Path) -> None:
    assert live(folder, 5.0, seed=1).hash != live(folder, 5.0, seed=2).hash


def test_an_asynchronous_node_shares_no_process(folder: Path) -> None:
    (folder / "shared.yaml").write_text(
        "nodes:\n  - {node: ./sensor.py, process: one}\n  - {node: ./mover.py, process: one}\n"
    )
    result = simulate(read_launch_file(folder / "shared.yaml"), duration=1.0)
    assert "an AsyncNode needs a process of its own: leave `process` out" in result.failures[0]
