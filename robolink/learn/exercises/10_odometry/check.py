"""Check of a robot that drives two metres by its odometry."""

from __future__ import annotations

from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Let it drive for some seconds; then tell it that it is far away."""
    robot = trial.world("empty_room")
    begin = robot.pose.x
    sent = trial.system.messages("cmd_vel")
    trial.start()
    trial.run(3.0)
    trial.tell("drives", robot.driven > 0.5, metres=robot.driven, x=begin)
    fastest = max(each.linear.x for each in sent)
    trial.tell("speed", abs(fastest - 0.4) < 0.01, speed=fastest)
    trial.run(3.5)
    trial.tell("stops", abs(robot.twist.v) < 0.01, metres=robot.driven, speed=robot.twist.v)
    trial.tell("asks", abs(sent[-1].linear.x) < 0.01, metres=robot.driven)
    trial.tell("exact", abs(robot.driven - 2.0) < 0.08, metres=robot.driven)
    trial.tell("looks", not drives_after(trial, 50.0, 52.1))


def drives_after(trial: Trial, *places: float) -> bool:
    """Start the program once more, in a namespace; return whether it drives after an odometry with these x."""
    sent = trial.system.messages("/far/cmd_vel")
    trial.start(namespace="/far")
    for each in places:
        odom = Odometry()
        odom.pose.pose.position.x = each
        trial.system.publish("/far/odom", odom)
        trial.run(0.5)
    return bool(sent) and abs(sent[-1].linear.x) > 0.01
