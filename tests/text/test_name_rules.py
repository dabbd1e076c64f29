"""Names that are known to be right without a pattern are those that no rule's pattern finds."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.text.names import FULL_NAME_RULES, NODE_NAME_RULES, TOPIC_NAME_RULES, Rule, find_problem

NAMES = st.text("ab_/~{}1é\n A", max_size=7)


@pytest.mark.parametrize("rules", [FULL_NAME_RULES, NODE_NAME_RULES, TOPIC_NAME_RULES])
@given(name=NAMES)
def test_a_name_has_a_problem_if_a_pattern_finds_one(rules: Sequence[Rule], name: str) -> None:
    found = [rule.message for rule in rules if rule.pattern.search(name)]
    problem = find_problem(name, rules)
    assert (problem.message if problem else None) == (found[0] if found else None)
