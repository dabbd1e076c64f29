"""Attempts across machines, in network namespaces: `tests/support/attempts.py`, one short round."""

from __future__ import annotations

import pytest

from tests.support import stalls

pytest.importorskip("cryptography", reason="needs the extra `security`")

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(bool(stalls.no_hosts()), reason=stalls.no_hosts() or "there are two hosts"),
]


def test_over_the_network_allowed_topics_flow_and_no_attacker_gets_anything_through() -> None:
    from tests.support import attempts

    outcome = attempts.play(patience=1.5)
    assert [*attempts.faults(outcome)] == [], outcome


def test_a_class_that_launch_started_meets_by_a_router_and_no_student_gets_more_than_it_may() -> None:
    from tests.support import class_attempts

    rows = class_attempts.play("router", joins=False)
    assert [*class_attempts.faults(rows)] == [], rows
    assert len(rows) >= 50
