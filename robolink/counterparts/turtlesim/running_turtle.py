"""One turtle of turtlesim on the network: its topics, its services and its action."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from robolink.counterparts.turtlesim.picture import Drawn
from robolink.counterparts.turtlesim.turtle import SIZE, Pen, Rotation
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.turtlesim.msg import Color, Pose
from robolink.interfaces.turtlesim.srv import SetPen, TeleportAbsolute, TeleportRelative

if TYPE_CHECKING:
    from collections.abc import Callable

    from robolink.counterparts.turtlesim.picture import Canvas
    from robolink.counterparts.turtlesim.turtle import Turtle
    from robolink.node import Node

DEPTH = 7
"""Depth of the topics' queues, as turtlesim has it."""


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
        self._rotation.cancel_if_asked()
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
