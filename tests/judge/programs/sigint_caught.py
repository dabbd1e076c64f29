# signal: INT 0.3

"""Ctrl-C that the program catches."""

import rclpy
from rclpy.executors import ExternalShutdownException

rclpy.init()
n = rclpy.create_node("n20")
n.create_timer(0.1, lambda: None)
print("READY", flush=True)
try:
    rclpy.spin(n)
except KeyboardInterrupt:
    print("KeyboardInterrupt", rclpy.ok(), flush=True)
except ExternalShutdownException:
    print("ExternalShutdown", rclpy.ok(), flush=True)
n.destroy_node()
try:
    rclpy.shutdown()
except Exception as e:
    print("shutdown", type(e).__name__, e)
print("try", rclpy.try_shutdown())
