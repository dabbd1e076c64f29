#!/usr/bin/env bash
# rclpy 9.1.2 (Kilted): `MultiThreadedExecutor.shutdown(timeout_sec=0.1)` waits for the callback under way, however long
# that takes, and returns True, while it is documented to wait for at most that time, and to return False then. One would
# guess that a program which gives 0.1 s gets its thread back after 0.1 s.
#
# Seen with Python 3.11, Linux x86_64: a callback of 0.8 s; shutdown(timeout_sec=0.1) takes 0.6 s and returns True. With
# `wait_for_threads=False` it returns at once, and says True as well, though the callback still runs.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/real"
"$folder/real/bin/pip" install -q --disable-pip-version-check ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 \
    ros-rmw-implementation==3.0.4
cat > "$folder/ends.py" <<'PY'
import threading
import time

import rclpy
from rclpy.executors import MultiThreadedExecutor


def ends(**options):
    """Return what shutdown returns, the seconds that it takes, and whether the callback still runs then."""
    node, running = rclpy.create_node(f"node_{len(options)}"), []

    def callback():
        timer.cancel()
        running.append(True)
        time.sleep(0.8)
        running.pop()

    timer = node.create_timer(0.01, callback)
    executor = MultiThreadedExecutor(2)
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()
    while not running:
        time.sleep(0.01)
    time.sleep(0.2)
    begin = time.monotonic()
    result = executor.shutdown(timeout_sec=0.1, **options)
    found = result, time.monotonic() - begin, bool(running)
    time.sleep(1.0)
    return found


rclpy.init()
waiting, hasty = ends(), ends(wait_for_threads=False)
print("returned, seconds, callback still running:", waiting, hasty)
assert waiting[0] is True and waiting[1] > 0.4 and not waiting[2], "the timeout counts now"
assert hasty[0] is True and hasty[1] < 0.3 and hasty[2], "it no longer says True of a callback that runs"
PY
ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID="${ROS_DOMAIN_ID:-77}" timeout -s KILL 60 \
    "$folder/real/bin/python" "$folder/ends.py"
