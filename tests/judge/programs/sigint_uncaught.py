# signal: INT 0.3

"""Ctrl-C that nothing catches."""

import rclpy

rclpy.init()
n = rclpy.create_node("n19")
n.create_timer(0.1, lambda: None)
print("READY", flush=True)
rclpy.spin(n)
print("after spin", rclpy.ok(), flush=True)
