import numpy as np
import rclpy
from cv_bridge import CvBridge
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import Float32


class YellowFinder(Node):
    def __init__(self):
        super().__init__("yellow_finder")
        self.bridge = CvBridge()
        self.publisher = self.create_publisher(Float32, "direction", 10)
        self.create_subscription(Image, "camera/image_raw", self.on_image, 10)

    def on_image(self, message):
        image = self.bridge.imgmsg_to_cv2(message, "bgr8")
        # {mask}
        yellow = image[:, :, 2] > 120
        rows, columns = np.nonzero(yellow)
        # {where}
        direction = columns.mean()
        self.publisher.publish(Float32(data=float(direction)))


def main():
    rclpy.init()
    rclpy.spin(YellowFinder())


if __name__ == "__main__":
    main()
