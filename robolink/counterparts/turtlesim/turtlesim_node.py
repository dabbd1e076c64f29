"""turtlesim: turtles that draw with pens, in a window that the browser shows."""

from __future__ import annotations

import contextlib
import math
import sys
from typing import TYPE_CHECKING, Any

import robolink
from robolink import Node
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.counterparts.turtlesim.picture import BACKGROUND, Canvas, Colour, Drawn
from robolink.counterparts.turtlesim.turtle import CENTRE, PERIOD, SIZE, Pen, Rotation, Turtle
from robolink.counterparts.turtlesim.window import draw_in_terminal, terminal_room, window
from robolink.exceptions import ExternalShutdownException
from robolink.image.codecs import png_of
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.rcl_interfaces.msg import ParameterEvent
from robolink.interfaces.sensor_msgs.msg import CompressedImage
from robolink.interfaces.std_srvs.srv import Empty
from robolink.interfaces.turtlesim.msg import Color, Pose
from robolink.interfaces.turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data

if TYPE_CHECKING:
    from collections.abc import Callable

    from robolink.node import Node

DEPTH = 7
"""Depth of the topics' queues, as turtlesim has it."""

PICTURE = "~/_picture"
"""Topic of the window's picture: hidden, since turtlesim has none. The page of `robolink view` shows it."""

PICTURE_EVERY = 2
"""Steps from one picture to the next: 31 pictures a second."""

MOST_TURTLES = 200
"""Turtles at once: each has twenty entities on the network."""


class RunningTurtle:
    """A turtle with its topics, services and action, until it is destroyed.

    Args:
        node: Node to which they belong.
        name: Name of the turtle, which begins their names.
        turtle: Its state.
        shell: Number of its colour.
        now: Function that returns the time in seconds.
    """

    def __init__(self, node: Node, name: str, turtle: Turtle, shell: int, now: Callable[[], float]) -> None:
        self.name, self.turtle, self._shell = name, turtle, shell
        self._node, self._now = node, now
        self._rotation = Rotation(node, name, turtle)
        self._cmd_vel = node.create_subscription(Twist, f"{name}/cmd_vel", self._on_cmd_vel, DEPTH)
        self._pose = node.create_publisher(Pose, f"{name}/pose", DEPTH)
        self._colour = node.create_publisher(Color, f"{name}/color_sensor", DEPTH)
        self._services = [
            node.create_service(SetPen, f"{name}/set_pen", self._on_set_pen),
            node.create_service(TeleportRelative, f"{name}/teleport_relative", self._on_teleport_relative),
            node.create_service(TeleportAbsolute, f"{name}/teleport_absolute", self._on_teleport_absolute),
        ]

    def destroy(self) -> None:
        """Take the turtle from the network."""
        self._rotation.destroy()
        for service in self._services:
            self._node.destroy_service(service)
        self._node.destroy_publisher(self._pose)
        self._node.destroy_publisher(self._colour)
        self._node.destroy_subscription(self._cmd_vel)

    @property
    def drawn(self) -> Drawn:
        """The turtle as it is drawn."""
        return Drawn(self.turtle.x, self.turtle.y, self.turtle.theta, self._shell)

    def update(self, canvas: Canvas) -> bool:
        """Move by one step, draw on the canvas, and publish; True if there is something new to see."""
        turtle, before = self.turtle, self.drawn
        self._rotation.cancel_if_requested()
        step = turtle.step(self._now())
        canvas.draw(step.jumps)
        if step.turn is not None:
            self._rotation.report(step.turn)
        if step.hit is not None:
            x, y = step.hit[0], SIZE - step.hit[1]  # from the top, as turtlesim tells it
            self._node.get_logger().warning(f"Oh no! I hit the wall! (Clamping from [x={x:f}, y={y:f}])")
        speed = math.hypot(turtle.linear, turtle.sideways)
        self._pose.publish(
            Pose(x=turtle.x, y=turtle.y, theta=turtle.theta, linear_velocity=speed, angular_velocity=turtle.angular)
        )
        r, g, b = canvas.colour_at(turtle.x, turtle.y)
        self._colour.publish(Color(r=r, g=g, b=b))
        if step.line is not None:
            canvas.draw([step.line])
        return bool(step.jumps) or before != self.drawn

    def _on_cmd_vel(self, twist: Twist) -> None:
        self._rotation.abort("Velocity command received during rotation goal. Aborting goal")
        holonomic = bool(self._node.get_parameter("holonomic").value)
        self.turtle.drive(twist.linear.x, twist.angular.z, self._now(), twist.linear.y if holonomic else 0.0)

    def _on_set_pen(self, request: SetPen.Request, response: Any) -> Any:
        if request.off:
            self.turtle.pen = self.turtle.pen._replace(is_off=True)
        else:
            self.turtle.pen = Pen(request.r, request.g, request.b, request.width or 1)
        return response

    def _on_teleport_relative(self, request: TeleportRelative.Request, response: Any) -> Any:
        self.turtle.jump_ahead(request.linear, request.angular)
        return response

    def _on_teleport_absolute(self, request: TeleportAbsolute.Request, response: Any) -> Any:
        self.turtle.jump_to(request.x, request.y, request.theta)
        return response


class TurtleSim(Node):
    """The node of turtlesim: its turtles, and its window as a topic of pictures."""

    def __init__(self, **options: Any) -> None:
        super().__init__("turtlesim", **options)
        for channel, value in zip(("Red", "Green", "Blue"), BACKGROUND, strict=True):
            descriptor = described(f"{channel} channel of the background color", 0, 255)
            self.declare_parameter(f"background_{channel[0].lower()}", value, descriptor)
        self.declare_parameter("holonomic", False, described("If true, then turtles will be holonomic"))
        self.steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=self.context.time)
        self.canvas = Canvas(self.background())
        self.turtles: dict[str, RunningTurtle] = {}
        self.named = self.made = self.steps = self.viewers = 0
        self.is_changed = True
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.picture = self.create_publisher(CompressedImage, PICTURE, latched)
        self.create_subscription(ParameterEvent, "/parameter_events", self.on_parameters, qos_profile_sensor_data)
        self.create_service(Empty, "clear", self.on_clear)
        self.create_service(Empty, "reset", self.on_reset)
        self.create_service(Spawn, "spawn", self.on_spawn)
        self.create_service(Kill, "kill", self.on_kill)
        self.get_logger().info(f"Starting turtlesim with node name {self.get_fully_qualified_name()}")
        self.spawn("", CENTRE, CENTRE, 0.0)
        self.create_timer(PERIOD, self.update, clock=self.steady)

    def now(self) -> float:
        """Time in seconds, of a clock that nobody sets."""
        return self.steady.now().nanoseconds / 1e9

    def background(self) -> Colour:
        """Colour of the background, by the parameters."""
        r, g, b = (int(self.get_parameter(f"background_{channel}").value) for channel in "rgb")
        return r, g, b

    def update(self) -> None:
        """Move all turtles by one step, and publish the picture if it is new and somebody looks."""
        for turtle in list(self.turtles.values()):
            self.is_changed |= turtle.update(self.canvas)
        self.steps += 1
        if self.steps % PICTURE_EVERY == 0:
            self.show()

    def show(self) -> None:
        """Publish the picture if it is new, or if somebody else has come to look."""
        before, self.viewers = self.viewers, self.picture.get_subscription_count()
        if self.viewers and (self.is_changed or self.viewers > before):
            self.is_changed = False
            picture = png_of(self.canvas.picture(each.drawn for each in self.turtles.values()))
            self.picture.publish(CompressedImage(format="png", data=picture))

    def spawn(self, name: str, x: float, y: float, theta: float) -> str:
        """Make a turtle, and return its name; '' with a line in the log if it cannot be made.

        Args:
            name: Its name; '' takes the next free one, as `turtle2`.
            x: Its place in metres, to the right.
            y: Its place in metres, upwards.
            theta: Its heading in radians.
        """
        name = name or self.free_name()
        if refusal := self.refusal(name):
            self.get_logger().error(refusal)
            return ""
        turtle = Turtle(x, y, theta)
        self.turtles[name] = RunningTurtle(self, name, turtle, self.made, self.now)
        self.made, self.is_changed = self.made + 1, True
        self.get_logger().info(f"Spawning turtle [{name}] at x=[{x:f}], y=[{y:f}], theta=[{theta:f}]")
        return name

    def free_name(self) -> str:
        """Return the next name that no turtle has, counted from the last reset on."""
        while True:
            self.named += 1
            if (name := f"turtle{self.named}") not in self.turtles:
                return name

    def refusal(self, name: str) -> str:
        """Return why there can be no turtle of this name; '' if there can."""
        if name in self.turtles:
            return f"A turtle named [{name}] already exists"
        if len(self.turtles) >= MOST_TURTLES:
            return f"There are {MOST_TURTLES} turtles already: kill some first"
        try:
            self.resolve_service_name(
                f"{name}/rotate_absolute/_action/cancel_goal"
            )  # the longest name that it will have
        except ValueError:
            return f"No turtle can be named [{name}]: its topics would have that in their names"
        return ""

    def clear(self) -> None:
        """Take all lines away."""
        self.canvas.clear()
        self.is_changed = True

    def kill(self, name: str) -> None:
        """Take a turtle away; its lines stay."""
        self.turtles.pop(name).destroy()
        self.is_changed = True

    def on_parameters(self, event: ParameterEvent) -> None:
        """Change the background."""
        if event.node == self.get_fully_qualified_name():
            self.canvas.background = self.background()
            self.is_changed = True

    def on_clear(self, request: Empty.Request, response: Any) -> Any:
        """Take all lines away."""
        self.get_logger().info("Clearing turtlesim.")
        self.clear()
        return response

    def on_reset(self, request: Empty.Request, response: Any) -> Any:
        """Begin anew, with one turtle."""
        self.get_logger().info("Resetting turtlesim.")
        for name in list(self.turtles):
            self.kill(name)
        self.named = self.made = 0
        self.spawn("", CENTRE, CENTRE, 0.0)
        self.clear()
        return response

    def on_spawn(self, request: Spawn.Request, response: Any) -> Any:
        """Make a turtle."""
        response.name = self.spawn(request.name, request.x, request.y, request.theta)
        return response

    def on_kill(self, request: Kill.Request, response: Any) -> Any:
        """Take a turtle away."""
        if request.name in self.turtles:
            self.kill(request.name)
        else:
            self.get_logger().error(f"Tried to kill turtle [{request.name}], which does not exist")
        return response


def main(args: list[str] | None = None) -> None:
    """Run turtlesim until Ctrl-C, with its window in the browser; with `--terminal` in the terminal instead."""
    ends = contextlib.suppress(KeyboardInterrupt, ExternalShutdownException)
    with robolink.init(args=args), ends, contextlib.ExitStack() as stack:
        size = stack.enter_context(terminal_room()) if "--terminal" in (sys.argv if args is None else args) else 0
        node = TurtleSim()
        stack.callback(node.destroy_node)
        if size:
            draw_in_terminal(node, size)
        else:
            stack.enter_context(window(node, node.picture.topic_name))
        robolink.spin(node)


if __name__ == "__main__":
    main()
