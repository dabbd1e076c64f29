#!/usr/bin/env bash
# rclpy 9.1.2 (Kilted) from PyPI: an EventsExecutor that waits without a timeout runs no callback, and its wait never ends.
# `executor.spin()`, `spin_once()` and `spin_until_future_complete(future)` hold a processor busy and call nothing; with
# `timeout_sec=2` the same timer ticks ten times. (Jazzy's 7.1.6 does the same. A wait until the end of time, as
# `condition_variable::wait_until(time_point::max())` is, would explain it.)
#
# Seen with Python 3.11, Linux x86_64. One would guess that the executor's main method runs callbacks, and that no timeout
# means the longest one.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/real"
"$folder/real/bin/pip" install -q --disable-pip-version-check ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 \
    ros-rmw-implementation==3.0.4
cat > "$folder/ticks.py" <<'PY'
import os
import sys
import threading
import time

import rclpy
from rclpy.experimental import EventsExecutor

timeout = float(sys.argv[1]) if len(sys.argv) > 1 else None
rclpy.init()
node, ticks = rclpy.create_node("ticks"), []
node.create_timer(0.2, lambda: ticks.append(time.monotonic()))
executor = EventsExecutor()
executor.add_node(node)


def report():
    time.sleep(6.0)
    print(f"timeout {timeout}: {len(ticks)} ticks in 6 s, spins still", flush=True)
    os._exit(0)


threading.Thread(target=report, daemon=True).start()
if timeout is None:
    executor.spin()
else:
    executor.spin_until_future_complete(rclpy.Future(), timeout)
print(f"timeout {timeout}: {len(ticks)} ticks, ended", flush=True)
os._exit(0)
PY
run() {
    ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID="${ROS_DOMAIN_ID:-77}" timeout -s KILL 60 \
        "$folder/real/bin/python" "$folder/ticks.py" "$@"
}
without=$(run)
with=$(run 2)
echo "$without"
echo "$with"
[ "$without" = "timeout None: 0 ticks in 6 s, spins still" ]
case "$with" in "timeout 2.0: "*" ticks, ended") ;; *) exit 1 ;; esac
[ "$with" != "timeout 2.0: 0 ticks, ended" ]
