"""Modules of rclpy and names in them that programs import."""

import importlib

from probe import show, typed

for m in "rclpy.action rclpy.action.client rclpy.action.server rclpy.action.graph rclpy.callback_groups rclpy.client rclpy.clock rclpy.clock_type rclpy.constants rclpy.context rclpy.duration rclpy.endpoint_info rclpy.event_handler rclpy.exceptions rclpy.executors rclpy.expand_topic_name rclpy.experimental rclpy.guard_condition rclpy.impl.implementation_singleton rclpy.impl.logging_severity rclpy.impl.rcutils_logger rclpy.lifecycle rclpy.lifecycle.managed_entity rclpy.lifecycle.node rclpy.lifecycle.publisher rclpy.logging rclpy.logging_service rclpy.node rclpy.parameter rclpy.parameter_client rclpy.parameter_event_handler rclpy.parameter_service rclpy.publisher rclpy.qos rclpy.qos_event rclpy.qos_overriding_options rclpy.serialization rclpy.service rclpy.service_introspection rclpy.signals rclpy.subscription rclpy.subscription_content_filter_options rclpy.task rclpy.time rclpy.time_source rclpy.timer rclpy.topic_endpoint_info rclpy.topic_or_service_is_hidden rclpy.type_description_service rclpy.type_hash rclpy.type_support rclpy.utilities rclpy.validate_full_topic_name rclpy.validate_namespace rclpy.validate_node_name rclpy.validate_parameter_name rclpy.validate_topic_name rclpy.wait_for_message rclpy.waitable".split():
    typed(m, lambda: importlib.import_module(m) and "ok")


def names(m, ns):
    for x in ns.split():
        typed(f"{m}.{x}", lambda: hasattr(importlib.import_module(m), x))


names(
    "rclpy.node",
    "Node ParameterDescriptor Parameter SetParametersResult NodeNameNonExistentError QoSProfile Publisher Subscription Client Service Timer Rate Clock ROSClock Executor CallbackGroup HIDDEN_NODE_PREFIX MsgType SrvType SrvTypeRequest SrvTypeResponse",
)
names(
    "rclpy.parameter",
    "Parameter parameter_dict_from_yaml_file parameter_value_to_python get_parameter_value PARAMETER_SEPARATOR_STRING AllowableParameterValue",
)
names(
    "rclpy.qos",
    "QoSProfile QoSHistoryPolicy qos_profile_sensor_data qos_check_compatible QoSCompatibility DeprecatedValue QoSPolicyEnum QoSPolicyKind InvalidQoSProfileException",
)
names("rclpy.action", "ActionClient ActionServer CancelResponse GoalResponse get_action_names_and_types")
names("rclpy.action.client", "ActionClient ClientGoalHandle")
names(
    "rclpy.action.server",
    "ServerGoalHandle RESULT_TIMEOUT default_goal_callback default_cancel_callback default_handle_accepted_callback GoalEvent CancelResponse GoalResponse ActionServer",
)
names("rclpy.task", "Future Task")
names("rclpy.duration", "Duration Infinite")
names("rclpy.timer", "Timer Rate TimerInfo")
names(
    "rclpy.executors",
    "Executor SingleThreadedExecutor MultiThreadedExecutor ExternalShutdownException ShutdownException TimeoutException await_or_execute ConditionReachedException TimeoutObject",
)
names("rclpy.clock", "Clock ROSClock ClockType JumpThreshold JumpHandle TimeJump ClockChange")
names(
    "rclpy.logging",
    "get_logger LoggingSeverity set_logger_level get_logger_effective_level get_logging_severity_from_string initialize shutdown clear_config configure get_logging_directory",
)
names("rclpy.type_support", "MsgT SrvT check_for_type_support check_is_valid_msg_type check_is_valid_srv_type Msg Srv")
names("rclpy.impl.rcutils_logger", "RcutilsLogger CallerId Throttle Once SkipFirst")
names("rclpy.waitable", "Waitable NumberOfEntities")
names(
    "rclpy.utilities",
    "get_default_context get_rmw_implementation_identifier ok shutdown try_shutdown timeout_sec_to_nsec remove_ros_args",
)
names(
    "rclpy.lifecycle",
    "Node LifecycleNode Publisher LifecyclePublisher State LifecycleState TransitionCallbackReturn ManagedEntity SimpleManagedEntity NodeMixin LifecycleNodeMixin",
)
names("rclpy.subscription", "Subscription MessageInfo CallbackType MsgType")
names("rclpy.publisher", "Publisher MsgType")
names("rclpy.client", "Client SrvType SrvTypeRequest SrvTypeResponse")
names("rclpy.service", "Service SrvType SrvTypeRequest SrvTypeResponse")
names(
    "rclpy.event_handler",
    "QoSPublisherMatchedInfo QoSMessageLostInfo QoSOfferedIncompatibleQoSInfo IncompatibleTypeInfo EventHandler UnsupportedEventTypeError",
)
from rclpy.client import Client
from rclpy.publisher import Publisher
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.task import Future

for t in (Future, Publisher, Subscription):
    show(f"{t.__name__}[int]", lambda: str(t[int]).split(".")[-1])
show("Client[a,b]", lambda: str(Client[int, int]).split(".")[-1] if True else 0)
names("std_msgs.msg", "String Header ColorRGBA Float64MultiArray")
names("builtin_interfaces.msg", "Time Duration")
names("rcl_interfaces.msg", "Log ParameterType SetParametersResult LoggerLevel")
names("rcl_interfaces.srv", "GetLoggerLevels SetLoggerLevels")
names("ament_index_python", "get_package_share_directory get_packages_with_prefixes PackageNotFoundError")
names("type_description_interfaces.srv", "GetTypeDescription")
names("unique_identifier_msgs.msg", "UUID")
names("action_msgs.msg", "GoalStatus GoalInfo")
names("lifecycle_msgs.msg", "State Transition")
names("rosidl_parser.definition", "NamespacedType")
names("rosidl_pycommon", "interface_base_classes")
names("rpyutils", "import_c_library")
names("rosidl_runtime_py", "message_to_yaml set_message_fields")
