"""A service that answers with send_response later, and the names of generated classes."""

import rclpy
from probe import say, show, until
from std_srvs.srv import Empty, SetBool, Trigger

rclpy.init()
n = rclpy.create_node("n98")
sv = n.create_service(
    SetBool,
    "s98",
    lambda q, r: (setattr(r, "success", q.data), setattr(r, "message", type(q).__name__ + type(r).__name__), r)[2],
)
c = n.create_client(SetBool, "s98")
c.wait_for_service(2)
f = c.call_async(SetBool.Request(data=True))
got = []
f.add_done_callback(lambda x: got.append((x is f, x.result().success)))
until(n, lambda: got, 2)
say(got, f.result().message)
show("fields", lambda: SetBool.Request.get_fields_and_field_types())
show("repr", lambda: SetBool.Request(data=True))
show("names", lambda: (SetBool.Request.__name__, SetBool.Response.__module__, SetBool.__name__, SetBool.__module__))
show("instantiate", lambda: SetBool())
show("Empty", lambda: Empty.Request())
show("eq", lambda: SetBool.Request() == SetBool.Request())
show("attrs", lambda: sorted(x for x in dir(SetBool) if not x.startswith("_")))
from test_msgs.action import Fibonacci

show(
    "action names",
    lambda: (
        Fibonacci.__module__,
        Fibonacci.Goal.__name__,
        Fibonacci.Impl.FeedbackMessage.__name__,
        Fibonacci.Impl.SendGoalService.__name__,
    ),
)
show("action attrs", lambda: sorted(x for x in dir(Fibonacci) if not x.startswith("_")))
show("action", lambda: Fibonacci())
show("goal", lambda: Fibonacci.Goal(order=3))
d = rclpy.create_node("d98")
d.destroy_node()
show("client of destroyed node", lambda: d.create_client(SetBool, "s98"))
