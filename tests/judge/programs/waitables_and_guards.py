"""A Waitable of the program's own, and guard conditions."""

import rclpy
from probe import show
from rclpy.clock import ROSClock
from rclpy.parameter import Parameter
from rclpy.time_source import TimeSource

rclpy.init()
n = rclpy.create_node("n100")
ts = TimeSource(node=n)
c = ROSClock()
show("attach", lambda: ts.attach_clock(c))
show("active", lambda: (ts.ros_time_is_active, c.ros_time_is_active))
show("set", lambda: setattr(ts, "ros_time_is_active", True))
show("clock active", lambda: (c.ros_time_is_active, n.get_clock().ros_time_is_active))
show("attach wrong", lambda: ts.attach_clock(3))
show("detach", ts.detach_node)
show("use_sim_time types", lambda: [(r.successful) for r in n.set_parameters([Parameter("use_sim_time", value=1)])])
show("attrs", lambda: sorted(x for x in dir(ts) if not x.startswith("_")))
show("type description param", lambda: n.get_parameter("start_type_description_service").value)
show("set it", lambda: n.set_parameters([Parameter("start_type_description_service", value=False)])[0].successful)
show(
    "clock subscription",
    lambda: (n.set_parameters([Parameter("use_sim_time", value=True)]), [x.topic_name for x in n.subscriptions])[1],
)
show(
    "off",
    lambda: (n.set_parameters([Parameter("use_sim_time", value=False)]), [x.topic_name for x in n.subscriptions])[1],
)
