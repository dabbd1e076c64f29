"""Events of a launch (`launch.events`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.launch.ros.launch import process_events as process
from robolink.launch.ros.launch.bases import Action, Event

__all__ = [
    "ExecutionComplete",
    "IncludeLaunchDescription",
    "Shutdown",
    "TimerEvent",
    "matches_action",
    "process",
]


class Shutdown(Event):
    """The launch is to end.

    Args:
        reason: Reason for people.
        due_to_sigint: True where somebody pressed Ctrl-C.
    """

    name = "launch.events.Shutdown"

    def __init__(self, *, reason: str = "reason not given", due_to_sigint: bool = False) -> None:
        self.reason, self.due_to_sigint = reason, due_to_sigint


class ExecutionComplete(Event):
    """An action is done.

    Args:
        action: The action.
    """

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Action) -> None:
        self.action = action


class TimerEvent(Event):
    """The time of a timer has come.

    Args:
        timer_action: The timer.
    """

    name = "launch.events.TimerEvent"

    def __init__(self, *, timer_action: Action) -> None:
        self.timer_action = timer_action


class IncludeLaunchDescription(Event):
    """A launch description is to be carried out.

    Args:
        launch_description: The description.
    """

    name = "launch.events.IncludeLaunchDescription"

    def __init__(self, launch_description: Any) -> None:
        self.launch_description = launch_description


def matches_action(target_action: Action) -> Callable[[Action], bool]:
    """Return a function that is true for `target_action` alone."""
    return lambda action: action is target_action
