"""tf2: a pond with a turtle in it, as turtlesim has one; more of them come when asked for."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.msg import Pose
from turtlesim.srv import Spawn

STEP = 0.02  # s


class Swimmer:
    def __init__(self, pond, name, pose):
        self.pose = pose
        self.seen = pond.create_publisher(Pose, f'{name}/pose', 10)
        pond.create_subscription(Twist, f'{name}/cmd_vel', self.steer, 10)

    def steer(self, twist):
        self.pose.linear_velocity, self.pose.angular_velocity = twist.linear.x, twist.angular.z

    def swim(self):
        at, way = self.pose, self.pose.linear_velocity * STEP
        at.theta += at.angular_velocity * STEP
        at.x, at.y = at.x + way * math.cos(at.theta), at.y + way * math.sin(at.theta)
        self.seen.publish(at)


class Pond(Node):
    def __init__(self):
        super().__init__('pond')
        self.swimmers = [Swimmer(self, 'turtle1', Pose(x=5.5, y=5.5))]
        self.create_service(Spawn, 'spawn', self.let_in)
        self.create_timer(STEP, self.pass_time)

    def let_in(self, wish, answer):
        self.swimmers.append(Swimmer(self, wish.name, Pose(x=wish.x, y=wish.y, theta=wish.theta)))
        answer.name = wish.name
        return answer

    def pass_time(self):
        for each in self.swimmers:
            each.swim()
        places = [(each.pose.x, each.pose.y) for each in self.swimmers]
        if len(places) == 2 and math.dist(*places) < 0.8:
            self.get_logger().info('the turtles meet', once=True)


def main():
    try:
        with rclpy.init():
            rclpy.spin(Pond())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
