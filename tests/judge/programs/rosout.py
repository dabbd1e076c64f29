"""Messages on /rosout."""

import rclpy
from probe import say, show, until
from rcl_interfaces.msg import Log

rclpy.init()
n = rclpy.create_node("n45", namespace="ns")
got = []
n.create_subscription(Log, "/rosout", got.append, 100)
until(n, lambda: n.count_publishers("/rosout") and False, 0.5)
g = n.get_logger()
until(n, lambda: False, 0.5)


def somewhere():
    g.info("hello")
    g.debug("not")
    g.error("bad")
    g.get_child("c").warn("child")


somewhere()
rclpy.logging.get_logger("free").info("free logger")
until(n, lambda: len(got) >= 3, 2)
until(n, lambda: False, 0.3)
for m in got:
    if m.name.startswith(("ns", "free", "n45")):
        say(m.level, m.name, m.msg, m.function, m.file.split("/")[-1], m.line, m.stamp.sec > 0)
show("levels", lambda: (Log.DEBUG, Log.INFO, Log.WARN, Log.ERROR, Log.FATAL))
m = rclpy.create_node("quiet45", enable_rosout=False)
m.get_logger().info("quiet")
until(n, lambda: False, 0.3)
say([x.msg for x in got if "quiet" in x.msg])
