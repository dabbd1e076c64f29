"""Time source of a node's clock: the system, or /clock while the parameter use_sim_time is true."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import MutuallyExclusiveCallbackGroup
from robolink.clock import ROSClock
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.rosgraph_msgs.msg import Clock as ClockMsg
from robolink.parameter import Parameter
from robolink.qos import QoSProfile, ReliabilityPolicy
from robolink.time import Time, sent_time

if TYPE_CHECKING:
    from robolink.node_parts.ports import TimedNode
    from robolink.subscription import Subscription

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"


class TimeSource:
    """Source of ROS time for the clocks attached to it; it follows the parameter use_sim_time of `node`."""

    def __init__(self, *, node: TimedNode | None = None) -> None:
        self._clocks: list[ROSClock] = []
        self._node: weakref.ReferenceType[TimedNode] | None = None  # weak: what nobody else refers to goes at once
        self._clock_sub: Subscription[ClockMsg] | None = None
        self._active = False
        self._last: Time | None = None
        if node is not None:
            self.attach_node(node)

    @property
    def ros_time_is_active(self) -> bool:
        """True while the time comes from /clock."""
        return self._active

    @ros_time_is_active.setter
    def ros_time_is_active(self, enabled: bool) -> None:
        if self._active == enabled:
            return
        self._active = enabled
        for clock in self._clocks:
            clock._set_ros_time_is_active(enabled)
        if enabled:
            self._subscribe()
        else:
            self._unsubscribe()

    def attach_node(self, node: TimedNode) -> None:
        """Follow the parameter use_sim_time of `node`, which is declared if it is not yet.

        Raises TypeError for what is not a node, or if the parameter is not a bool.
        """
        if not hasattr(node, "declare_parameter"):
            raise TypeError(f"node: expected a Node, got {type(node)}")
        if self._node is not None:
            self.detach_node()
        self._node = weakref.ref(node)
        if not node.has_parameter(USE_SIM_TIME_NAME):
            node.declare_parameter(USE_SIM_TIME_NAME, False)
        value = node.get_parameter(USE_SIM_TIME_NAME)
        if value.type_ is not Parameter.Type.BOOL:
            raise TypeError(f"{USE_SIM_TIME_NAME}: expected a bool, got {value.value!r}")
        self.ros_time_is_active = value.value
        node.add_on_set_parameters_callback(self._on_parameters)

    def detach_node(self) -> None:
        """Follow no node."""
        self.ros_time_is_active = False
        node = self._get_node()
        if node is not None:
            node.remove_on_set_parameters_callback(self._on_parameters)
        self._node = None

    def _get_node(self) -> TimedNode | None:
        return None if self._node is None else self._node()

    def attach_clock(self, clock: ROSClock) -> None:
        """Set this `clock` from now on. Raises ValueError for what is not a ROSClock."""
        if not isinstance(clock, ROSClock):
            raise ValueError("Only clocks with type ROS_TIME can be attached.")
        if self._last is not None:
            clock.set_ros_time_override(self._last)
        clock._set_ros_time_is_active(self._active)
        self._clocks.append(clock)

    def clock_callback(self, msg: ClockMsg) -> None:
        """Set the clocks to the time of `msg`, a message of /clock."""
        try:
            time = sent_time(msg.clock)
        except ValueError as error:  # rclpy raises here, and whoever publishes one such message ends every node
            node = self._get_node()
            if node is not None:
                node.get_logger().warning(f"a time on {CLOCK_TOPIC} is ignored: {error}", once=True)
            return
        self._last = time
        for clock in self._clocks:
            clock.set_ros_time_override(time)

    def _subscribe(self) -> None:
        node = self._get_node()
        if self._clock_sub is None and node is not None:
            qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
            # A group of its own: time goes on while a coroutine of the node waits for it.
            self._clock_sub = node.create_subscription(
                ClockMsg, CLOCK_TOPIC, self.clock_callback, qos, **node._in_group_(MutuallyExclusiveCallbackGroup())
            )

    def _unsubscribe(self) -> None:
        node = self._get_node()
        if self._clock_sub is not None and node is not None:
            node.destroy_subscription(self._clock_sub)
        self._clock_sub = None

    def _on_parameters(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name != USE_SIM_TIME_NAME:
                continue
            if parameter.type_ is not Parameter.Type.BOOL:
                return SetParametersResult(successful=False, reason=f"{USE_SIM_TIME_NAME} must be a bool")
            self.ros_time_is_active = parameter.value
        return SetParametersResult(successful=True)
