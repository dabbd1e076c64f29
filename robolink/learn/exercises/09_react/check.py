"""Check of reactive control: its answers to two scans, then a minute in the classroom."""

from __future__ import annotations

from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Send scans, then let it drive, and look for contacts."""
    trial.start()
    trial.run(0.3)  # before the first scan
    speed, turn = answer(trial, 3.0)
    trial.tell("drives", abs(speed - 0.3) < 0.01, speed=speed)
    trial.tell("straight", abs(turn) < 0.01, turn=turn)
    speed, turn = answer(trial, 0.8)
    trial.tell("stands", abs(speed) < 0.01, speed=speed)
    trial.tell("turns", abs(turn - 0.5) < 0.01, turn=turn)
    robot = trial.world("classroom")
    trial.run(60.0)
    trial.tell("free", robot.contacts == 0, metres=robot.driven)
    trial.tell("roams", robot.driven > 6.0, metres=robot.driven)


def answer(trial: Trial, ahead: float) -> tuple[float, float]:
    """Send a scan in which all is so many metres away; return the last command after it, zeros if there is none."""
    sent = trial.system.messages("cmd_vel")
    trial.system.publish("scan", LaserScan(range_min=0.1, range_max=10.0, ranges=[ahead] * 181))
    trial.run(0.5)
    return (sent[-1].linear.x, sent[-1].angular.z) if sent else (0.0, 0.0)
