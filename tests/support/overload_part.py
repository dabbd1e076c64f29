"""Process of an overload measurement: it sends, hears, serves and calls as its first argument says, in JSON.

It writes "ready" once all that it sends is heard, waits for a line, works for the seconds in it, and then writes what
it has measured: for each part the latencies in milliseconds, and what its subscriptions have lost.
"""

from __future__ import annotations

import json
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import robolink as rclpy
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan
from robolink.interfaces.std_srvs.srv import Trigger

PATIENCE = 30.0


def _stamp() -> str:
    return repr(time.monotonic())


def _twist(size: int) -> Callable[[], Any]:
    message = Twist()

    def made() -> Any:
        message.linear.x = time.monotonic()
        return message

    return made


def _clock(size: int) -> Callable[[], Any]:
    def made() -> Any:
        seconds, rest = divmod(time.monotonic_ns(), 10**9)
        return Clock(clock=Time(sec=seconds, nanosec=rest))

    return made


def _stamped(message: Any) -> Callable[[], Any]:
    def made() -> Any:
        message.header.frame_id = _stamp()
        return message

    return made


TYPES: dict[str, tuple[Any, Callable[[int], Callable[[], Any]], Callable[[Any], float]]] = {
    "Twist": (Twist, _twist, lambda message: message.linear.x),
    "Clock": (Clock, _clock, lambda message: message.clock.sec + message.clock.nanosec * 1e-9),
    "Image": (
        Image,
        lambda size: _stamped(Image(data=bytes(size))),
        lambda message: float(message.header.frame_id),
    ),
    "LaserScan": (
        LaserScan,
        lambda size: _stamped(LaserScan(ranges=[1.0] * size)),
        lambda message: float(message.header.frame_id),
    ),
}
"""Types of messages: the class, what makes the next one of a size, and the time of sending in it."""


class Part:
    """One thing that the process does; `found` has its latencies in seconds."""

    def __init__(self, node: Any, wish: dict[str, Any]) -> None:
        self.node, self.wish = node, wish
        self.found: list[float] = []
        self.count = 0
        self.subscription: Any = None
        self.is_met: Callable[[], bool] = lambda: True
        self.act: Callable[[], object] | None = None
        getattr(self, "_" + wish["does"])()

    def _sends(self) -> None:
        kind, maker, _ = TYPES[self.wish["type"]]
        publisher = self.node.create_publisher(kind, self.wish["name"], self.wish.get("depth", 10))
        made = maker(self.wish.get("size", 0))
        self.is_met = lambda: publisher.get_subscription_count() >= self.wish.get("ears", 1)
        self.act = lambda: publisher.publish(made())

    def _hears(self) -> None:
        kind, _, sent = TYPES[self.wish["type"]]
        takes = self.wish.get("takes", 0.0)

        def heard(message: Any) -> None:
            self.found.append(time.monotonic() - sent(message))
            if takes:
                time.sleep(takes)

        self.subscription = self.node.create_subscription(kind, self.wish["name"], heard, self.wish.get("depth", 10))

    def _serves(self) -> None:
        self.node.create_service(Trigger, self.wish["name"], lambda request, response: response)

    def _calls(self) -> None:
        client = self.node.create_client(Trigger, self.wish["name"])
        self.is_met = client.service_is_ready

        def call() -> None:
            begin = time.monotonic()
            if client.call(Trigger.Request(), timeout_sec=5.0) is not None:
                self.found.append(time.monotonic() - begin)

        self.act = call

    def run(self, begin: float, seconds: float) -> None:
        """Act at the wished rate until the end; as often as possible if it is 0."""
        assert self.act is not None
        rate = self.wish["rate"]
        while (now := time.monotonic()) < begin + seconds:
            due = begin + self.count / rate if rate else now
            if due > now:
                time.sleep(due - now)
            self.act()
            self.count += 1

    def report(self) -> dict[str, Any]:
        """Return what was measured, in milliseconds."""
        late = sorted(1000 * each for each in self.found)
        found = {"name": self.wish.get("label", self.wish["name"]), "does": self.wish["does"], "count": self.count}
        if late:
            found |= {
                "got": len(late),
                "p50": late[len(late) // 2],
                "p95": late[int(0.95 * len(late))],
                "max": late[-1],
            }
        if self.subscription is not None:
            found |= {"dropped": self.subscription.dropped, "lost": self.subscription.lost}
        return found


def main() -> None:
    wishes: list[list[dict[str, Any]]] = json.loads(sys.argv[1])
    parts: list[Part] = []
    executors = []
    for number, group in enumerate(wishes):  # a node with a session of its own for each group
        context = rclpy.Context()
        context.init([])
        node = rclpy.Node(f"part{number}", context=context)
        parts += [Part(node, wish) for wish in group]
        executors.append(SingleThreadedExecutor(context=context))
        executors[-1].add_node(node)
    for executor in executors:
        threading.Thread(target=_spin, args=(executor,), daemon=True).start()
    end = time.monotonic() + PATIENCE
    while not all(each.is_met() for each in parts):
        if time.monotonic() > end:
            sys.exit(f"nobody is there for {[each.wish for each in parts if not each.is_met()]}")
        time.sleep(0.02)
    print("ready", flush=True)  # noqa: T201 - this is the protocol
    seconds = float(sys.stdin.readline())
    begin = time.monotonic()
    threads = [threading.Thread(target=each.run, args=(begin, seconds)) for each in parts if each.act]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    time.sleep(max(0.0, begin + seconds + 0.5 - time.monotonic()))
    print(json.dumps([each.report() for each in parts]), flush=True)  # noqa: T201 - and this too
    sys.stdin.read()


def _spin(executor: Any) -> None:
    try:
        executor.spin()
    except rclpy.executors.ExternalShutdownException:
        return


if __name__ == "__main__":
    main()
