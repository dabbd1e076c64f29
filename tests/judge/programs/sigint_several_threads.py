# signal: INT 0.4

"""Ctrl-C while a MultiThreadedExecutor spins."""

import rclpy
from rclpy.executors import MultiThreadedExecutor

rclpy.init()
n = rclpy.create_node("n24")
n.create_timer(0.1, lambda: None)
e = MultiThreadedExecutor()
e.add_node(n)
print("READY", flush=True)
try:
    e.spin()
except KeyboardInterrupt:
    print("KeyboardInterrupt", rclpy.ok(), flush=True)
except BaseException as x:
    print(type(x).__name__, rclpy.ok(), flush=True)
finally:
    print("finally", flush=True)
e.shutdown()
n.destroy_node()
print("try", rclpy.try_shutdown())
