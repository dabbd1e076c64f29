"""robolink's nodes, by rclpy's API alone, so that they run with any version of it.

Variants: `spin` is `rclpy.spin(node)`, `once` is `rclpy.spin_once(node)` in a loop, `threads` is a
MultiThreadedExecutor; each at both ends. In `loop` the first end sends between two calls of `spin_once`, as most
programs do, instead of in its callback.
"""

from __future__ import annotations

import os
import time
from typing import Any

import robolink as rclpy
from benchmarks.messages.games import Count, Ping, Task, pour, say, say_ready
from benchmarks.messages.samples import message_type, sample
from robolink.context import Context
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.qos import HistoryPolicy, QoSProfile

STORED = 10
"""Depth of the queues of large messages, as a camera's would be; of small ones all are kept."""


def started(name: str) -> Any:
    rclpy.init(args=[], domain_id=int(os.environ["ROS_DOMAIN_ID"]))
    return rclpy.create_node(name)


def run(node: Any, task: Task) -> None:
    """Spin for ever."""
    if task.variant in ("once", "loop"):
        while True:
            rclpy.spin_once(node)
    if task.variant == "threads":
        executor = MultiThreadedExecutor(num_threads=2)
        executor.add_node(node)
        executor.spin()
    rclpy.spin(node)


def pong(task: Task) -> None:
    node, message_class = started("pong"), message_type(task.kind)
    back = node.create_publisher(message_class, "pong", 10).publish

    def on_ping(message: Any) -> None:
        look(message)
        back(message)

    node.create_subscription(message_class, "ping", on_ping if task.large else back, 10)
    say_ready()
    run(node, task)


def ping(task: Task) -> None:
    node, game, message = started("ping"), Ping(task.seconds), sample(task.kind)
    out = node.create_publisher(type(message), "ping", 10)
    publish, large = out.publish, task.large
    due: list[bool] = []  # what is to be sent between two spins

    def on_pong(answer: Any) -> None:
        if large:
            look(answer)
        if game.answered():
            due.append(True) if task.variant == "loop" else publish(message)
        elif game.checked is None:
            game.checked = answer == message

    node.create_subscription(type(message), "pong", on_pong, 10)
    wait_for_match(out)
    game.play(lambda: publish(message), lambda seconds: rclpy.spin_once(node, timeout_sec=seconds))
    while task.variant == "loop":
        rclpy.spin_once(node)
        if due:
            due.pop()
            publish(message)
    run(node, task)


def look(image: Any) -> int:
    """Ask for the pixels, as who gets an image does: what is not asked for need not be made."""
    return int(image.data[-1])


def flood_qos(task: Task) -> QoSProfile:
    return QoSProfile(depth=STORED) if task.large else QoSProfile(depth=1, history=HistoryPolicy.KEEP_ALL)


def sink(task: Task) -> None:
    node, count = started("sink"), Count()

    def on_image(image: Any) -> None:
        look(image)
        count.add(image)

    callback = on_image if task.large else count.add
    node.create_subscription(message_type(task.kind), "flood", callback, flood_qos(task))
    count.answer()
    say_ready()
    run(node, task)


def source(task: Task) -> None:
    node, message = started("source"), sample(task.kind)
    out = node.create_publisher(type(message), "flood", flood_qos(task))
    wait_for_match(out)
    time.sleep(0.2)
    pour(task, out.publish, message)


def wait_for_match(out: Any) -> None:
    while not out.get_subscription_count():
        time.sleep(0.005)


def inside(task: Task) -> None:
    """Publisher and subscription in one process: times up to the pixels in the callback. `variant` is the transport."""
    context = Context(transport="memory://bench") if task.variant == "memory" else Context()
    context.init(args=[], domain_id=int(os.environ["ROS_DOMAIN_ID"]))
    node, message = rclpy.create_node("both", context=context), sample(task.kind)
    out = node.create_publisher(type(message), "inside", 10)
    times: list[float] = []
    sent, end = 0.0, time.perf_counter() + task.seconds

    def on_message(answer: Any) -> None:
        nonlocal sent
        look(answer)
        now = time.perf_counter()
        times.append(1e6 * (now - sent))
        if now > end:
            assert answer == message
            say([round(each, 1) for each in times[len(times) // 4 :]])
            os._exit(0)
        publish_again()

    def publish_again() -> None:
        nonlocal sent
        sent = time.perf_counter()
        out.publish(message)

    node.create_subscription(type(message), "inside", on_message, 10)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    publish_again()
    executor.spin()


def copies(task: Task) -> None:
    """Nothing but a copy of the message's bytes, to fresh memory: the least that handing it on can cost."""
    data, times = bytearray(task.size), []
    end = time.perf_counter() + task.seconds
    while (begin := time.perf_counter()) < end:
        _copy = bytes(data)
        times.append(1e6 * (time.perf_counter() - begin))
    say([round(each, 1) for each in times])
    os._exit(0)
