"""Check of an action server: result, status and feedback of one goal."""

from __future__ import annotations

from typing import Any

from robolink.action import ActionClient
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.learn.trial import Trial
from robolink.testing.expectations import ExpectationError, NodeFailure


def check(trial: Trial) -> None:
    """Send a goal."""
    trial.start()
    client = ActionClient(trial.system.node, Fibonacci, "fibonacci")
    told: list[Any] = []
    trial.run(0.5)
    future = client.send_goal_async(Fibonacci.Goal(order=5), feedback_callback=told.append)
    try:
        handle = trial.system.result(future, 3.0)
    except NodeFailure:
        raise
    except ExpectationError:
        handle = None
    trial.tell("accepted", handle is not None and handle.accepted)
    answer = trial.system.result(handle.get_result_async(), 10.0)
    numbers = list(answer.result.sequence)
    trial.tell("returns", numbers)
    trial.tell("result", numbers == [0, 1, 1, 2, 3, 5], numbers=", ".join(map(str, numbers)))
    trial.tell("succeeds", answer.status == GoalStatus.STATUS_SUCCEEDED)
    trial.tell("feedback", len(told) == 4, count=len(told))
    parts = [list(each.feedback.sequence) for each in told]
    shown = ", ".join(map(str, parts[0])) or "-"
    trial.tell("grows", parts == [numbers[: 3 + each] for each in range(4)], numbers=shown)
