"""A thread that ends rclpy or an executor while the main thread spins."""

import threading
import time

import rclpy
from probe import say, took
from rclpy.executors import *
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor

for kind_ in (None, SingleThreadedExecutor, MultiThreadedExecutor):
    rclpy.init()
    n = rclpy.create_node("n68")
    threading.Timer(0.3, rclpy.shutdown).start()
    if kind_ is None:
        took("rclpy.spin", lambda: rclpy.spin(n))
    else:
        e = kind_()
        e.add_node(n)
        took(kind_.__name__, e.spin)
    rclpy.try_shutdown()
rclpy.init()
n = rclpy.create_node("n68")
e = SingleThreadedExecutor()
e.add_node(n)
threading.Timer(0.3, e.shutdown).start()
took("executor.shutdown ends spin", e.spin)
say(rclpy.ok())
e = SingleThreadedExecutor()
e.add_node(n)
threading.Timer(0.3, rclpy.shutdown).start()
took("spin_once in the middle", lambda: e.spin_once(timeout_sec=2))
took("and once more", lambda: e.spin_once(timeout_sec=0.5))
