"""Service introspection: events of both ends."""

import rclpy
from probe import say, show, until
from rclpy.service_introspection import ServiceIntrospectionState as S
from service_msgs.msg import ServiceEventInfo
from std_srvs.srv import SetBool

rclpy.init()
n = rclpy.create_node("n66")
ev = []
sv = n.create_service(SetBool, "s66", lambda q, r: (setattr(r, "message", "m"), r)[1])
c = n.create_client(SetBool, "s66")
c.wait_for_service(2)
show("states", lambda: sorted(S.__members__))
show("Event", lambda: SetBool.Event.get_fields_and_field_types())
show(
    "configure service",
    lambda: sv.configure_introspection(n.get_clock(), rclpy.qos.qos_profile_system_default, S.CONTENTS),
)
show(
    "configure client",
    lambda: c.configure_introspection(n.get_clock(), rclpy.qos.qos_profile_system_default, S.METADATA),
)
n.create_subscription(
    SetBool.Event,
    "/s66/_service_event",
    lambda m: ev.append(
        (m.info.event_type, m.info.sequence_number > 0, [r.data for r in m.request], [r.message for r in m.response])
    ),
    10,
)
until(n, lambda: False, 0.7)
f = c.call_async(SetBool.Request(data=True))
until(n, f.done)
until(n, lambda: len(ev) >= 4, 2)
say(sorted(ev))
ev.clear()
show("off", lambda: sv.configure_introspection(n.get_clock(), rclpy.qos.qos_profile_system_default, S.OFF))
f = c.call_async(SetBool.Request())
until(n, f.done)
until(n, lambda: False, 0.5)
say(sorted(ev))
show("consts", lambda: (ServiceEventInfo.REQUEST_SENT, ServiceEventInfo.RESPONSE_RECEIVED))
