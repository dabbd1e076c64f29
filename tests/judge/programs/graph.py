"""The graph as a node sees it: other nodes and their topics, services and actions."""

import rclpy
from probe import show, took, until
from rclpy.action import ActionClient, ActionServer
from std_msgs.msg import Int32, String
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci

rclpy.init()
n = rclpy.create_node("n49", namespace="g")
m = rclpy.create_node("m49")
h = rclpy.create_node("_hid")
p = n.create_publisher(String, "t49", 3)
s = m.create_subscription(String, "/g/t49", print, rclpy.qos.qos_profile_sensor_data)
sv = n.create_service(Trigger, "s49", print)
c = m.create_client(Trigger, "/g/s49")
a = ActionServer(n, Fibonacci, "a49", lambda g: None)
ac = ActionClient(m, Fibonacci, "/g/a49")
hp = n.create_publisher(String, "_h49", 1)
hp2 = n.create_publisher(String, "x/_y/z", 1)
until(n, lambda: n.count_subscribers("t49"), 2)
until(n, lambda: False, 0.5)
show("topics", lambda: n.get_topic_names_and_types())
show("topics no demangle", lambda: len(n.get_topic_names_and_types(no_demangle=True)) > 5)
show(
    "services", lambda: [x for x in n.get_service_names_and_types() if "param" not in x[0] and "type_desc" not in x[0]]
)
show("nodes", lambda: sorted(n.get_node_names()))
show("nodes ns", lambda: sorted(n.get_node_names_and_namespaces()))
show("encl", lambda: sorted(n.get_node_names_and_namespaces_with_enclaves()))
show("fq", lambda: sorted(n.get_fully_qualified_node_names()))
show("pubs by node", lambda: n.get_publisher_names_and_types_by_node("n49", "/g"))
show("subs by node", lambda: n.get_subscriber_names_and_types_by_node("m49", "/"))
show("srv by node", lambda: [x for x in n.get_service_names_and_types_by_node("n49", "/g") if "param" not in x[0]])
show("cl by node", lambda: n.get_client_names_and_types_by_node("m49", "/"))
show("unknown node", lambda: n.get_publisher_names_and_types_by_node("zz", "/"))
show("bad node", lambda: n.get_publisher_names_and_types_by_node("a b", "/"))
show("ns without slash", lambda: n.get_publisher_names_and_types_by_node("n49", "g"))
show("empty ns", lambda: n.get_subscriber_names_and_types_by_node("m49", ""))
show("count pubs", lambda: (n.count_publishers("t49"), n.count_publishers("/g/t49"), n.count_publishers("/zz")))
show("count bad", lambda: n.count_publishers("a b"))
show("count clients", lambda: (n.count_clients("s49"), n.count_services("s49")))
i = n.get_publishers_info_by_topic("t49")
show(
    "info",
    lambda: [
        (
            x.node_name,
            x.node_namespace,
            x.topic_type,
            str(x.endpoint_type),
            x.qos_profile.depth,
            x.qos_profile.history,
            x.qos_profile.reliability,
            x.qos_profile.durability,
        )
        for x in i
    ],
)
show("gid", lambda: (type(i[0].endpoint_gid).__name__, len(i[0].endpoint_gid)))
show("hash", lambda: str(i[0].topic_type_hash))
show("subs info", lambda: [(x.node_name, x.qos_profile.reliability) for x in n.get_subscriptions_info_by_topic("t49")])
show(
    "info str", lambda: str(i[0]).replace("[" + ", ".join(str(b) for b in i[0].endpoint_gid) + "]", "GID").splitlines()
)
show("no such", lambda: n.get_publishers_info_by_topic("zz"))
show("bad", lambda: n.get_publishers_info_by_topic("a b"))
show(
    "service clients info",
    lambda: (
        [
            (x.node_name, x.endpoint_count) if hasattr(x, "endpoint_count") else x.node_name
            for x in n.get_clients_info_by_service("s49")
        ]
        if hasattr(n, "get_clients_info_by_service")
        else "no method"
    ),
)
from rclpy.action import (
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)

show("actions", lambda: get_action_names_and_types(n))
show("action servers", lambda: get_action_server_names_and_types_by_node(n, "n49", "/g"))
show("action clients", lambda: get_action_client_names_and_types_by_node(n, "m49", "/"))
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden as hid

show("hidden", lambda: [hid(x) for x in ("/_a", "/a/_b", "/a", "_a", "/a_b")])
show(
    "resolve",
    lambda: (
        n.resolve_topic_name("a"),
        n.resolve_topic_name("~/a"),
        n.resolve_service_name("/a"),
        n.resolve_topic_name("{node}/x", only_expand=True),
    ),
)
show("resolve bad", lambda: n.resolve_topic_name("a b"))
show("wait_for_node", lambda: n.wait_for_node("m49", 1.0) if hasattr(n, "wait_for_node") else "none")
took("wait_for_node none", lambda: n.wait_for_node("zz", 0.5), unit=0.5)
m.destroy_node()
until(n, lambda: "m49" not in n.get_node_names(), 3)
show("gone", lambda: sorted(n.get_node_names()))
show("count", lambda: n.count_subscribers("t49"))
