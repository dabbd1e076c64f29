"""State machine of a managed node, as ROS 2's design of managed nodes has it.

https://design.ros2.org/articles/node_lifecycle.html; the numbers are those of lifecycle_msgs.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from enum import IntEnum
from typing import TYPE_CHECKING, NamedTuple

from robolink.exceptions import RobolinkError
from robolink.interfaces.lifecycle_msgs.msg import State, Transition

if TYPE_CHECKING:
    from robolink.service import Service

STATES = {
    State.PRIMARY_STATE_UNKNOWN: "unknown",
    State.PRIMARY_STATE_UNCONFIGURED: "unconfigured",
    State.PRIMARY_STATE_INACTIVE: "inactive",
    State.PRIMARY_STATE_ACTIVE: "active",
    State.PRIMARY_STATE_FINALIZED: "finalized",
    State.TRANSITION_STATE_CONFIGURING: "configuring",
    State.TRANSITION_STATE_CLEANINGUP: "cleaningup",
    State.TRANSITION_STATE_SHUTTINGDOWN: "shuttingdown",
    State.TRANSITION_STATE_ACTIVATING: "activating",
    State.TRANSITION_STATE_DEACTIVATING: "deactivating",
    State.TRANSITION_STATE_ERRORPROCESSING: "errorprocessing",
}
"""Names of all states, by number."""


class TransitionCallbackReturn(IntEnum):
    """Result of a transition's callback; the numbers are those of lifecycle_msgs."""

    SUCCESS = Transition.TRANSITION_CALLBACK_SUCCESS
    FAILURE = Transition.TRANSITION_CALLBACK_FAILURE
    ERROR = Transition.TRANSITION_CALLBACK_ERROR

    def to_label(self) -> str:
        """Return the name of the transition that follows, such as ``transition_success``."""
        return f"transition_{self.name.lower()}"


class LifecycleState(NamedTuple):
    """A state, as callbacks of transitions get it."""

    label: str
    state_id: int


class Step(NamedTuple):
    """A transition: its number, its name, and the states that it leads from and to."""

    id: int
    label: str
    start_id: int
    start_label: str
    goal_id: int
    goal_label: str


def _step(id_: int, label: str, start: int, goal: int) -> Step:
    return Step(id_, label, start, STATES[start], goal, STATES[goal])


def _ends(first: int, passing: int, success: int, failure: int) -> list[Step]:
    """Return the three ways in which a transition state can end; an error in an error is the end."""
    error = State.TRANSITION_STATE_ERRORPROCESSING if passing != State.TRANSITION_STATE_ERRORPROCESSING else failure
    goals = zip(TransitionCallbackReturn, (success, failure, error), strict=True)
    return [_step(first + at, how.to_label(), passing, goal) for at, (how, goal) in enumerate(goals)]


def _round(id_: int, label: str, ends: int, way: tuple[int, int, int]) -> list[Step]:
    """Return a transition between two primary states by way of a third, with its ends; a failure leads back."""
    start, passing, goal = way
    return [_step(id_, label, start, passing), *_ends(ends, passing, goal, start)]


def _all_steps() -> tuple[Step, ...]:
    unconfigured, inactive = State.PRIMARY_STATE_UNCONFIGURED, State.PRIMARY_STATE_INACTIVE
    active, finalized = State.PRIMARY_STATE_ACTIVE, State.PRIMARY_STATE_FINALIZED
    shuttingdown = State.TRANSITION_STATE_SHUTTINGDOWN
    rounds = [
        (Transition.TRANSITION_CONFIGURE, "configure", Transition.TRANSITION_ON_CONFIGURE_SUCCESS),
        (Transition.TRANSITION_CLEANUP, "cleanup", Transition.TRANSITION_ON_CLEANUP_SUCCESS),
        (Transition.TRANSITION_ACTIVATE, "activate", Transition.TRANSITION_ON_ACTIVATE_SUCCESS),
        (Transition.TRANSITION_DEACTIVATE, "deactivate", Transition.TRANSITION_ON_DEACTIVATE_SUCCESS),
    ]
    ways = [
        (unconfigured, State.TRANSITION_STATE_CONFIGURING, inactive),
        (inactive, State.TRANSITION_STATE_CLEANINGUP, unconfigured),
        (inactive, State.TRANSITION_STATE_ACTIVATING, active),
        (active, State.TRANSITION_STATE_DEACTIVATING, inactive),
    ]
    steps = [step for each, way in zip(rounds, ways, strict=True) for step in _round(*each, way)]
    shutdowns = {
        Transition.TRANSITION_UNCONFIGURED_SHUTDOWN: unconfigured,
        Transition.TRANSITION_INACTIVE_SHUTDOWN: inactive,
        Transition.TRANSITION_ACTIVE_SHUTDOWN: active,
    }
    steps += [_step(id_, "shutdown", start, shuttingdown) for id_, start in shutdowns.items()]
    steps += _ends(Transition.TRANSITION_ON_SHUTDOWN_SUCCESS, shuttingdown, finalized, finalized)
    errors = State.TRANSITION_STATE_ERRORPROCESSING
    return (*steps, *_ends(Transition.TRANSITION_ON_ERROR_SUCCESS, errors, unconfigured, finalized))


STEPS = _all_steps()
"""All transitions, in the order in which ROS 2 lists them."""


class TransitionError(RobolinkError, RuntimeError):
    """A transition was asked for that the current state does not have."""


class LifecycleStateMachine:
    """State machine of a node: it calls `on_step` with each transition. Usable from any thread."""

    initialized = True
    available_states = list(STATES.items())
    """All states: number and name."""
    transition_graph = list(STEPS)
    service_change_state: Service | None = None
    """First of the five services by which others drive it; None without a communication interface."""
    service_get_state: Service | None = None
    service_get_available_states: Service | None = None
    service_get_available_transitions: Service | None = None
    service_get_transition_graph: Service | None = None

    def __init__(self) -> None:
        self._state = State.PRIMARY_STATE_UNCONFIGURED
        self.on_step: Callable[[Step], object] = lambda step: None
        self._lock = threading.Lock()

    @property
    def current_state(self) -> tuple[int, str]:
        """Number and name of the state."""
        return self._state, STATES[self._state]

    @property
    def available_transitions(self) -> list[Step]:
        """Transitions that lead from the current state."""
        return [step for step in STEPS if step.start_id == self._state]

    def get_transition_by_label(self, label: str) -> int:
        """Return the number of a transition from the current state. Raises TransitionError if there is none."""
        return self._find(label, "label").id

    def trigger_transition_by_id(self, transition_id: int, publish: bool = True) -> None:
        """Make the transition `transition_id`; call `on_step` if `publish`. Raises TransitionError if there is none."""
        self._make(transition_id, "id", publish)

    def trigger_transition_by_label(self, label: str, publish: bool = True) -> None:
        """Make a transition (`label`), and call `on_step` if `publish`. Raises TransitionError if there is none."""
        self._make(label, "label", publish)

    def _make(self, expected: int | str, field: str, publish: bool) -> None:
        with self._lock:
            step = self._find(expected, field)
            self._state = step.goal_id
        if publish:
            self.on_step(step)

    def _find(self, expected: int | str, field: str) -> Step:
        steps = self.available_transitions
        for step in steps:
            if getattr(step, field) == expected:
                return step
        there = ", ".join(f"{each.label} [{each.id}]" for each in steps) or "none"
        raise TransitionError(f"no transition '{expected}' from {STATES[self._state]}: there is {there}")
