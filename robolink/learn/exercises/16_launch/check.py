"""Check of a launch file."""

from __future__ import annotations

from pathlib import Path

from robolink.exceptions import NotFoundError
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Launch it, and look at its robot."""
    trial.system.launch(trial.file)
    trial.run(1.0)
    try:
        robot = trial.system.robot()
    except NotFoundError:
        robot = None
    trial.tell("world", robot is not None)
    world = Path(str(trial.system.parameter("/world", "world"))).stem
    trial.tell("right_world", world == "obstacles", world=world)
    nodes = trial.system.nodes
    trial.tell("node", "/reactive_controller" in nodes, nodes=", ".join(each.strip("/") for each in nodes))
    speed = trial.system.parameter("/reactive_controller", "speed")
    trial.tell("speed", speed == 0.2, speed=speed)
    trial.run(10.0)
    good = robot.driven > 1.0 and robot.contacts == 0
    trial.tell("drives", good, metres=robot.driven, contacts=robot.contacts)
