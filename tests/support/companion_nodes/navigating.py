"""Program of the fuzz: nav2_simple_commander's BasicNavigator, and a transform listener that looks up all it hears."""

import robolink
from robolink.companions.nav2_simple_commander.robot_navigator import BasicNavigator
from robolink.interfaces.geometry_msgs.msg import PointStamped, PoseStamped
from robolink.tf2 import Buffer, TransformException, TransformListener
from robolink.tf2.geometry import do_transform_point  # noqa: F401 - it registers its types
from robolink.time import Time


class Navigating(BasicNavigator):
    """A navigator that brings points that it hears into its map."""

    def __init__(self) -> None:
        super().__init__()
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.create_subscription(PointStamped, "clicked_point", self.on_point, 10)

    def on_point(self, point: PointStamped) -> None:
        """Bring a point into the map."""
        self.buffer.all_frames_as_yaml()
        try:
            self.buffer.transform(point, "map")
            self.buffer.lookup_transform("map", point.header.frame_id, Time())
        except TransformException:
            pass


robolink.init()
navigator = Navigating()
while True:
    if navigator.goToPose(PoseStamped()):
        while not navigator.isTaskComplete():
            navigator.getFeedback()
    navigator.getResult()
    robolink.spin_once(navigator, timeout_sec=0.1)
