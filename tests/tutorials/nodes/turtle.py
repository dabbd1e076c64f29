"""Stands for turtlesim: turtles that move as they are told, and more of them when asked."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.msg import Pose
from turtlesim.srv import Spawn

PERIOD = 0.02


class Turtle:
    def __init__(self, node, name, x=5.5, y=5.5, theta=0.0):
        self.pose = Pose(x=x, y=y, theta=theta)
        self.publisher = node.create_publisher(Pose, f'{name}/pose', 10)
        self.subscription = node.create_subscription(Twist, f'{name}/cmd_vel', self.on_cmd_vel, 10)

    def on_cmd_vel(self, msg):
        self.pose.linear_velocity = msg.linear.x
        self.pose.angular_velocity = msg.angular.z

    def move(self):
        self.pose.theta += self.pose.angular_velocity * PERIOD
        self.pose.x += self.pose.linear_velocity * math.cos(self.pose.theta) * PERIOD
        self.pose.y += self.pose.linear_velocity * math.sin(self.pose.theta) * PERIOD
        self.publisher.publish(self.pose)


class Turtles(Node):
    def __init__(self):
        super().__init__('turtlesim')
        self.turtles = [Turtle(self, 'turtle1')]
        self.create_service(Spawn, 'spawn', self.on_spawn)
        self.create_timer(PERIOD, self.on_timer)

    def on_spawn(self, request, response):
        self.turtles.append(Turtle(self, request.name, request.x, request.y, request.theta))
        response.name = request.name
        return response

    def on_timer(self):
        for each in self.turtles:
            each.move()
        if len(self.turtles) > 1:
            away = math.dist(
                (self.turtles[0].pose.x, self.turtles[0].pose.y), (self.turtles[1].pose.x, self.turtles[1].pose.y)
            )
            if away < 0.5:
                self.get_logger().info('the second turtle has reached the first', once=True)


def main():
    try:
        with rclpy.init():
            rclpy.spin(Turtles())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
