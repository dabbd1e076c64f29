import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String


class StateMachine(Node):
    def __init__(self):
        super().__init__("state_machine")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.state_publisher = self.create_publisher(String, "state", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)
        self.timer = self.create_timer(0.1, self.tick)
        self.ahead = 0.6
        self.state = "DRIVE"
        self.since = self.get_clock().now()

    def on_scan(self, scan):
        middle = len(scan.ranges) // 2
        self.ahead = min(scan.ranges[middle - 40 : middle + 40])

    def change(self, state):
        self.state = state
        self.since = self.get_clock().now()
        self.state_publisher.publish(String(data=state))

    def seconds(self):
        return (self.get_clock().now() - self.since).nanoseconds / 1e9

    def tick(self):
        # {change}
        if self.state == "DRIVE" and self.ahead < 0.6:
            self.change("BACK")
        twist = Twist()
        # {command}
        if self.state == "DRIVE":
            twist.linear.x = 0.3
        self.publisher.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(StateMachine())


if __name__ == "__main__":
    main()
