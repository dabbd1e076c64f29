import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.timer = self.create_timer(1.0, self.talk)
        self.count = 0

    def talk(self):
        self.count += 1
        self.publisher.publish(String(data=f"hello {self.count}"))


class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        self.create_subscription(String, "chater", self.on_chatter, 10)

    def on_chatter(self, message):
        self.get_logger().info(f"heard {message.data}")


def main():
    rclpy.init()
    # {both}
    rclpy.spin(Talker())


if __name__ == "__main__":
    main()
