# signal: INT 0.3
# signal: INT 0.8

"""Ctrl-C twice."""

import time

import rclpy

rclpy.init()
n = rclpy.create_node("n77")
print("READY", flush=True)
try:
    rclpy.spin(n)
except KeyboardInterrupt:
    print("first", flush=True)
try:
    time.sleep(3)
    print("slept")
except KeyboardInterrupt:
    print("second", flush=True)
