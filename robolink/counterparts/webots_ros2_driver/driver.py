"""Drive a robot of a world as Webots' driver does: by the plugins of its URDF, with topics for its devices.

robolink run webots_ros2_driver driver --ros-args -p robot:=my_robot -p robot_description:=my_robot.urdf
"""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Callable
from typing import Any

import robolink
from robolink.context import Context
from robolink.counterparts.webots_ros2_driver.relays import Relay, make_relays
from robolink.counterparts.webots_ros2_driver.section import (
    IMU,
    Section,
    WebotsNode,
    load_plugin,
    read_section,
    why_left_out,
)
from robolink.documents.foreign import warnings_to
from robolink.exceptions import ExternalShutdownException, RobolinkError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.message import type_name
from robolink.node import Node
from robolink.parameters.descriptors import described
from robolink.signals import SignalHandlerOptions
from robolink.text.names import spelled
from robolink.webots_controller.robot import ALONE, WAIT, Robot
from robolink.webots_controller.sensors import quoted
from robolink.webots_controller.webots_controller import robot_name

COMMAND = "joint_command"
CONNECTED = "Controller successfully connected to robot in Webots simulation."
"""Line that Webots' driver logs; launch files wait for it."""


class WebotsDriver(Node):
    """The driver's node: finds its robot, relays the topics of its devices, and calls its plugins.

    Args:
        **options: Those of `Node`.

    Raises:
        DocumentError: for a mistake in the robot description.
        PluginError: for a plugin that is not there.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("webots_driver", **options)
        self.robot_name = str(self._declare("robot", robot_name(os.environ), "name of the robot; '' for the only one"))
        description = str(self._declare("robot_description", "", "path of the robot's .urdf or .xacro file"))
        mappings = self._declare("xacro_mappings", [""], "arguments of xacro, name:=value")
        self._declare("set_robot_state_publisher", False, "of no effect: the world publishes transforms itself")
        self._declare("components_remappings", "", "of no effect")
        with warnings_to(self.get_logger().warning):
            self.section = read_section(description, filter(None, mappings))
        self._classes = self._load()
        self._plugins: list[Any] = []
        self._relays: list[Relay] = []

    def _declare(self, name: str, default: Any, description: str) -> Any:
        return self.declare_parameter(name, default, described(description)).value

    def _load(self) -> list[tuple[Callable[[], Any], dict[str, str]]]:
        """Return the classes of the plugins with their settings; say which are left out."""
        for each in self.section.plugins:
            if reason := why_left_out(each):
                self.get_logger().warning(f"left out: plugin {each.kind}: {reason}")
        return [(load_plugin(each), each.settings) for each in self.section.plugins if "::" not in each.kind]

    def find_robot(self) -> Robot | None:
        """Return the robot once the world has it; None while it has not."""
        prefix = robot_prefix(self, self.robot_name)
        return None if prefix is None else Robot(self, self.robot_name, prefix)

    def begin(self, robot: Robot) -> None:
        """Make the plugins and the relays of a robot of which something was heard."""
        imus = [each.settings for each in self.section.plugins if each.kind == IMU]
        self._relays = make_relays(self, robot.topics, Section(*self.section), imus)
        for make, settings in self._classes:
            plugin = make()
            plugin.init(WebotsNode(robot), dict(settings))
            self._plugins.append(plugin)
        self.get_logger().info(CONNECTED)

    def on_step(self) -> None:
        """Call the plugins after a step of the world."""
        for relay in self._relays:
            relay.look()
        for plugin in self._plugins:
            plugin.step()

    def end(self) -> None:
        """Call `stop` of the plugins that have one."""
        for plugin in self._plugins:
            with contextlib.suppress(RobolinkError):  # the context has ended
                getattr(plugin, "stop", int)()


def robot_prefix(node: Node, name: str) -> str | None:
    """Return how the names of a robot's topics begin, `/` or `/NAME/`; None as long as it is not there.

    The world subscribes to a robot's joint_command. The topics of an only robot have no name in front.

    Args:
        node: Node that looks.
        name: Name of the robot; '' for the only one.
    """
    found, expected = node.get_topic_names_and_types(), type_name(JointState)
    commands = [topic for topic, types in found if topic.endswith(f"/{COMMAND}") and expected in types]
    prefixes = [each.removesuffix(COMMAND) for each in commands if node.count_subscribers(each)]
    own = next((each for each in prefixes if name and each.endswith(f"/{spelled(name, 'robot')}/")), None)
    if own is not None or len(prefixes) != 1:
        return own
    is_unnamed = prefixes[0] in ("/", f"{node.get_namespace().rstrip('/')}/")
    return prefixes[0] if is_unnamed or not name else None


def connect(node: WebotsDriver, executor: SingleThreadedExecutor) -> Robot | None:
    """Return the driver's robot once the world has it, and has made a step; None at the end of the context."""
    began, is_logged = node.get_clock().now().nanoseconds, False
    while node.context.ok():
        robot = node.find_robot()
        if robot is not None:
            return robot if robot.step() == 0 else None
        executor.spin_once(timeout_sec=WAIT / 5)
        if not is_logged and node.get_clock().now().nanoseconds - began > ALONE * 1e9:
            is_logged = True
            _warn(node)
    return None


def _warn(node: Node) -> None:
    found = node.get_topic_names_and_types()
    others = [name.split("/")[-2] for name, _ in found if name.endswith(f"/{COMMAND}") and name.count("/") > 1]
    hint = f"there is {quoted(others)}" if others else "does a world run?"
    node.get_logger().warning(f"waiting for the robot '{getattr(node, 'robot_name', '')}': {hint}")


def main(args: list[str] | None = None) -> None:
    """Drive a robot until the world or the process ends.

    Its context is its own, since plugins call `rclpy.init()` themselves. As in Webots' driver, the command line is for
    the driver alone and not for the nodes of its plugins.

    Args:
        args: Command line with the program's name; None for `sys.argv`.
    """
    words = list(sys.argv if args is None else args)
    del sys.argv[1:]
    context = Context()
    robolink.init(args=words, context=context, signal_handler_options=SignalHandlerOptions.ALL)
    executor = SingleThreadedExecutor(context=context)
    try:
        drive(WebotsDriver(context=context), executor)
    finally:
        executor.shutdown()
        context.try_shutdown()


def drive(node: WebotsDriver, executor: SingleThreadedExecutor) -> None:
    """Find the robot of a driver and call its plugins, until the context of `node` ends; then stop the motors."""
    executor.add_node(node)
    robot: Robot | None = None
    try:
        with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
            robot = connect(node, executor)
            if robot is not None:
                node.begin(robot)
            while robot is not None and robot.step() == 0:
                node.on_step()
    finally:
        node.end()
        if robot is not None:
            with contextlib.suppress(RobolinkError):
                robot.halt()
        node.destroy_node()
