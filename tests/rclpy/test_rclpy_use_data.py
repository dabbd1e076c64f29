"""What public programs use of times, parameters, loggers, QoS profiles and messages does as in rclpy."""

from __future__ import annotations

import array
from typing import Any

import numpy as np
import pytest

from robolink import Context, Node
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.duration import Duration
from robolink.impl.log_output import Record
from robolink.impl.logging_severity import LoggingSeverity
from robolink.interfaces.builtin_interfaces.msg import Duration as DurationMsg
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovariance
from robolink.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    ParameterDescriptor,
    ParameterType,
    SetParametersResult,
)
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message
from robolink.parameter import Parameter
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from robolink.time import Time
from tests.support.rclpy_use import shows


@pytest.fixture
def node(virtual: Context) -> Node:
    return Node("robot", context=virtual, enable_rosout=False)


# --- times ------------------------------------------------------------------------------------------------------------


@shows("Time.to_msg", "Time.nanoseconds", "Time.from_msg", "Time.seconds_nanoseconds", "Time(seconds=)")
@shows("Time(nanoseconds=)", "message.to_msg", "message.from_msg", "message.nanoseconds", "message.seconds_nanoseconds")
def test_a_time_is_seconds_and_nanoseconds() -> None:
    time = Time(seconds=3, nanoseconds=500_000_000)
    assert (time.nanoseconds, time.seconds_nanoseconds()) == (3_500_000_000, (3, 500_000_000))
    assert time.to_msg() == TimeMsg(sec=3, nanosec=500_000_000)
    assert Time.from_msg(TimeMsg(sec=3, nanosec=5)) == Time(nanoseconds=3_000_000_005, clock_type=ClockType.ROS_TIME)
    assert (time - Time(seconds=1)).nanoseconds == 2_500_000_000


@shows("Duration.to_msg", "Duration.nanoseconds", "Duration.from_msg", "Duration(seconds=)", "Duration(nanoseconds=)")
def test_a_duration_is_seconds_and_nanoseconds() -> None:
    duration = Duration(seconds=1.5, nanoseconds=7)
    assert duration.nanoseconds == 1_500_000_007
    assert duration.to_msg() == DurationMsg(sec=1, nanosec=500_000_007)
    assert Duration.from_msg(DurationMsg(sec=-1, nanosec=5)).nanoseconds == -999_999_995
    assert Time(seconds=1) + duration > Time(seconds=2)


@shows("Clock.now", "message.now", "message.stamp", "message.header", "message.frame_id")
def test_now_stamps_a_message(node: Node) -> None:
    node.context.time.sleep(2_000_000_003)
    header = Header(stamp=node.get_clock().now().to_msg(), frame_id="map")
    pose = PoseStamped(header=header)
    assert pose.header.stamp == TimeMsg(sec=2, nanosec=3)
    pose.header.frame_id = "odom"
    assert pose.header == header
    assert Clock(clock_type=ClockType.STEADY_TIME).now() <= Clock(clock_type=ClockType.STEADY_TIME).now()


# --- parameters -------------------------------------------------------------------------------------------------------


@shows("Node.declare_parameter", "Node.get_parameter", "Node.has_parameter", "declare_parameter(value=)")
@shows("declare_parameter(descriptor=)", "Parameter.name", "Parameter.value", "Parameter.type_", "message.type_")
@shows("Parameter.get_parameter_value", "Parameter.to_parameter_msg", "Node.get_parameter_or", "Node.get_parameters")
@shows("message.value", "message.double_value", "message.string_value", "message.integer_value", "message.bool_value")
def test_a_parameter_has_a_name_a_type_and_a_value(node: Node) -> None:
    descriptor = ParameterDescriptor(description="m/s")
    speed = node.declare_parameter("speed", value=0.5, descriptor=descriptor)
    assert (speed.name, speed.value, speed.type_) == ("speed", 0.5, Parameter.Type.DOUBLE)
    assert (node.has_parameter("speed"), node.has_parameter("spede")) == (True, False)
    assert node.get_parameter("speed").get_parameter_value().double_value == 0.5
    message = speed.to_parameter_msg()
    assert (message.name, message.value.type) == ("speed", ParameterType.PARAMETER_DOUBLE)
    for name, value, field in (("name", "bob", "string_value"), ("n", 3, "integer_value"), ("on", True, "bool_value")):
        declared = node.declare_parameter(name, value)
        assert getattr(declared.get_parameter_value(), field) == value
    assert [each.value for each in node.get_parameters(["n", "on"])] == [3, True]
    assert node.get_parameter_or("none", Parameter("none", value=7)).value == 7
    assert node.describe_parameter("speed").description == "m/s"


@shows("Node.declare_parameters", "declare_parameters(namespace=)", "declare_parameters(parameters=)")
@shows("Node.list_parameters", "Node.undeclare_parameter")
def test_many_parameters_at_once(node: Node) -> None:
    made = node.declare_parameters(namespace="drive", parameters=[("speed", 0.5)])
    made += node.declare_parameters("drive", [("turn", 1.0, ParameterDescriptor(read_only=True))])
    assert [each.name for each in made] == ["drive.speed", "drive.turn"]
    assert sorted(node.list_parameters(["drive"], 2).names) == ["drive.speed", "drive.turn"]
    node.undeclare_parameter("drive.speed")
    assert not node.has_parameter("drive.speed")


@shows("Node.set_parameters", "Node.add_on_set_parameters_callback", "Node.add_post_set_parameters_callback")
@shows("Node.add_pre_set_parameters_callback", "SetParametersResult(successful=)", "SetParametersResult(reason=)")
@shows("Parameter(name=)", "Parameter(value=)")
def test_callbacks_change_refuse_and_hear_of_values(node: Node) -> None:
    heard: list[float] = []
    node.declare_parameters("", [("speed", 0.5), ("half", 0.25)])

    def judge(given: list[Parameter[float]]) -> SetParametersResult:
        fast = [each.name for each in given if each.value > 1.0]
        return SetParametersResult(successful=not fast, reason=f"too fast: {fast}")

    node.add_pre_set_parameters_callback(
        lambda given: [*given, *(Parameter("half", value=each.value / 2) for each in given)]
    )
    node.add_on_set_parameters_callback(judge)
    node.add_post_set_parameters_callback(lambda given: heard.extend(each.value for each in given))
    (good, *_) = node.set_parameters([Parameter(name="speed", value=0.8)])
    (bad, *_) = node.set_parameters([Parameter("speed", Parameter.Type.DOUBLE, 3.0)])
    assert (good.successful, bad.successful, bad.reason) == (True, False, "too fast: ['speed', 'half']")
    assert (node.get_parameter("speed").value, node.get_parameter("half").value, heard) == (0.8, 0.4, [0.8, 0.4])


@shows("ParameterDescriptor(name=)", "ParameterDescriptor(type=)", "ParameterDescriptor(description=)")
@shows("ParameterDescriptor(floating_point_range=)", "FloatingPointRange(from_value=)", "FloatingPointRange(to_value=)")
@shows("FloatingPointRange(step=)")
def test_a_descriptor_states_a_range(node: Node) -> None:
    allowed = FloatingPointRange(from_value=0.0, to_value=1.0, step=0.25)
    descriptor = ParameterDescriptor(
        name="speed", type=ParameterType.PARAMETER_DOUBLE, description="m/s", floating_point_range=[allowed]
    )
    node.declare_parameter("speed", 0.5, descriptor)
    outcome = [node.set_parameters([Parameter("speed", value=each)])[0].successful for each in (0.75, 0.6, 1.25, 1.0)]
    assert outcome == [True, False, False, True]


@shows("Node.__init__(allow_undeclared_parameters=)", "Node.__init__(automatically_declare_parameters_from_overrides=)")
@shows("Node.__init__(enable_logger_service=)")
def test_what_a_node_is_made_with(virtual: Context) -> None:
    node = Node(
        "node",
        context=virtual,
        allow_undeclared_parameters=True,
        automatically_declare_parameters_from_overrides=True,
        parameter_overrides=[Parameter("given", value=1)],
        enable_logger_service=True,
    )
    assert (node.get_parameter("given").value, node.get_parameter("unknown").value) == (1, None)
    services = [name for name, _ in node.get_service_names_and_types_by_node("node", "/")]
    assert {"/node/get_logger_levels", "/node/set_logger_levels"} <= {*services}


# --- loggers ----------------------------------------------------------------------------------------------------------


@shows("Logger.info", "Logger.error", "Logger.warn", "Logger.debug", "Logger.warning", "Logger.fatal", "Logger.log")
@shows("Logger.set_level")
def test_each_level_has_its_method(node: Node, log_lines: list[Record]) -> None:
    logger = node.get_logger()
    logger.set_level(LoggingSeverity.DEBUG)
    assert logger.debug("said")
    assert logger.info("said")
    assert logger.warn("said")
    assert logger.warning("said")
    assert logger.error("said")
    assert logger.fatal("said")
    assert logger.log("said", LoggingSeverity.INFO)
    logger.set_level(LoggingSeverity.ERROR)
    assert not logger.info("not said")
    said = LoggingSeverity
    levels = [said.DEBUG, said.INFO, said.WARN, said.WARN, said.ERROR, said.FATAL, said.INFO]
    assert [(each.severity, each.message) for each in log_lines] == [(level, "said") for level in levels]


@shows("info(throttle_duration_sec=)", "debug(throttle_duration_sec=)", "warn(throttle_duration_sec=)")
@shows("warn(throttle_time_source_type=)", "info(skip_first=)", "log(once=)", "error(once=)")
def test_a_line_can_be_held_back(node: Node, log_lines: list[Record]) -> None:
    logger, clock = node.get_logger(), node.get_clock()
    logger.set_level(LoggingSeverity.DEBUG)
    node.context.time.sleep(10_000_000_000)
    for _ in range(5):
        logger.info("a", throttle_duration_sec=1.0, throttle_time_source_type=clock)
        logger.debug("b", throttle_duration_sec=100.0)
        logger.warn("c", throttle_duration_sec=1.0, throttle_time_source_type=clock)
        logger.info("d", skip_first=True)
        logger.log("e", LoggingSeverity.INFO, once=True)
        logger.error("f", once=True)
        node.context.time.sleep(600_000_000)
    said = "".join(each.message for each in log_lines)
    assert {letter: said.count(letter) for letter in "abcdef"} == {"a": 3, "b": 1, "c": 3, "d": 4, "e": 1, "f": 1}


# --- QoS --------------------------------------------------------------------------------------------------------------


@shows("QoSProfile(history=)", "QoSProfile(deadline=)", "QoSProfile(lifespan=)", "QoSProfile(liveliness=)")
@shows("QoSProfile(liveliness_lease_duration=)")
def test_a_profile_reaches_those_who_look(node: Node) -> None:
    second = Duration(seconds=1)
    profile = QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=3,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        deadline=second,
        lifespan=second,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=second,
    )
    node.create_publisher(Header, "a", profile)
    (info,) = node.get_publishers_info_by_topic("/a")
    assert info.qos_profile == profile


# --- messages ---------------------------------------------------------------------------------------------------------


@shows("message.tolist")
def test_numbers_are_arrays() -> None:
    scan, pose = LaserScan(ranges=[1.0, 2.0]), PoseWithCovariance()
    numbers: list[Any] = [scan.ranges, pose.covariance]
    assert [type(each) for each in numbers] == [array.array, np.ndarray]
    assert [each.tolist() for each in numbers] == [[1.0, 2.0], [0.0] * 36]


@shows("message.Goal", "message.Result", "message.Feedback")
def test_an_action_type_has_three_parts() -> None:
    parts: list[Message] = [Fibonacci.Goal(order=3), Fibonacci.Result(sequence=[0, 1]), Fibonacci.Feedback()]
    assert [list(each.get_fields_and_field_types()) for each in parts] == [["order"], ["sequence"], ["sequence"]]


@shows("message.get_fields_and_field_types")
def test_a_message_knows_its_fields() -> None:
    assert Header.get_fields_and_field_types() == {"stamp": "builtin_interfaces/Time", "frame_id": "string"}
