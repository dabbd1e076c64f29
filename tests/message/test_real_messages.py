"""Messages that a real ROS 2 serialized, of every type of its wheels (tests/support/real_messages.py records them)."""

from __future__ import annotations

import pytest

from robolink.message import decode, encode
from tests.support.real_messages import KEPT, made, misread, our_class, plain, recorded

RECORDED = recorded()


def test_all_types_are_recorded() -> None:
    assert len(RECORDED) == 252
    assert {len(data) for data in RECORDED.values()} == {KEPT}


@pytest.mark.slow
def test_what_a_real_ros_wrote_is_read_field_by_field() -> None:
    wrong = {name: misread(name, data) for name, data in RECORDED.items()}
    assert {name: numbers for name, numbers in wrong.items() if numbers} == {}


@pytest.mark.slow
def test_what_robolink_writes_are_the_same_bytes() -> None:
    """But for what Fast CDR leaves between and behind the fields, where ours are zeros and none."""
    for name, data in RECORDED.items():
        cls = our_class(name)
        for at, theirs in enumerate(data):
            own = encode(made(cls, at, our_class))
            assert len(own) <= len(theirs), name
            odd = {place for place, (one, other) in enumerate(zip(own, theirs, strict=False)) if one != other}
            assert not any(own[place] for place in odd), name
            zeroed = bytes(0 if place in odd else each for place, each in enumerate(theirs))
            assert plain(decode(cls, zeroed)) == plain(decode(cls, theirs)), name
