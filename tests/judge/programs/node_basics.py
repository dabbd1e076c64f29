"""The names, namespaces and attributes of a Node, when it is made and after it is destroyed."""

import rclpy
from probe import show
from rclpy.node import Node
from std_msgs.msg import String

rclpy.init()
n = Node("my_node")
show("name", n.get_name)
show("ns", n.get_namespace)
show("fqn", n.get_fully_qualified_name)
show("repr", lambda: "Node" in repr(n))
show("logger name", lambda: n.get_logger().name)
m = Node("m", namespace="a/b")
show("ns", m.get_namespace)
show("logger", lambda: m.get_logger().name)
show("fqn", m.get_fully_qualified_name)
m = Node("m", namespace="/a")
show("ns", m.get_namespace)
for bad in ["", "a b", "1a", "a/b", "/a", "a-b", "a" * 256, "é", None, 3]:
    show(f"node name {str(bad)[:5]!r}", lambda: Node(bad).get_name())
for bad in ["a/", "/", "//a", "1a", "a b", "/1", "~", "a//b", None, 3, "/a/"]:
    show(f"namespace {bad!r}", lambda: Node("x", namespace=bad).get_namespace())
show("publishers", lambda: [p.topic_name for p in n.publishers])
show("subscriptions", lambda: list(n.subscriptions))
show("timers", lambda: list(n.timers))
show("services", lambda: [s.srv_name for s in n.services])
show("clients", lambda: list(n.clients))
show("guards", lambda: list(n.guards))
show("waitables", lambda: len(list(n.waitables)))
show("executor", lambda: n.executor)
show("default group", lambda: type(n.default_callback_group).__name__)
show("handle", lambda: type(n.handle).__name__)
show("unset attribute", lambda: n.nothing)
show("set attribute", lambda: setattr(n, "nothing", 1))
show("destroy", n.destroy_node)
show("destroy twice", n.destroy_node)
show("name after destroy", n.get_name)
show("logger after destroy", lambda: n.get_logger().name)
show("clock after destroy", lambda: type(n.get_clock().now()).__name__)
show("pub after destroy", lambda: n.create_publisher(String, "t", 1))
show("sub after destroy", lambda: n.create_subscription(String, "t", print, 1))
show("timer after destroy", lambda: n.create_timer(1.0, print))
show("param after destroy", lambda: n.declare_parameter("a", 1).value)
show("spin after destroy", lambda: rclpy.spin_once(n, timeout_sec=0.1))
show("topics after destroy", lambda: n.get_topic_names_and_types())
show("with node", lambda: Node("w").__enter__())
show("two nodes same name", lambda: (Node("same"), Node("same"))[1].get_name())
show("positional extra", lambda: Node("a", None, None, None))
show("unknown option", lambda: Node("a", foo=1))


class Bad(Node):
    def __init__(self):
        self.create_timer(1.0, print)


show("no super init", Bad)


class Bad2(Node):
    def __init__(self):
        pass


show("no super init get_logger", lambda: Bad2().get_logger())
show("no super init spin", lambda: rclpy.spin_once(Bad2(), timeout_sec=0.1))
rclpy.shutdown()
show("node after shutdown", lambda: Node("z"))
