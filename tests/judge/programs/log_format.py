# env: "RCUTILS_CONSOLE_OUTPUT_FORMAT=[{severity}] {name} ({function_name}:{line_number}) {message} {{x}} {nope}" RCUTILS_COLORIZED_OUTPUT=1

"""Log lines in a format of the environment."""

import rclpy

rclpy.init()
n = rclpy.create_node("n42", namespace="ns")
g = n.get_logger()


def f():
    g.info("info")
    g.warn("warn")
    g.error("error")
    g.fatal("fatal")
    g.debug("debug")


f()
n.get_logger().get_child("c").info("child")
