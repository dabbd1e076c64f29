"""A service callback that awaits a call in the same mutually exclusive group."""

import rclpy
from probe import say, until
from std_srvs.srv import Trigger

rclpy.init()
n = rclpy.create_node("n101")
log = []
m = rclpy.create_node("m101")
sv = m.create_service(Trigger, "s101", lambda q, r: r)
c = n.create_client(Trigger, "s101")
c.wait_for_service(2)
e = rclpy.executors.SingleThreadedExecutor()
e.add_node(n)
e.add_node(m)


async def cb():
    if "in" in log:
        return
    log.append("in")
    await c.call_async(Trigger.Request())
    log.append("out")


t = n.create_timer(0.05, cb)
k = n.create_timer(0.05, lambda: log.append("other"))
until(e, lambda: "out" in log, 1.0)
say("out" in log, log.count("in"))
say("other runs", log.count("other") > 2)
