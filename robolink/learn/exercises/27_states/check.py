"""Check of a state machine: its states, how long they take, and how the robot fares."""

from __future__ import annotations

from robolink.interfaces.std_msgs.msg import String
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Let it drive for a minute in an empty room."""
    robot = trial.world("empty_room")
    trial.start()
    changes: list[tuple[float, str]] = []
    node = trial.system.node
    node.create_subscription(String, "state", lambda state: changes.append((trial.system.time, state.data)), 10)
    trial.run(4.0)
    trial.tell("drives", robot.driven > 0.8, metres=robot.driven)
    trial.run(26.0)
    states = [each for _, each in changes]
    good = states[:3] == ["BACK", "TURN", "DRIVE"] and len(states) >= 4
    trial.tell("order", good, states=", ".join(["DRIVE", *states[:5]]))
    back, turn = (changes[number + 1][0] - changes[number][0] for number in (0, 1))
    trial.tell("times", abs(back - 1.0) < 0.15 and abs(turn - 1.5) < 0.15, back=back, turn=turn)
    trial.run(30.0)
    trial.tell("free", robot.contacts == 0)
    trial.tell("roams", robot.driven > 6.0, metres=robot.driven)
