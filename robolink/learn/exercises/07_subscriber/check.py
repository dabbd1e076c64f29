"""Check of a subscription: its answers to two scans."""

from __future__ import annotations

from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Send scans, and compare what is said."""
    trial.start()
    trial.run(0.5)
    said = answer(trial, [2.0, 0.8, 3.0])
    trial.tell("hears", said is not None)
    trial.tell("least", abs(said - 0.8) < 1e-3, said=said)
    said = answer(trial, [1.5, 0.0, 2.5])
    trial.tell("zeros", said is not None and abs(said - 1.5) < 1e-3, said=said or 0.0)


def answer(trial: Trial, ranges: list[float]) -> float | None:
    """Send a scan; return what comes on nearest."""
    trial.system.publish("scan", LaserScan(ranges=ranges, range_max=10.0))
    heard = trial.heard("nearest", within=1.0)
    return None if heard is None else float(heard.data)
