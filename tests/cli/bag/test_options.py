"""Values of flags that the verbs of `robolink bag` share."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.bag.selection import EVERYTHING, Selection
from robolink.cli.bag.options import selection_of

NOTHING: dict[str, Any] = {"topics": None, "topic_types": None, "regex": "", "exclude_regex": ""}


@pytest.mark.parametrize(
    ("given", "selection"),
    [
        ({}, EVERYTHING),
        ({"exclude_topics": ["scan"]}, EVERYTHING._replace(exclude_topics=("/scan",))),
        ({"exclude_regex": "^/a"}, EVERYTHING._replace(exclude_regex="^/a")),
        ({"topics": ["scan", "/odom"]}, Selection(topics=("/scan", "/odom"), include_hidden=True)),
        (
            {"topic_types": ["std_msgs/msg/String"]},
            Selection(topic_types=("std_msgs/msg/String",), include_hidden=True),
        ),
        ({"actions": ["go"], "regex": "x"}, Selection(actions=("/go",), regex="x", include_hidden=True)),
    ],
)
def test_a_selection_is_everything_unless_something_is_named(given: dict[str, Any], selection: Selection) -> None:
    assert selection_of(NOTHING | given) == selection
