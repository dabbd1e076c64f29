"""Node of the fuzz: message_filters and cv_bridge, as programs with two cameras use them."""

import robolink
from robolink import Node
from robolink.companions import message_filters
from robolink.companions.cv_bridge import CvBridge, CvBridgeError
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan


class Synchronized(Node):
    """A node that hears pairs and single messages through each kind of filter."""

    def __init__(self) -> None:
        super().__init__("synchronized")
        self.bridge = CvBridge()
        left = message_filters.Subscriber(self, Image, "left/image_raw")
        right = message_filters.Subscriber(self, Image, "right/image_raw")
        scan = message_filters.Subscriber(self, LaserScan, "scan")
        self.exact = message_filters.TimeSynchronizer([left, right], 10)
        self.near = message_filters.ApproximateTimeSynchronizer([left, scan], 10, 0.1, allow_headerless=True)
        self.cache = message_filters.Cache(scan, 5)
        self.exact.registerCallback(self.on_pair)
        self.near.registerCallback(self.on_any)
        left.registerCallback(self.on_any)

    def on_any(self, image: Image, scan: LaserScan | None = None) -> None:
        """Convert an image."""
        try:
            self.bridge.imgmsg_to_cv2(image, "bgr8")
        except CvBridgeError as error:
            self.get_logger().warning(str(error), throttle_duration_sec=1.0)

    def on_pair(self, left: Image, right: Image) -> None:
        """Convert both."""
        self.on_any(left)
        self.on_any(right)


robolink.init()
robolink.spin(Synchronized())
