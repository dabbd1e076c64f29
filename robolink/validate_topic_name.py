"""Check of a topic or service name as a user writes it: relative, private ('~/x') or absolute."""

from __future__ import annotations

from typing import Literal

from robolink.exceptions import InvalidServiceNameException, InvalidTopicNameException
from robolink.text.names import TOPIC_NAME_RULES, find_problem

TOPIC_SEPARATOR_STRING = "/"


def validate_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Return True if `name` can be expanded. The expanded name may still be too long: see `validate_full_topic_name`.

    Raises InvalidTopicNameException with the index of the bad character (InvalidServiceNameException if
    `is_service`), and TypeError for what is not a str.
    """
    _check_is_text(name)
    problem = find_problem(name, TOPIC_NAME_RULES)
    if problem is None:
        return True
    raise (InvalidServiceNameException if is_service else InvalidTopicNameException)(name, *problem)


def _check_is_text(name: object) -> None:
    if not isinstance(name, str):
        hint = " (the type comes first)" if isinstance(name, type) else ""
        raise TypeError(f"the name must be a str, not {name!r}{hint}")
