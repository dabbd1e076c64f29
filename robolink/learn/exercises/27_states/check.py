"""Check of a state machine: its states, how long they take, and how the robot fares."""

from __future__ import annotations

from itertools import pairwise

from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_msgs.msg import String
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Let it drive for a minute in an empty room."""
    robot = trial.world("empty_room")
    trial.start()
    changes: list[tuple[float, str]] = []
    node = trial.system.node
    node.create_subscription(String, "state", lambda state: changes.append((trial.system.time, state.data)), 10)
    sent: list[tuple[float, Twist]] = []
    node.create_subscription(Twist, "cmd_vel", lambda twist: sent.append((trial.system.time, twist)), 10)
    trial.run(4.0)
    trial.tell("drives", robot.driven > 0.8, metres=robot.driven)
    trial.run(26.0)
    changes = changes[1:] if changes and changes[0][1] == "DRIVE" else changes  # some tell with what they begin
    states = [each for _, each in changes]
    trial.tell("once", all(one != other for one, other in pairwise(states)), states=", ".join(states[:5]))
    good = states[:3] == ["BACK", "TURN", "DRIVE"] and len(states) >= 4
    trial.tell("order", good, states=", ".join(["DRIVE", *states[:5]]))
    back, turn = (changes[number + 1][0] - changes[number][0] for number in (0, 1))
    trial.tell("times", abs(back - 1.0) < 0.15 and abs(turn - 1.5) < 0.15, back=back, turn=turn)
    for number, (name, x, z) in enumerate((("back", -0.2, 0.0), ("turn", 0.0, 0.8))):
        own = [each for at, each in sent if changes[number][0] + 0.15 < at < changes[number + 1][0] - 0.05]
        trial.tell("steady", len(own) >= 5, state=states[number], count=len(own))
        right = all(abs(each.linear.x - x) < 0.01 and abs(each.angular.z - z) < 0.01 for each in own)
        trial.tell(name, right, x=own[-1].linear.x, z=own[-1].angular.z)
    trial.run(30.0)
    trial.tell("free", robot.contacts == 0)
    trial.tell("roams", robot.driven > 6.0, metres=robot.driven)
