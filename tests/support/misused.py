"""Programs that misuse asyncio with nodes, each with the way in which it ends: in real time as in virtual time."""

from __future__ import annotations

HEAD = """
import asyncio, threading, time
import robolink as rclpy
from robolink.action import ActionClient, ActionServer
from robolink.executors import SingleThreadedExecutor
from robolink.experimental import AsyncNode
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.node import Node
from robolink.signals import SignalHandlerOptions
from robolink.task import Future

async def cancelled(work):
    "Cancel a task of this work while it waits, and return how it has ended."
    task = asyncio.ensure_future(work)
    await asyncio.sleep(0.02)
    task.cancel()
    try:
        return await task
    except asyncio.CancelledError:
        return "cancelled"

async def answer(request, response):
    response.message = "here"
    return response

async def answers_still(node):
    "Fail if this node does not go on."
    node.create_service(Trigger, "still", answer)
    client = node.create_client(Trigger, "still")
    assert (await asyncio.wait_for(client.call(Trigger.Request()), 5.0)).message == "here"
"""

TAIL = """
with rclpy.init(signal_handler_options=SignalHandlerOptions.NO):
    asyncio.run(main())
"""

GROUP = r"ExceptionGroup: unhandled errors in a TaskGroup \(1 sub-exception\): "

ASYNCHRONOUS = {
    "a callback raises": (
        """
async def main():
    async with AsyncNode("a") as node:
        async def tick():
            await asyncio.sleep(0.01)
            raise ValueError("broken")
        node.create_timer(0.01, tick)
        await asyncio.Event().wait()
""",
        GROUP + "ValueError: broken",
    ),
    "a callback cannot be called": (
        """
async def main():
    async with AsyncNode("a") as node:
        node.create_timer(0.01, answer(None, None))
""",
        GROUP + "TypeError: a timer's callback must be callable, got <coroutine object answer",
    ),
    "a coroutine of a callback is not awaited": (
        """
async def main():
    async with AsyncNode("a") as node:
        node.create_timer(0.01, lambda: answer(None, None) and None)
        await asyncio.sleep(0.02)
        await answers_still(node)
""",
        "",
    ),
    "a task that nobody awaits raises": (
        """
async def broken():
    raise ValueError("broken")
async def main():
    async with AsyncNode("a") as node:
        node.create_timer(0.01, lambda: asyncio.ensure_future(broken()) and None)
        await asyncio.sleep(0.015)
        await answers_still(node)
""",
        "",
    ),
    "time.sleep in a callback": (
        """
async def main():
    async with AsyncNode("a") as node:
        node.create_timer(0.01, lambda: time.sleep(0.02))
        await asyncio.sleep(0.05)
        await answers_still(node)
""",
        "",
    ),
    "a blocking call in a callback": (
        """
async def main():
    async with AsyncNode("a") as node:
        client = ActionClient(node, Fibonacci, "nobody")
        node.create_timer(0.01, lambda: client.send_goal(Fibonacci.Goal()))
        await asyncio.Event().wait()
""",
        GROUP + "BlockingCallError: ",
    ),
    "a plain node's client waits in a callback, and nobody spins it": (
        """
async def main():
    async with AsyncNode("a") as node:
        client = Node("plain").create_client(Trigger, "nobody")
        node.create_timer(0.01, lambda: client.call(Trigger.Request(), timeout_sec=0.05))
        await asyncio.Event().wait()
""",
        GROUP + "TimeoutError: service /nobody: no answer within 0.05 s",
    ),
    "a wait is tested without await": (
        """
async def main():
    async with AsyncNode("a") as node:
        if ActionClient(node, Fibonacci, "nobody").wait_for_server(timeout_sec=0.1):
            pass
""",
        GROUP + "TypeError: await this wait first",
    ),
    "a call is cancelled": (
        """
async def main():
    async with AsyncNode("a") as node:
        client = node.create_client(Trigger, "nobody")
        assert await cancelled(client.call(Trigger.Request())) == "cancelled"
        await answers_still(node)
""",
        "",
    ),
    "a call is cancelled while it is answered": (
        """
async def main():
    async with AsyncNode("a") as node:
        async def never(request, response):
            await asyncio.Event().wait()
        node.create_service(Trigger, "slow", never)
        client = node.create_client(Trigger, "slow")
        assert await cancelled(client.call(Trigger.Request())) == "cancelled"
        await answers_still(node)
""",
        "",
    ),
    "a wait for a service is cancelled": (
        """
async def main():
    async with AsyncNode("a") as node:
        client = node.create_client(Trigger, "nobody")
        assert await cancelled(client.wait_for_service()) == "cancelled"
        assert await cancelled(node.wait_for_node("nobody")) == "cancelled"
        await answers_still(node)
""",
        "",
    ),
    "a sleep is cancelled": (
        """
async def main():
    async with AsyncNode("a") as node:
        assert await cancelled(node.get_clock().sleep(1e6)) == "cancelled"
        await answers_still(node)
""",
        "",
    ),
    "a goal is cancelled in each state": (
        """
async def main():
    async with AsyncNode("a") as node:
        async def move(goal):
            await asyncio.Event().wait()
        client = ActionClient(node, Fibonacci, "move")
        async def send():
            return await client.send_goal_async(Fibonacci.Goal())
        async def finish(goal):
            return await goal.get_result_async()
        assert await cancelled(send()) == "cancelled"
        server = ActionServer(node, Fibonacci, "move", move)
        await client.wait_for_server()
        goal = await asyncio.wait_for(send(), 5.0)
        assert await cancelled(finish(goal)) == "cancelled"
        await answers_still(node)
""",
        "",
    ),
    "a loop never yields": (
        """
async def main():
    async with AsyncNode("a") as node:
        node.create_timer(0.01, lambda: None)
        await asyncio.sleep(0)
        begin = time.monotonic()
        while time.monotonic() < begin + 0.05:
            await asyncio.sleep(0)
        await answers_still(node)
""",
        "",
    ),
    "two loops": (
        """
async def main():
    async with AsyncNode("a") as node:
        client = node.create_client(Trigger, "nobody")
        def elsewhere():
            return asyncio.run(asyncio.wait_for(node.run(), 1.0))
        await asyncio.to_thread(elsewhere)
""",
        GROUP + "RuntimeError: node /a is already running",
    ),
    "a call from another loop": (
        """
async def main():
    async with AsyncNode("a") as node:
        node.create_service(Trigger, "here", answer)
        client = node.create_client(Trigger, "here")
        def elsewhere():
            return asyncio.run(asyncio.wait_for(client.call(Trigger.Request()), 2.0))
        assert (await asyncio.to_thread(elsewhere)).message == "here"
""",
        "",
    ),
    "asyncio.run in a callback": (
        """
async def main():
    async with AsyncNode("a") as node:
        def tick():
            work = asyncio.sleep(0)
            try:
                asyncio.run(work)
            finally:
                work.close()
        node.create_timer(0.01, tick)
        await asyncio.Event().wait()
""",
        GROUP + r"RuntimeError: asyncio.run\(\) cannot be called from a running event loop",
    ),
    "a future of another loop": (
        """
async def main():
    async with AsyncNode("a") as node:
        other = asyncio.new_event_loop()
        async def tick():
            try:
                await other.create_future()
            finally:
                other.close()
        node.create_timer(0.01, tick)
        await asyncio.Event().wait()
""",
        GROUP + "RuntimeError: .*attached to a different loop",
    ),
    "spin of an asynchronous node": ("async def main():\n    rclpy.spin(AsyncNode('a'))", "TypeError: .*AsyncNode"),
    "an executor gets an asynchronous node": (
        "async def main():\n    SingleThreadedExecutor().add_node(AsyncNode('a'))",
        "TypeError: .*AsyncNode",
    ),
    "spin of a plain node in the loop": (
        """
async def main():
    node = Node("plain")
    node.create_timer(0.02, rclpy.shutdown)
    rclpy.spin(node)
""",
        "",
    ),
    "spin of a plain node in a callback": (
        """
async def main():
    async with AsyncNode("a") as node:
        plain = Node("plain")
        node.create_timer(0.01, lambda: rclpy.spin_once(plain, timeout_sec=0.02))
        await asyncio.sleep(0.05)
        await answers_still(node)
""",
        "",
    ),
    "a plain node's callback awaits asyncio": (
        """
async def main():
    node = Node("plain")
    async def tick():
        await asyncio.sleep(0.01)
    node.create_timer(0.01, tick)
    while True:
        rclpy.spin_once(node, timeout_sec=0)
        await asyncio.sleep(0.001)
""",
        "RuntimeError: await wasn't used with future",
    ),
    "asyncio.run in a plain node's callback": (
        """
async def main():
    node, work = Node("plain"), asyncio.sleep(0)
    node.create_timer(0.01, lambda: asyncio.run(work))
    rclpy.spin(node)
""",
        r"RuntimeError: asyncio.run\(\) cannot be called from a running event loop",
    ),
    "a plain node's callback awaits asyncio where no loop runs": (
        """
async def main():
    node = Node("plain")
    node.create_timer(0.01, lambda: asyncio.sleep(0.01))
    async def tick():
        await asyncio.sleep(0.01)
    node.create_timer(0.01, tick)
    await asyncio.to_thread(rclpy.spin, node)
""",
        "RuntimeError: no running event loop",
    ),
    "spin until a future of asyncio is done": (
        """
async def main():
    future = asyncio.get_running_loop().create_future()
    rclpy.spin_until_future_complete(Node("plain"), future, timeout_sec=0.05)
    assert not future.done()
""",
        "",
    ),
    "a future that nobody completes": (
        "async def main():\n    await asyncio.wait_for(Future(), 0.05)",
        "TimeoutError: ",
    ),
    "a node is entered twice": (
        """
async def main():
    async with AsyncNode("a") as node:
        await node.run()
""",
        GROUP + "RuntimeError: node /a is already running",
    ),
    "a node is used after its end": (
        """
async def main():
    async with AsyncNode("a") as node:
        pass
    node.create_publisher(Int32, "a", 10)
""",
        "InvalidHandle: ",
    ),
    "a node calls itself and ends meanwhile": (
        """
async def main():
    async with AsyncNode("a") as node:
        node.create_timer(0.02, node.destroy_node)
        await node.create_client(Trigger, "nobody").call(Trigger.Request())
""",
        "CancelledError: ",
    ),
    "the context ends in a callback": (
        """
async def main():
    node = AsyncNode("a")
    node.create_timer(0.01, rclpy.shutdown)
    await node.run()
""",
        "",
    ),
    "a node is made where no context is": (
        "async def main():\n    rclpy.shutdown()\n    AsyncNode('a')",
        "NotInitializedException: ",
    ),
    "a node is run without await": ("async def main():\n    AsyncNode('a').run()", ""),
    "a node is no coroutine": (
        "main = lambda: AsyncNode('a')",
        "(ValueError|TypeError): .*(coroutine|awaitable).*",
    ),
}
"""Program and end, by name of the case: the text of its exception, with its kind; '' where it goes on."""
