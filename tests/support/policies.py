"""Restart policies for tests: two processes, and histories of events for the state machine."""

from __future__ import annotations

from robolink.supervisor.policy import Action, Policy, Rules

PLAIN = Rules()


def two(first: Rules = PLAIN, second: Rules = PLAIN, *, ends: float | None = None) -> Policy:
    """A policy for two processes, a and b, begun at 0."""
    policy = Policy({"a": first, "b": second}, ends=ends)
    policy.begin(0.0)
    return policy


def tell(policy: Policy, now: float, event: object) -> list[Action]:
    """Report an event: (name, code or 'restart', 'stop', 'release'), 'interrupt', 'end' or time."""
    if isinstance(event, tuple):
        name, what = event
        if isinstance(what, int):
            return policy.exited(name, what, now)
        return {"restart": policy.restart, "stop": policy.stop_one, "release": policy.released}[what](name, now)
    if event is None:
        return policy.woken(now)
    return policy.interrupted(now, in_hurry=event == "interrupt")


def replay(policy: Policy, history: list[tuple[float, object]]) -> list[list[Action]]:
    return [tell(policy, now, event) for now, event in history]
