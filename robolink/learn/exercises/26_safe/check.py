"""Check of a node that stops when its scans stop coming."""

from __future__ import annotations

from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Send scans for two seconds, none for two, and then some again."""
    trial.start()
    sent = trial.system.messages("cmd_vel")
    scans(trial, 20)
    speeds = [each.linear.x for each in sent]
    trial.tell("publishes", speeds)
    trial.tell("drives", any(each > 0.2 for each in speeds), speed=speeds[-1])
    trial.tell("steady", all(each > 0.2 for each in speeds[-15:]))
    begin = trial.system.time
    stop = trial.heard("cmd_vel", lambda twist: twist.linear.x == 0.0, 2.0)
    trial.tell("stops", stop is not None, speed=sent[-1].linear.x)
    seconds = trial.system.time - begin
    trial.tell("soon", seconds < 1.0, seconds=seconds)
    scans(trial, 5)
    trial.tell("again", sent[-1].linear.x > 0.2)


def scans(trial: Trial, count: int) -> None:
    """Send scans of a free way, ten a second."""
    for _ in range(count):
        trial.system.publish("scan", LaserScan(ranges=[3.0, 3.0, 3.0]))
        trial.run(0.1)
