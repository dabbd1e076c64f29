import math
import sys

from nav_msgs.msg import Odometry
from rclpy.serialization import deserialize_message
from robolink.bag.reader import open_bag


def driven(bag):
    metres, last = 0.0, None
    with open_bag(bag) as messages:
        for message in messages.messages(["/odom"]):
            odom = deserialize_message(message.data, Odometry)
            place = (odom.pose.pose.position.x, odom.pose.pose.position.y)
            metres += math.dist(last or place, place)
            last = place
    return metres


if __name__ == "__main__":
    print(driven(sys.argv[1]))
