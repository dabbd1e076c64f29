"""Nodes by rclpy's API alone: those of any version of robolink, and those of a real rclpy, where that is installed.

Variants: `spin` is `rclpy.spin(node)`, `once` is `rclpy.spin_once(node)` in a loop, `threads` is a
MultiThreadedExecutor; each at both ends. In `loop` the first end sends between two calls of `spin_once`, as most
programs do, instead of in its callback. Of floods: `depth-10` and so on; else KEEP_ALL, and a depth of 10 for images.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import time
from typing import Any

with contextlib.suppress(ImportError):  # a Python with a real rclpy has no robolink
    import robolink.compat  # noqa: F401
from benchmarks.messages.games import Beat, Count, Ping, Task, pour, say, say_ready
from benchmarks.messages.samples import counting, message_type, sample

rclpy: Any = importlib.import_module("rclpy")
executors: Any = importlib.import_module("rclpy.executors")
qos: Any = importlib.import_module("rclpy.qos")

STORED = 10
"""Depth of the queues of large messages, as a camera's would be; of small ones all are kept."""


def started(name: str) -> Any:
    rclpy.init(args=[], domain_id=int(os.environ["ROS_DOMAIN_ID"]))
    return rclpy.create_node(name)


def trigger() -> Any:
    return importlib.import_module("std_srvs.srv").Trigger


def run(node: Any, task: Task) -> None:
    """Spin for ever."""
    if task.variant in ("once", "loop"):
        while True:
            rclpy.spin_once(node)
    if task.variant == "threads":
        executor = executors.MultiThreadedExecutor(num_threads=2)
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


def flood_qos(task: Task) -> Any:
    if task.variant.startswith("depth-"):
        return qos.QoSProfile(depth=int(task.variant.removeprefix("depth-")))
    return qos.QoSProfile(depth=STORED) if task.large else qos.QoSProfile(depth=1, history=qos.HistoryPolicy.KEEP_ALL)


def sink(task: Task) -> None:
    node, count = started("sink"), Count()
    node.create_subscription(message_type(task.kind), "flood", counting(task.kind, count.add), flood_qos(task))
    count.answer()
    say_ready()
    run(node, task)


def source(task: Task) -> None:
    node, message = started("source"), sample(task.kind)
    out = node.create_publisher(type(message), "flood", flood_qos(task))
    publish, stamp = out.publish, None if task.kind == "twist" else message.header.stamp

    def send(number: int) -> None:
        if stamp is None:
            message.linear.x = float(number)
        else:
            stamp.nanosec = number
        publish(message)

    wait_for_match(out)
    time.sleep(0.2)
    pour(task, send)


def beat(task: Task) -> None:
    """Publish from a timer, to a sink."""
    node, message = started("beat"), sample(task.kind)
    out = node.create_publisher(type(message), "flood", flood_qos(task))
    wait_for_match(out)
    beats = Beat(task, lambda: out.publish(message))
    node.create_timer(Beat.PERIOD, beats.tick)
    rclpy.spin(node)


def crowd(task: Task) -> None:
    """Make some nodes in one process, and say when the first of them knows so many; `variant` is `NUMBER-EACH-ALL`."""
    number, each, everybody = (int(word) for word in task.variant.split("-"))
    rclpy.init(args=[], domain_id=int(os.environ["ROS_DOMAIN_ID"]))
    executor = executors.SingleThreadedExecutor()
    nodes = [rclpy.create_node(f"node_{number}_{index}") for index in range(each)]
    for node in nodes:
        node.create_publisher(message_type("twist"), f"{node.get_name()}/out", 10)
        node.create_subscription(message_type("twist"), f"{node.get_name()}/in", look, 10)
        executor.add_node(node)
    due = time.monotonic()
    while len(nodes[0].get_node_names()) < everybody:
        due = max(due + 0.1, time.monotonic())
        executor.spin_once(timeout_sec=max(due - time.monotonic(), 0.0))
    say(time.monotonic())
    executor.spin()


def wait_for_match(out: Any) -> None:
    while not out.get_subscription_count():
        time.sleep(0.005)


def inside(task: Task) -> None:
    """Publisher and subscription in one process: times up to the pixels in the callback. `variant` is the transport."""
    make = importlib.import_module("rclpy.context").Context
    context = make(transport="memory://bench") if task.variant == "memory" else make()
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
    executor = executors.SingleThreadedExecutor(context=context)
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
