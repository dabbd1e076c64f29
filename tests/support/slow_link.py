"""Commands beside a camera, over a slow link between two network namespaces: what arrives, and how late.

    python -m tests.support.slow_link                              # as it is, then with the documented limits
    python -m tests.support.slow_link --router                     # the limits at a router, beside nodes on localhost
    python -m tests.support.slow_link --apart '{rate: {/camera/image: 2}}'    # each publisher in a process of its own

Needs root, and `tc`.
"""

from __future__ import annotations

import argparse
import json
import shutil
import statistics
import subprocess
import sys
from contextlib import ExitStack
from typing import Any, NamedTuple

from tests.support import stalls
from tests.support.machines import HERE, Machines

LIMITS = "{control: [/cmd_vel], rate: {/camera/image: 2}}"
"""The setting of docs/reference/networks.md."""

RATES = {"/cmd_vel": 20.0, "/camera/image": 15.0}
IMAGE = 60_000

RUN_ROUTER = "from robolink.cli.main import main; main(['router', '--listen', 'lan'])"

SENDER = f"""
import json, os, sys, threading, time
import robolink as rclpy
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image

rates = json.loads(sys.argv[1])
rclpy.init()
node = rclpy.Node("sender" + str(os.getpid()))

def publisher_of(topic):
    if topic == "/cmd_vel":
        publisher, message = node.create_publisher(Twist, topic, 10), Twist()
        def publish(number):
            message.linear.x, message.linear.y = time.monotonic(), float(number)
            publisher.publish(message)
    else:
        publisher, message = node.create_publisher(Image, topic, 10), Image(data=bytes({IMAGE}))
        def publish(number):
            message.header.frame_id = json.dumps([time.monotonic(), number])
            publisher.publish(message)
    return publisher, publish

publishers = {{topic: publisher_of(topic) for topic in rates}}
while not all(each.get_subscription_count() for each, _ in publishers.values()):
    time.sleep(0.05)

def run(topic, seconds):
    begin, publish = time.monotonic(), publishers[topic][1]
    for number in range(int(seconds * rates[topic])):
        time.sleep(max(0.0, begin + number / rates[topic] - time.monotonic()))
        publish(number)

seconds = float(sys.stdin.readline())
threads = [threading.Thread(target=run, args=(topic, seconds)) for topic in rates]
for each in threads:
    each.start()
for each in threads:
    each.join()
print("sent", flush=True)
sys.stdin.read()
"""

RECEIVER = """
import json, sys, threading, time
import robolink as rclpy
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image

rclpy.init()
node = rclpy.Node("receiver")
arrived = {"/cmd_vel": [], "/camera/image": []}

def note(topic, sent, number):
    arrived[topic].append([int(number), time.monotonic() - sent])

def commanded(message):
    note("/cmd_vel", message.linear.x, message.linear.y)

def pictured(message):
    note("/camera/image", *json.loads(message.header.frame_id))

node.create_subscription(Twist, "/cmd_vel", commanded, 10)
node.create_subscription(Image, "/camera/image", pictured, 10)
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
print("ready", flush=True)
last, patience = json.loads(sys.stdin.readline())
until = time.monotonic() + patience
while time.monotonic() < until and not (arrived["/cmd_vel"] and arrived["/cmd_vel"][-1][0] == last):
    time.sleep(0.05)
print(json.dumps(arrived), flush=True)
sys.stdin.read()
"""


class Arrived(NamedTuple):
    """Arrivals of a topic; the latencies are in milliseconds."""

    sent: int
    received: int
    median: float
    p95: float

    @classmethod
    def of(cls, sent: int, found: list[list[float]]) -> Arrived:
        late = sorted(seconds * 1000 for _, seconds in found)
        return cls(sent, len(late), statistics.median(late or [0]), late[int(0.95 * (len(late) - 1))] if late else 0)


def missing() -> str:
    """The reason why there is no slow link on this machine; '' if there is."""
    return stalls.no_hosts() or ("" if shutil.which("tc") else "there is no `tc`")


def measure(
    limits: str, seconds: float, *, apart: bool = False, router: bool = False, patience: float = 20.0
) -> dict[str, Arrived]:
    """Publish both topics for so long over 2 Mbit/s, with these limits ('' for none); give what has arrived."""
    with ExitStack() as stack:
        machines = Machines(stack)
        slow = "qdisc add dev cable root tbf rate 2mbit burst 16kb latency 400ms"
        subprocess.run(["ip", "netns", "exec", machines.here, "tc", *slow.split()], check=True)
        own = {"ROBOLINK_SHARED_MEMORY": "off", "ROBOLINK_NETWORK": "lan"}
        limited = own | ({"ROBOLINK_LIMITS": limits} if limits else {})
        if router:
            router_started = _start(stack, machines, machines.here, RUN_ROUTER, **limited)
            assert router_started.stdout.readline().startswith("robolink router")
            limited = own | {"ROBOLINK_NETWORK": "localhost"}
        groups = [[each] for each in RATES] if apart else [list(RATES)]
        # One holds the port of the domain, where the receiver finds it and hears of the other.
        senders = []
        for group in groups:
            rates = json.dumps({each: RATES[each] for each in group})
            senders.append(_start(stack, machines, machines.here, SENDER, rates, **limited))
        receiver = _start(
            stack,
            machines,
            machines.there,
            RECEIVER,
            **(own | {"ROBOLINK_NETWORK": f"{HERE}:7447" if router else HERE}),
        )
        assert receiver.stdout.readline() == "ready\n"
        for each in senders:
            print(seconds, file=each.stdin, flush=True)
        for each in senders:
            assert each.stdout.readline() == "sent\n"
        last = int(seconds * RATES["/cmd_vel"]) - 1
        print(json.dumps([last, patience]), file=receiver.stdin, flush=True)
        found = json.loads(receiver.stdout.readline())
        return {topic: Arrived.of(int(seconds * rate), found[topic]) for topic, rate in RATES.items()}


def _start(stack: ExitStack, machines: Machines, host: str, code: str, *words: str, **environ: str) -> Any:
    """Start a program there, whose input and output are pipes, until the stack ends."""
    command = ["ip", "netns", "exec", host, sys.executable, "-c", code, *words]
    pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    child = stack.enter_context(subprocess.Popen(command, env=machines.environ(environ), **pipes))
    stack.callback(child.kill)
    return child


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("limits", nargs="*", default=["", LIMITS], help="as of ROBOLINK_LIMITS; '' for none")
    parser.add_argument("--seconds", type=float, default=5.5)
    parser.add_argument("--apart", action="store_true", help="each publisher in a process of its own")
    parser.add_argument("--router", action="store_true", help="the limits at a router, beside nodes on localhost")
    asked = parser.parse_args()
    if reason := missing():
        sys.exit(reason)
    for limits in asked.limits:
        sys.stdout.write(f"{limits or 'without limits'}\n")
        found = measure(limits, asked.seconds, apart=asked.apart, router=asked.router, patience=8.0)
        for topic, each in found.items():
            late = f"median {each.median:.0f} ms, p95 {each.p95:.0f} ms"
            sys.stdout.write(f"  {topic:14} {each.received} of {each.sent}, {late}\n")


if __name__ == "__main__":
    main()
