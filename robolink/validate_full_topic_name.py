"""Check of a topic or service name after it was expanded and remapped."""

from __future__ import annotations

from typing import Literal

from robolink.exceptions import InvalidServiceNameException, InvalidTopicNameException
from robolink.text.names import FULL_NAME_RULES, MAX_TOPIC_NAME, find_problem


def validate_full_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Return True if `name` is a fully qualified name such as '/arm/joint_states'.

    Raises InvalidTopicNameException with the index of the bad character; InvalidServiceNameException if `is_service`.
    """
    problem = find_problem(name, FULL_NAME_RULES, MAX_TOPIC_NAME)
    if problem is None:
        return True
    raise (InvalidServiceNameException if is_service else InvalidTopicNameException)(name, *problem)
