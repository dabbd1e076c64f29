# env: RCUTILS_LOGGING_USE_STDOUT=1 RCUTILS_LOGGING_BUFFERED_STREAM=0 "RCUTILS_CONSOLE_OUTPUT_FORMAT={severity}:{name}:{message}"
# args: --ros-args --log-level warn --log-level n43.c:=debug

"""Log lines on standard output, with levels from the command line."""

import rclpy

rclpy.init()
n = rclpy.create_node("n43")
g = n.get_logger()
g.info("i")
g.warn("w")
c = g.get_child("c")
c.debug("cd")
c.info("ci")
print(c.get_effective_level(), g.get_effective_level())
print(rclpy.logging.get_logger("zz").get_effective_level())
