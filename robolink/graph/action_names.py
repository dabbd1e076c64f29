"""Names of actions. The wire has none: an action is five topics and services whose names belong together."""

from __future__ import annotations

from collections.abc import Iterable

from robolink.graph.graph import NamesAndTypes

MARK = "/_action/"
"""Text between the name of an action and that of each of its parts."""
SEND_GOAL, CANCEL_GOAL, GET_RESULT = "send_goal", "cancel_goal", "get_result"
FEEDBACK, STATUS = "feedback", "status"
SERVICES = {SEND_GOAL, CANCEL_GOAL, GET_RESULT}
TOPICS = {FEEDBACK, STATUS}
FEEDBACK_TYPE, GOAL_TYPE = "_FeedbackMessage", "_SendGoal"
"""Suffixes of the type of a part, behind the type of the action."""


def part_name(action: str, part: str) -> str:
    """Return the name of a part.

    >>> part_name("/fibonacci", "feedback")
    '/fibonacci/_action/feedback'
    """
    return f"{action}{MARK}{part}"


def actions(services: NamesAndTypes, topics: NamesAndTypes) -> NamesAndTypes:
    """Return the actions of which all five parts exist, each with its types such as ``pkg/action/Fibonacci``."""
    requested, reported = _parts(services), _parts(topics)
    found = []
    for name in sorted(requested.keys() & reported.keys()):
        # All five: who merely echoes the feedback is not a client, though rcl takes it for one.
        if requested[name].keys() >= SERVICES and reported[name].keys() >= TOPICS:
            types = sorted(each for each in reported[name][FEEDBACK] if each.endswith(FEEDBACK_TYPE))
            found.append((name, [each.removesuffix(FEEDBACK_TYPE) for each in types]))
    return found


def _parts(named: Iterable[tuple[str, list[str]]]) -> dict[str, dict[str, list[str]]]:
    """Group topics or services by action and part; return the types of each part."""
    found: dict[str, dict[str, list[str]]] = {}
    for name, types in named:
        action, mark, part = name.rpartition(MARK)
        if mark:
            found.setdefault(action, {})[part] = types
    return found
