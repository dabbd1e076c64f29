#!/usr/bin/env bash
# rclpy 9.1.2 (Kilted): with a MultiThreadedExecutor, the first subscription of a callback group that has a backlog keeps
# the group's later subscriptions and its services from their turns until it is empty. A SingleThreadedExecutor serves
# all of them in turn. One would guess that more threads cannot make it less fair.
#
# Cause: the executor looks for work again whenever a callback ends, and goes through its entities from the first one on.
# Seen with Python 3.11, Linux x86_64: of 20 messages that wait, the other topic and the service come after the last one.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/real"
"$folder/real/bin/pip" install -q --disable-pip-version-check ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 \
    ros-rmw-implementation==3.0.4 ros-std-msgs==5.5.1 ros-std-srvs==5.5.1
cat > "$folder/fair.py" <<'PY'
import threading
import time

import rclpy
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from std_msgs.msg import Int32
from std_srvs.srv import Trigger

BACKLOG = 20


def turns(make, name):
    """Return after how many messages of the backlog the other topic and the service had their turns."""
    node, other, order = rclpy.create_node(f"serves_{name}"), rclpy.create_node(f"asks_{name}"), []
    node.create_subscription(Int32, f"slow_{name}", lambda _: (time.sleep(0.05), order.append("slow")), 50)
    node.create_subscription(Int32, f"quick_{name}", lambda _: order.append("quick"), 50)
    node.create_service(Trigger, f"ask_{name}", lambda _, response: (order.append("ask"), response)[1])
    slow, quick = (other.create_publisher(Int32, f"{topic}_{name}", 50) for topic in ("slow", "quick"))
    client = other.create_client(Trigger, f"ask_{name}")
    while not (slow.get_subscription_count() and quick.get_subscription_count() and client.service_is_ready()):
        time.sleep(0.05)
    for number in range(BACKLOG):
        slow.publish(Int32(data=number))
    quick.publish(Int32())
    client.call_async(Trigger.Request())
    time.sleep(0.5)
    executor = make()
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()
    end = time.monotonic() + 5
    while not {"quick", "ask"} <= {*order} and time.monotonic() < end:
        time.sleep(0.02)
    executor.shutdown()
    thread.join(2)
    return [order[: order.index(each)].count("slow") for each in ("quick", "ask")]


rclpy.init()
one, four = turns(SingleThreadedExecutor, "one"), turns(lambda: MultiThreadedExecutor(4), "four")
print(f"the other topic and the service have their turns after so many of {BACKLOG} messages:")
print(f"SingleThreadedExecutor {one}, MultiThreadedExecutor(4) {four}")
assert max(one) <= 2, "one thread no longer serves all in turn"
assert min(four) >= BACKLOG - 1, "several threads no longer let the first subscription go first"
PY
ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID="${ROS_DOMAIN_ID:-77}" timeout -s KILL 60 \
    "$folder/real/bin/python" "$folder/fair.py"
