"""No shipped program ends, or drives with NaN, whatever reaches it: a short fuzz of each, in virtual time.

`python -m tests.support.fuzz_nodes --messages 100000` is the long one.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.fuzzed_programs import ARGUMENTS, ENDING, NO_NODES, Fuzzed, programs
from tests.support.fuzzing import attacked
from tools.without_annex import is_here

MESSAGES = 40
"""Messages and calls to each program."""


@pytest.mark.slow
@pytest.mark.parametrize("fuzzed", list(programs()), ids=lambda fuzzed: Path(fuzzed.name).stem)
def test_a_program_survives_hostile_messages(fuzzed: Fuzzed) -> None:
    outcome = attacked(fuzzed, MESSAGES, seed=1)
    assert outcome.ended == []
    assert outcome.kinds > 0, "nothing of it was met: does it need a row in ARGUMENTS?"


def test_the_lists_name_programs_that_are_there() -> None:
    known = {each.name for each in programs()} | set(NO_NODES)
    nav2 = () if is_here("nav2") else ("nav2_",)  # an annex, which may have been deleted
    assert {each for each in ARGUMENTS if not each.startswith(nav2)} <= known
    assert all(any(each.startswith(prefix) for each in known) for prefix in ENDING if not prefix.startswith(nav2))
