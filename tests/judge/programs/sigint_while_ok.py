# signal: INT 0.4

"""Ctrl-C in a loop of `while rclpy.ok()`."""

import rclpy

rclpy.init()
n = rclpy.create_node("n25")
print("READY", flush=True)
try:
    while rclpy.ok():
        rclpy.spin_once(n, timeout_sec=0.1)
    print("loop ended", flush=True)
except BaseException as e:
    print(type(e).__name__, rclpy.ok(), flush=True)
