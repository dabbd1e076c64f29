"""A call that is cancelled before its answer comes."""

import rclpy
from probe import say, show, until
from std_srvs.srv import Trigger

rclpy.init()
n = rclpy.create_node("n103")
got = []
n.create_service(Trigger, "s103", lambda q, r: (got.append("served"), r)[1])
c = n.create_client(Trigger, "s103")
c.wait_for_service(2)
f = c.call_async(Trigger.Request())
f.add_done_callback(lambda f: got.append("done callback"))
f.cancel()
until(n, lambda: False, 0.7)
show("future", lambda: (f.done(), f.cancelled(), f.result()))
say(got)
g = c.call_async(Trigger.Request())
show("removed", lambda: c.remove_pending_request(g))
until(n, lambda: False, 0.4)
show("future", lambda: (g.done(), g.cancelled()))
