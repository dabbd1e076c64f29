"""turtlesim: turtles that draw with pens, in a window that the browser shows."""

from __future__ import annotations

import contextlib
import sys
from typing import Any

import robolink
from robolink import Node
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.counterparts.turtlesim.picture import BACKGROUND, Canvas, Colour
from robolink.counterparts.turtlesim.running_turtle import RunningTurtle
from robolink.counterparts.turtlesim.turtle import CENTRE, PERIOD, Turtle
from robolink.counterparts.turtlesim.window import draw_in_terminal, terminal_room, window
from robolink.exceptions import ExternalShutdownException
from robolink.image.png import png_of
from robolink.interfaces.rcl_interfaces.msg import ParameterEvent
from robolink.interfaces.sensor_msgs.msg import CompressedImage
from robolink.interfaces.std_srvs.srv import Empty
from robolink.interfaces.turtlesim.srv import Kill, Spawn
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data

PICTURE = "~/_picture"
"""Topic of the window's picture: hidden, since turtlesim has none. The page of `robolink view` shows it."""
PICTURE_EVERY = 2
"""Steps from one picture to the next: 31 pictures a second."""
MOST_TURTLES = 200
"""Turtles at once: each has twenty entities on the network."""


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
