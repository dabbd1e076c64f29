"""Arguments of rclpy's functions by keyword."""

import rclpy
from probe import kindof, show
from rclpy.action import ActionClient, ActionServer
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import *
from std_msgs.msg import String
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci

rclpy.init(args=None, context=None, domain_id=None, signal_handler_options=None)
g = ReentrantCallbackGroup()
kindof(
    "Node",
    lambda: Node(
        node_name="n87",
        context=None,
        cli_args=None,
        namespace="",
        use_global_arguments=True,
        enable_rosout=True,
        start_parameter_services=True,
        parameter_overrides=None,
        allow_undeclared_parameters=False,
        automatically_declare_parameters_from_overrides=False,
        enable_logger_service=False,
    ),
)
kindof("Node rosout qos", lambda: Node("n87", rosout_qos_profile=qos_profile_sensor_data))
kindof("Node rosout int", lambda: Node("n87", rosout_qos_profile=3))
n = rclpy.create_node(
    node_name="n87",
    context=None,
    cli_args=None,
    namespace=None,
    use_global_arguments=True,
    enable_rosout=True,
    start_parameter_services=True,
    parameter_overrides=None,
    allow_undeclared_parameters=False,
    automatically_declare_parameters_from_overrides=False,
    enable_logger_service=False,
)
kindof(
    "publisher",
    lambda: n.create_publisher(
        msg_type=String,
        topic="t",
        qos_profile=10,
        callback_group=g,
        event_callbacks=PublisherEventCallbacks(),
        qos_overriding_options=None,
        publisher_class=rclpy.publisher.Publisher,
    ),
)
kindof(
    "subscription",
    lambda: n.create_subscription(
        msg_type=String,
        topic="t",
        callback=print,
        qos_profile=10,
        callback_group=g,
        event_callbacks=SubscriptionEventCallbacks(),
        qos_overriding_options=None,
        raw=False,
    ),
)
kindof(
    "client",
    lambda: n.create_client(srv_type=Trigger, srv_name="s", qos_profile=qos_profile_services_default, callback_group=g),
)
kindof(
    "service",
    lambda: n.create_service(
        srv_type=Trigger, srv_name="s", callback=print, qos_profile=qos_profile_services_default, callback_group=g
    ),
)
kindof(
    "timer",
    lambda: n.create_timer(timer_period_sec=1.0, callback=print, callback_group=g, clock=n.get_clock(), autostart=True),
)
kindof("guard", lambda: n.create_guard_condition(callback=print, callback_group=g))
kindof("rate", lambda: n.create_rate(frequency=1.0, clock=n.get_clock()))
kindof(
    "action server",
    lambda: ActionServer(
        node=n,
        action_type=Fibonacci,
        action_name="a",
        execute_callback=print,
        callback_group=g,
        goal_callback=print,
        handle_accepted_callback=print,
        cancel_callback=print,
        goal_service_qos_profile=qos_profile_services_default,
        result_service_qos_profile=qos_profile_services_default,
        cancel_service_qos_profile=qos_profile_services_default,
        feedback_pub_qos_profile=QoSProfile(depth=10),
        status_pub_qos_profile=qos_profile_action_status_default,
        result_timeout=10,
    ),
)
kindof(
    "action client",
    lambda: ActionClient(
        node=n,
        action_type=Fibonacci,
        action_name="a",
        callback_group=g,
        goal_service_qos_profile=qos_profile_services_default,
        result_service_qos_profile=qos_profile_services_default,
        cancel_service_qos_profile=qos_profile_services_default,
        feedback_sub_qos_profile=QoSProfile(depth=10),
        status_sub_qos_profile=qos_profile_action_status_default,
    ),
)
kindof(
    "declare",
    lambda: n.declare_parameter(
        name="p",
        value=1,
        descriptor=rclpy.node.ParameterDescriptor() if hasattr(rclpy.node, "ParameterDescriptor") else None,
        ignore_override=False,
    ),
)
kindof("declares", lambda: n.declare_parameters(namespace="", parameters=[("q", 1)], ignore_override=False))
show("get_or", lambda: n.get_parameter_or(name="z", alternative_value=rclpy.parameter.Parameter("z", value=1)).value)
show("set", lambda: len(n.set_parameters(parameter_list=[])))
show("list", lambda: n.list_parameters(prefixes=[], depth=0).names[:1])
kindof("client depth qos int", lambda: n.create_client(Trigger, "s2", qos_profile=10))
kindof("service qos int", lambda: n.create_service(Trigger, "s3", print, qos_profile=10))
kindof("positional group", lambda: n.create_timer(1.0, print, g))
kindof("pub positional", lambda: n.create_publisher(String, "t", 1, callback_group=None))
kindof("content filter", lambda: n.create_subscription(String, "t", print, 1, content_filter_options=None))
kindof("spin kw", lambda: rclpy.spin_once(node=n, executor=None, timeout_sec=0))
kindof(
    "until kw",
    lambda: rclpy.spin_until_future_complete(node=n, future=rclpy.task.Future(), executor=None, timeout_sec=0),
)
kindof("shutdown kw", lambda: rclpy.shutdown(context=None, uninstall_handlers=None))
