# signal: INT 0.4

"""Ctrl-C while the main thread sleeps and another one spins."""

import threading
import time

import rclpy

rclpy.init()
n = rclpy.create_node("n80")
res = []


def spin():
    try:
        rclpy.spin(n)
        res.append("returned")
    except BaseException as e:
        res.append(type(e).__name__)


th = threading.Thread(target=spin)
th.start()
print("READY", flush=True)
try:
    time.sleep(3)
    print("slept", flush=True)
except KeyboardInterrupt:
    print("KeyboardInterrupt in main", flush=True)
th.join(3)
print(res, th.is_alive(), rclpy.ok(), flush=True)
