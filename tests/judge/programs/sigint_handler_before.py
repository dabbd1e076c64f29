# signal: INT 0.4

"""Ctrl-C where the program sets a handler before init."""

import signal
import time

import rclpy

got = []
signal.signal(signal.SIGINT, lambda s, f: got.append(s))
rclpy.init()
n = rclpy.create_node("n29")
print("READY", flush=True)
t = time.monotonic()
try:
    while time.monotonic() - t < 1:
        rclpy.spin_once(n, timeout_sec=0.2)
except BaseException as e:
    print(type(e).__name__)
print(got, rclpy.ok())
