"""Guesses of beginners, such as rclpy.Node, String("x") and swapped arguments."""

import time

import rclpy
from probe import show
from rclpy.node import Node
from rclpy.parameter import Parameter as P
from rclpy.qos import *
from std_msgs.msg import String

rclpy.init()
n = Node("n108")
show("throttle int", lambda: n.get_logger().info("t", throttle_duration_sec=1))
show("declare twice in a row", lambda: (n.declare_parameter("x", 1), n.declare_parameter("x", 1)))
show("get value of int as double", lambda: n.get_parameter("x").get_parameter_value().double_value)
show("string_value of int", lambda: n.get_parameter("x").get_parameter_value().string_value)
show("timer callback returns", lambda: (n.create_timer(0.05, lambda: 5), rclpy.spin_once(n, timeout_sec=0.3))[1])
show("spin_once returns", lambda: rclpy.spin_once(n, timeout_sec=0))
show("publish returns", lambda: n.create_publisher(String, "t", 1).publish(String()))
show("destroy_node returns", lambda: Node("d108").destroy_node())
show("destroy_timer returns", lambda: n.destroy_timer(n.create_timer(1, print)))
show("destroy_client returns", lambda: n.destroy_client(n.create_client(__import__("std_srvs.srv").srv.Empty, "e")))
show("set_parameters returns", lambda: type(n.set_parameters([P("x", value=2)])[0]).__name__)
show("shutdown returns", lambda: None)
show(
    "time now type",
    lambda: (type(n.get_clock().now()).__name__, n.get_clock().now().clock_type.name, n.get_clock().clock_type.name),
)
show("now - now", lambda: type(n.get_clock().now() - n.get_clock().now()).__name__)
show("now - Time()", lambda: n.get_clock().now() - rclpy.time.Time())
show("now + float", lambda: n.get_clock().now() + 1.0)
show("seconds", lambda: type(n.get_clock().now().nanoseconds).__name__)
show("stamp", lambda: type(n.get_clock().now().to_msg()).__name__)
show("from stamp compare", lambda: rclpy.time.Time.from_msg(n.get_clock().now().to_msg()) <= n.get_clock().now())
show("String('x')", lambda: String("x"))
show("String(Data)", lambda: String(Data="x"))
m = String()
show("misspelt", lambda: setattr(m, "dta", "x"))
show("print", lambda: print(String(data="x")))
show("f-string", lambda: f"{String(data='x')}")
show("in", lambda: "x" in String(data="x"))
show("qos list", lambda: n.create_publisher(String, "t", [1]))
show("qos profile class", lambda: n.create_publisher(String, "t", QoSProfile))
show("preset", lambda: n.create_publisher(String, "t", QoSPresetProfiles.SENSOR_DATA).topic_name)
show("preset value", lambda: n.create_publisher(String, "t", QoSPresetProfiles.SENSOR_DATA.value).topic_name)
show("callback called with", lambda: n.create_subscription(String, "t", print("called now"), 10))
show("callback result of call", lambda: n.create_timer(1.0, print()))
show("timer str", lambda: n.create_timer("1", print))
show("timer swapped", lambda: n.create_timer(print, 1.0))
show(
    "service no return",
    lambda: n.create_service(__import__("std_srvs.srv").srv.Empty, "e", lambda q, r: None).service_name,
)
show("sub no callback", lambda: n.create_subscription(String, "t", 10))
show("client name first", lambda: n.create_client("e", __import__("std_srvs.srv").srv.Empty))
show("action as service", lambda: n.create_client(__import__("test_msgs.action").action.Fibonacci, "f"))
show("get_name call missing", lambda: type(n.get_name).__name__)
show("spin class", lambda: rclpy.spin_once(Node, timeout_sec=0))
show("spin str", lambda: rclpy.spin_once("n", timeout_sec=0))
show("Node()", lambda: Node())
show("init in init", lambda: rclpy.init())
show("node.spin", lambda: n.spin())
show("rclpy.Node", lambda: rclpy.Node)
show("rclpy.node attr", lambda: rclpy.node.Node is Node)
show("rclpy.time", lambda: rclpy.time.Time)
show("rclpy.Duration", lambda: rclpy.Duration)
show("logwarn", lambda: n.get_logger().warning("w"))
show("get_logger().log", lambda: n.get_logger().log("w", 30))
show("create_subscriber", lambda: n.create_subscriber)
show("get_parameter value attr", lambda: n.get_parameter("x").value)
show("get_param", lambda: n.get_param("x"))
show("rclpy.sleep", lambda: rclpy.sleep(1))
show("rclpy.Rate", lambda: rclpy.Rate(1))
show("node.now", lambda: n.now())
