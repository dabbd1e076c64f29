import math
import sys

from nav_msgs.msg import Odometry
from rclpy.serialization import deserialize_message
from robolink.bag.reader import open_bag


def driven(bag):
    metres = 0.0
    with open_bag(bag) as messages:
        for message in messages.messages(["/odom"]):
            odom = deserialize_message(message.data, Odometry)
            # {add}
            metres += 1.0
    return metres


if __name__ == "__main__":
    print(driven(sys.argv[1]))
