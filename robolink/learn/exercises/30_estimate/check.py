"""Check of a node that tells where the robot is, with a listener that comes two seconds later."""

from __future__ import annotations

import math

from robolink.interfaces.geometry_msgs.msg import PoseWithCovarianceStamped
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Listen late, and look at what comes."""
    trial.start()
    trial.run(2.0)
    heard: list[PoseWithCovarianceStamped] = []
    trial.system.node.create_subscription(PoseWithCovarianceStamped, "initialpose", heard.append, 10)
    trial.run(1.5)
    trial.tell("comes", heard)
    frame, place = heard[0].header.frame_id, heard[0].pose.pose.position
    trial.tell("frame", frame == "map", frame=frame)
    trial.tell("place", math.dist((place.x, place.y), (2.0, 1.0)) < 0.01, x=place.x, y=place.y)
    turn, covariance = heard[0].pose.pose.orientation, heard[0].pose.covariance
    length = math.hypot(turn.x, turn.y, turn.z, turn.w)
    trial.tell("turn", abs(length - 1.0) < 0.01, length=length)
    degrees = math.degrees(2.0 * math.atan2(turn.z, turn.w))
    trial.tell("heading", abs(degrees - 90.0) < 1.0, degrees=degrees)
    found = {"x": covariance[0], "y": covariance[7], "angle": covariance[35]}
    right = {"x": 0.25, "y": 0.25, "angle": 0.07}
    trial.tell("sure", all(abs(found[each] - right[each]) < 0.005 for each in right), **found)
    trial.run(2.0)
    trial.tell("once", len(heard) == 1, count=len(heard))
