"""The services that get and set levels of loggers."""

import rclpy
from probe import say, show, until
from rcl_interfaces.msg import LoggerLevel
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from type_description_interfaces.srv import GetTypeDescription

rclpy.init()
n = rclpy.create_node("n75", enable_logger_service=True)
g = rclpy.create_node("g75")
ex = rclpy.executors.SingleThreadedExecutor()
ex.add_node(n)
ex.add_node(g)


def call(t, name, req):
    c = g.create_client(t, name)
    say(c.wait_for_service(2))
    f = c.call_async(req)
    until(ex, f.done)
    return f.result()


show(
    "get", lambda: call(GetLoggerLevels, "/n75/get_logger_levels", GetLoggerLevels.Request(names=["n75", "zz"])).levels
)
show(
    "set",
    lambda: (
        call(
            SetLoggerLevels,
            "/n75/set_logger_levels",
            SetLoggerLevels.Request(levels=[LoggerLevel(name="n75", level=10), LoggerLevel(name="a", level=77)]),
        ).results
    ),
)
n.get_logger().debug("now seen")
show(
    "get",
    lambda: [
        (x.name, x.level)
        for x in call(GetLoggerLevels, "/n75/get_logger_levels", GetLoggerLevels.Request(names=["n75"])).levels
    ],
)
show("services", lambda: sorted(x[0] for x in n.get_service_names_and_types_by_node("n75", "/")))
show("services g", lambda: sorted(x[0] for x in n.get_service_names_and_types_by_node("g75", "/")))
m = rclpy.create_node("m75", start_parameter_services=False, enable_rosout=False)
show(
    "services m",
    lambda: (
        until(ex, lambda: n.get_publisher_names_and_types_by_node("m75", "/"), 1),
        sorted(x[0] for x in n.get_service_names_and_types_by_node("m75", "/")),
        sorted(x[0] for x in n.get_publisher_names_and_types_by_node("m75", "/")),
    )[1:],
)
show("topics g", lambda: sorted(x[0] for x in n.get_publisher_names_and_types_by_node("g75", "/")))
show("subs g", lambda: sorted(x[0] for x in n.get_subscriber_names_and_types_by_node("g75", "/")))
show("params", lambda: n.list_parameters([], 0).names)
