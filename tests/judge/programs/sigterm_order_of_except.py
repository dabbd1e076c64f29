# signal: TERM 0.4

"""SIGTERM where KeyboardInterrupt is caught first and ExternalShutdownException second."""

import rclpy
from rclpy.executors import ExternalShutdownException

rclpy.init()
n = rclpy.create_node("n79")
n.create_timer(0.05, lambda: None)
print("READY", flush=True)
try:
    rclpy.spin(n)
except KeyboardInterrupt:
    print("by Ctrl-C", flush=True)
except ExternalShutdownException:
    print("by others", flush=True)
