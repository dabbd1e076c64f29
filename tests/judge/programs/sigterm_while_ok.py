# signal: TERM 0.4

"""SIGTERM in a loop of `while rclpy.ok()`."""

import time

import rclpy

rclpy.init()
n = rclpy.create_node("n26")
print("READY", flush=True)
try:
    while rclpy.ok():
        rclpy.spin_once(n, timeout_sec=5)
    print("loop ended", flush=True)
except BaseException as e:
    print(type(e).__name__, rclpy.ok(), flush=True)
print("end", flush=True)
