#!/usr/bin/env bash
# rclpy 9.1.2 with rmw_fastrtps_cpp 9.3.3 (Kilted): the QoS profile that get_publishers_info_by_topic finds for a publisher
# cannot be used to subscribe as that publisher publishes: create_subscription raises "Unknown QoS history policy". The
# found profile has history UNKNOWN and depth 0, even for a publisher of the very same node, whose own profile says
# KEEP_LAST and 7. (A cyclonedds 11.0.1 writer is found with KEEP_LAST and its depth: there the same line works. Jazzy's
# rclpy 7.1.6 refuses as well, and says "invalid allocator".)
#
# Seen with Python 3.11, Linux x86_64. One would guess that a profile which rclpy returns is one that rclpy takes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/real"
"$folder/real/bin/pip" install -q --disable-pip-version-check ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 \
    ros-rmw-implementation==3.0.4 ros-std-msgs==5.5.1
cat > "$folder/found.py" <<'PY'
import time

import rclpy
from rclpy.qos import HistoryPolicy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("finds")
publisher = node.create_publisher(String, "found", 7)
end = time.monotonic() + 20
while not node.get_publishers_info_by_topic("found") and time.monotonic() < end:
    time.sleep(0.1)
own, found = publisher.qos_profile, node.get_publishers_info_by_topic("found")[0].qos_profile
try:
    node.create_subscription(String, "found", print, found)
    refusal = "none"
except Exception as error:
    refusal = f"{type(error).__name__}: {error}"
print(f"own: {own.history.name} {own.depth}, found: {found.history.name} {found.depth}")
print(f"subscribing with the found one: {refusal}")
assert (own.history, own.depth) == (HistoryPolicy.KEEP_LAST, 7), "the publisher's own profile has changed"
assert (found.history, found.depth) == (HistoryPolicy.UNKNOWN, 0), "history and depth are found now"
assert "Unknown QoS history policy" in refusal, "a found profile is taken now"

found.history, found.depth = own.history, own.depth
node.create_subscription(String, "found", print, found)
PY
ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID="${ROS_DOMAIN_ID:-77}" timeout -s KILL 60 \
    "$folder/real/bin/python" "$folder/found.py"
