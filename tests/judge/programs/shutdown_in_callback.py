"""A callback that calls rclpy.shutdown."""

import rclpy
from probe import say, show

rclpy.init()
n = rclpy.create_node("n67")
log = []


def cb():
    log.append("timer")
    rclpy.shutdown()
    log.append("after shutdown")


n.create_timer(0.05, cb)
n.create_timer(0.05, lambda: log.append("second"))
show("spin", lambda: rclpy.spin(n))
say(log, rclpy.ok())
show("destroy", n.destroy_node)
