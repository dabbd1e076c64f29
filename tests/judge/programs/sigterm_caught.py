# signal: TERM 0.3

"""SIGTERM that the program catches."""

import rclpy
from rclpy.executors import ExternalShutdownException

rclpy.init()
n = rclpy.create_node("n21")
n.create_timer(0.1, lambda: None)
print("READY", flush=True)
try:
    rclpy.spin(n)
except KeyboardInterrupt:
    print("KeyboardInterrupt", rclpy.ok(), flush=True)
except ExternalShutdownException as e:
    print("ExternalShutdown", rclpy.ok(), repr(e), flush=True)
print("end")
