#!/usr/bin/env bash
# rmw_fastrtps_cpp 9.3.3 with Fast DDS 3.2.3 (Kilted): with ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST the variable
# FASTDDS_BUILTIN_TRANSPORTS has no effect, and nothing says so. A node with UDPv4, which is meant to do without shared
# memory, still opens its port there; one with SHM, which is meant to do without UDP, still binds its UDP ports. Without
# LOCALHOST both variables do what they say. Who sets both, to keep a robot's nodes on the machine and their images off
# the small shared segment, gets the segment.
#
# Seen with Python 3.11, Linux x86_64. One would guess that the two variables go together, or that one is refused.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/real"
"$folder/real/bin/pip" install -q --disable-pip-version-check ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 \
    ros-rmw-implementation==3.0.4
cat > "$folder/shown.py" <<'PY'
import os
import pathlib

import rclpy

rclpy.init()
node = rclpy.create_node("shown")
links = [os.readlink(each) for each in pathlib.Path("/proc/self/fd").iterdir() if each.is_symlink()]
sockets = {each.removeprefix("socket:[").rstrip("]") for each in links if each.startswith("socket:[")}
lines = [line.split() for line in pathlib.Path("/proc/net/udp").read_text().splitlines()[1:]]
bound = {int(fields[1].rpartition(":")[2], 16) for fields in lines if fields[9] in sockets}
first = 7400 + 250 * int(os.environ["ROS_DOMAIN_ID"])
print(f"shared memory: {any('/fastdds_port' in each for each in links)}", end=", ")
print(f"UDP: {any(first + 10 <= each < first + 250 for each in bound)}")
PY

for transports in DEFAULT UDPv4 SHM; do
    seen=$(ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID=97 FASTDDS_BUILTIN_TRANSPORTS=$transports \
        timeout -s KILL 60 "$folder/real/bin/python" "$folder/shown.py")
    echo "$transports: $seen"
    [ "$seen" = "shared memory: True, UDP: True" ] || { echo "the two go together now: it has changed"; exit 1; }
done
