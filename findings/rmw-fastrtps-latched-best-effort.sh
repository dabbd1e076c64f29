#!/usr/bin/env bash
# rmw_fastrtps_cpp 9.3.3 with Fast DDS 3.2.3 (Kilted): a subscription that is TRANSIENT_LOCAL and BEST_EFFORT gets nothing
# of what a TRANSIENT_LOCAL publisher kept for late ones. It is matched, qos_check_compatible says OK, it has no event of
# incompatible QoS, and what is published later arrives. ROS 2's table of durabilities says that TRANSIENT_LOCAL on both
# ends brings old messages too, whatever the reliability. So a map never comes to a node that takes the sensor profile and
# makes it TRANSIENT_LOCAL. (Two nodes of
# Jazzy, two programs of cyclonedds 11.0.1, and a reader of the latter beside Kilted's publisher: the same.)
#
# Seen with Python 3.11, Linux x86_64: RELIABLE gets old 0, old 1, old 2 and new; BEST_EFFORT, 3 s later, still has none
# of the old ones. One would guess that they are sent to it once, or that the pair is refused or warned of.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/real"
"$folder/real/bin/pip" install -q --disable-pip-version-check ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 \
    ros-rmw-implementation==3.0.4 ros-std-msgs==5.5.1
cat > "$folder/keeps.py" <<'PY'
import sys

import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("keeps")
publisher = node.create_publisher(String, "kept", QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL))
for number in range(3):
    publisher.publish(String(data=f"old {number}"))
print("kept", flush=True)
for line in sys.stdin:
    publisher.publish(String(data=line.strip()))
PY
cat > "$folder/late.py" <<'PY'
import subprocess
import sys
import time

import rclpy
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy, qos_check_compatible
from std_msgs.msg import String

RELIABLE, BEST_EFFORT = ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT
keeper = subprocess.Popen([sys.executable, sys.argv[1]], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
keeper.stdout.readline()
rclpy.init()
node = rclpy.create_node("late")
got, matched, warnings = {BEST_EFFORT: [], RELIABLE: []}, set(), []


def profile(reliability):
    """Return a TRANSIENT_LOCAL profile."""
    return QoSProfile(depth=5, reliability=reliability, durability=DurabilityPolicy.TRANSIENT_LOCAL,
                      liveliness=LivelinessPolicy.AUTOMATIC)


def subscribe(reliability):
    """Subscribe, and note what arrives, the match and each warning."""
    events = SubscriptionEventCallbacks(matched=lambda _: matched.add(reliability), incompatible_qos=warnings.append)
    node.create_subscription(String, "kept", lambda message: got[reliability].append(message.data),
                             profile(reliability), event_callbacks=events)


def spin(seconds, until=lambda: False):
    """Run callbacks for so many seconds, or until a condition holds."""
    end = time.monotonic() + seconds
    while time.monotonic() < end and not until():
        rclpy.spin_once(node, timeout_sec=0.1)


for each in got:
    subscribe(each)
spin(30, lambda: len(matched) == 2 and len(got[RELIABLE]) == 3)
spin(3)
print("new", file=keeper.stdin, flush=True)
spin(10, lambda: all("new" in each for each in got.values()))
keeper.stdin.close()
keeper.wait(10)
verdict = qos_check_compatible(profile(RELIABLE), profile(BEST_EFFORT))[0]
for each, messages in got.items():
    print(f"{each.name}: {', '.join(messages)}")
print(f"matched: {len(matched)}, warnings: {len(warnings)}, qos_check_compatible: {verdict.name}")
assert got[RELIABLE] == ["old 0", "old 1", "old 2", "new"], "a reliable subscription no longer gets the old messages"
assert len(matched) == 2 and not warnings and verdict.name == "OK", "somebody warns now"
assert got[BEST_EFFORT] == ["new"], "a best-effort subscription gets other messages now"
PY
ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID="${ROS_DOMAIN_ID:-77}" timeout -s KILL 60 \
    "$folder/real/bin/python" "$folder/late.py" "$folder/keeps.py"
