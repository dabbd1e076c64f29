"""Check of the mini project: two minutes along the walls of the classroom."""

from __future__ import annotations

from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Let it drive for two minutes."""
    robot = trial.world("classroom")
    right: list[float] = []
    node = trial.system.node
    node.create_subscription(LaserScan, "scan", lambda scan: right.append(min(scan.ranges[0:60])), 10)
    sent = trial.system.messages("cmd_vel")
    trial.start()
    trial.run(5.0)
    trial.tell("drives", robot.driven > 0.8, metres=robot.driven)
    trial.run(115.0)
    fastest = max(abs(each.linear.x) for each in sent)
    trial.tell("speed", fastest < 0.35, speed=fastest)
    turn = max((abs(each.angular.z) for each in sent if abs(each.linear.x) < 0.01), default=0.0)
    trial.tell("turn", turn < 1.0, turn=turn)
    trial.tell("free", robot.contacts == 0, metres=robot.driven)
    area = robot.area
    trial.tell("round", area.width > 4.5 and area.height > 3.5, width=area.width, height=area.height)
    metres = sum(right[50:]) / len(right[50:])
    trial.tell("near", 0.35 < metres < 0.75, metres=metres)
