"""Counterparts of turtle_tf2_py: a frame of a turtle, and a turtle that follows a frame."""

from __future__ import annotations

import math
from typing import Any

from robolink import Node
from robolink.interfaces.geometry_msgs.msg import TransformStamped, Twist
from robolink.interfaces.turtlesim.msg import Pose
from robolink.interfaces.turtlesim.srv import Spawn
from robolink.task import Future
from robolink.tf2 import Buffer, TransformBroadcaster, TransformException, TransformListener
from robolink.time import Time

WORLD = "world"
"""Frame of the window."""


class FramePublisher(Node):
    """A node that makes a frame of a turtle."""

    def __init__(self, **options: Any) -> None:
        super().__init__("turtle_tf2_frame_publisher", **options)
        self.turtle: str = self.declare_parameter("turtlename", "turtle").value
        self.broadcaster = TransformBroadcaster(self)
        self.create_subscription(Pose, f"/{self.turtle}/pose", self.on_pose, 1)

    def on_pose(self, pose: Pose) -> None:
        """Publish the transform of a pose, unless it is not finite."""
        if not all(map(math.isfinite, (pose.x, pose.y, pose.theta))):
            self.get_logger().warning("ignored a pose that is not finite", once=True)
            return
        transform = TransformStamped(child_frame_id=self.turtle)
        transform.header.frame_id, transform.header.stamp = WORLD, self.get_clock().now().to_msg()
        moved, turned = transform.transform.translation, transform.transform.rotation
        moved.x, moved.y = pose.x, pose.y
        turned.z, turned.w = math.sin(pose.theta / 2), math.cos(pose.theta / 2)
        self.broadcaster.sendTransform(transform)


TURTLE = "turtle2"
"""Name and frame of the turtle that follows."""
PERIOD = 1.0
"""Seconds between two commands."""
TURN, SPEED = 1.0, 0.5
"""rad/s for each radian to turn, and m/s for each metre to swim."""


class FrameListener(Node):
    """A node that has a second turtle follow a frame."""

    def __init__(self, **options: Any) -> None:
        super().__init__("turtle_tf2_frame_listener", **options)
        self.target: str = self.declare_parameter("target_frame", "turtle1").value
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.spawner = self.create_client(Spawn, "spawn")
        self.spawned: Future[Any] | None = None
        self.is_there = False
        self.cmd_vel = self.create_publisher(Twist, f"{TURTLE}/cmd_vel", 1)
        self.create_timer(PERIOD, self.on_timer)

    def on_timer(self) -> None:
        """Take the next step: have the turtle spawned, or drive it."""
        if self.is_there:
            self.follow()
        elif self.spawned is None:
            self.spawn()
        elif self.spawned.done():
            answer: Any = self.spawned.result()
            self.get_logger().info(f"Successfully spawned {answer.name}")
            self.is_there = True
        else:
            self.get_logger().info("Spawn is not finished")

    def spawn(self) -> None:
        """Ask turtlesim for the turtle, once it is there."""
        if self.spawner.service_is_ready():
            self.spawned = self.spawner.call_async(Spawn.Request(name=TURTLE, x=4.0, y=2.0))
        else:
            self.get_logger().info("Service is not ready")

    def follow(self) -> None:
        """Command the turtle to the target; wait where there is no transform yet."""
        try:
            way = self.buffer.lookup_transform(TURTLE, self.target, Time()).transform.translation
        except TransformException as error:
            self.get_logger().info(f"Could not transform {TURTLE} to {self.target}: {error}")
            return
        twist = Twist()
        twist.linear.x, twist.angular.z = SPEED * math.hypot(way.x, way.y), TURN * math.atan2(way.y, way.x)
        self.cmd_vel.publish(twist)
