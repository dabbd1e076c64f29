# signal: TERM 0.3

"""SIGTERM that nothing catches."""

import rclpy

rclpy.init()
n = rclpy.create_node("n22")
n.create_timer(0.1, lambda: None)
print("READY", flush=True)
rclpy.spin(n)
print("after spin", rclpy.ok(), flush=True)
