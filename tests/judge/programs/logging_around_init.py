"""Log lines before init, after shutdown and after destroy_node."""

import io
import logging
import sys

import rclpy
import rclpy.logging
from probe import show

g = rclpy.logging.get_logger("before")
g.info("before init")
rclpy.init()
n = rclpy.create_node("n97")
n.get_logger().info("stderr")
rclpy.shutdown()
n.get_logger().info("after shutdown")
rclpy.init()
m = rclpy.create_node("m97")
m.get_logger().info("second")
show("stdout untouched", lambda: "ok")
m.destroy_node()
m.get_logger().warning("after destroy_node")
sys.stderr.write("raw\n")
print("out")
m.get_logger().error("x" * 2000)
