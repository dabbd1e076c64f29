"""An action server that commands see, for tests of commands."""

from __future__ import annotations

import threading

from robolink.action import CancelResponse, GoalResponse
from robolink.action.server import ServerGoalHandle
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.message import Action, Message, float64, type_name

TYPE = "example_interfaces/action/Fibonacci"


class Polish(Action):
    """An action that is not installed."""

    class Goal(Message):
        pressure: float64

    class Result(Message):
        shine: float64

    class Feedback(Message):
        shine: float64


POLISH = type_name(Polish)


class Sums:
    """Action server of /lab/sums: for an order below 0 it goes on until it is cancelled."""

    def __init__(self) -> None:
        self.canceled = threading.Event()
        self.cancel_response = CancelResponse.ACCEPT

    def __call__(self, handle: ServerGoalHandle) -> Fibonacci.Result:
        handle.publish_feedback(Fibonacci.Feedback(sequence=[0, 1]))
        if handle.request.order == 0:
            handle.abort()
            return Fibonacci.Result()
        if handle.request.order < 0:
            while not handle.is_cancel_requested:
                assert not self.canceled.wait(0.005)
            handle.canceled()
            self.canceled.set()
            return Fibonacci.Result()
        handle.succeed()
        return Fibonacci.Result(sequence=[0, 1, 1, 2])

    def accept(self, asked: Fibonacci.Goal) -> GoalResponse:
        return GoalResponse.ACCEPT if asked.order < 10 else GoalResponse.REJECT

    def cancel(self, handle: ServerGoalHandle) -> CancelResponse:
        return self.cancel_response
