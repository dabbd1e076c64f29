"""Refusals of the buffer of transforms: bad numbers, bad names, loops, and anything else."""

from __future__ import annotations

from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from robolink.impl.log_output import Record
from robolink.tf2 import (
    BufferCore,
    LookupException,
    TransformException,
)
from robolink.time import Time
from tests.support.buffers import LATEST, at, filled, x_of
from tests.support.transforms import transform

NAN = float("nan")

REFUSED = [
    (transform("a", "a", 1), "TF_SELF_TRANSFORM", "one frame"),
    (transform("a", "/a", 1), "TF_SELF_TRANSFORM", "one frame"),
    (transform("", "b", 1), "TF_NO_FRAME_ID", "frame_id is empty"),
    (transform("a", "", 1), "TF_NO_CHILD_FRAME_ID", "child_frame_id is empty"),
    (transform("a", "/", 1), "TF_NO_CHILD_FRAME_ID", "child_frame_id is empty"),
    (transform("a", "b", 1, (NAN, 0, 0)), "TF_NAN_INPUT", "finite"),
    (transform("a", "b", 1, (0, float("inf"), 0)), "TF_NAN_INPUT", "finite"),
    (transform("a", "b", 1, turn=(0, 0, NAN, 1)), "TF_NAN_INPUT", "finite"),
    (transform("a", "b", 1, turn=(0, 0, 0, 0)), "TF_DENORMALIZED_QUATERNION", "norm of 0"),
    (transform("a", "b", 1, turn=(1, 0, 0, 1)), "TF_DENORMALIZED_QUATERNION", "norm of 1.41"),
    (transform("base", "map", 1), "TF_LOOP", "'base' is below 'map' already"),
    (transform("odom", "map", 1), "TF_LOOP", "'odom' is below 'map' already"),
]


@pytest.mark.parametrize(("bad", "word", "why"), REFUSED)
@pytest.mark.parametrize("static", [False, True])
def test_what_cannot_be_is_warned_about_and_nothing_is_lost(
    bad: Any, word: str, why: str, static: bool, log_lines: list[Record]
) -> None:
    buffer = filled(transform("map", "odom", 1), transform("odom", "base", 1), transform("a", "b", 1, (7, 0, 0)))
    (buffer.set_transform_static if static else buffer.set_transform)(bad, "somebody")
    assert len(log_lines) == 1
    assert log_lines[0].message.startswith(f"{word}: ignored the transform from '")
    assert "of 'somebody'" in log_lines[0].message
    assert why in log_lines[0].message
    assert buffer.can_transform_core("map", "base", at(1))[0]
    assert x_of(buffer, "a", "b") == 7


def test_the_hundredth_of_a_kind_is_told_again(log_lines: list[Record]) -> None:
    buffer = BufferCore()
    for _ in range(250):
        buffer.set_transform(transform("a", "b", 1, (NAN, 0, 0)), "x")
    assert [line.message.rpartition("(")[2] for line in log_lines] == [
        "the next ones are only counted)",
        "10 of them so far)",
        "100 of them so far)",
    ]


def test_a_loop_that_holds_only_at_another_time_is_none() -> None:
    buffer = filled(transform("a", "b", 1), transform("c", "b", 5), transform("b", "a", 5))
    assert buffer.can_transform_core("c", "a", at(5))[0]
    assert buffer.can_transform_core("a", "b", at(1))[0]


def test_a_loop_of_the_latest_transforms_is_told() -> None:
    buffer = filled(transform("c", "b", 1), transform("a", "b", 5), transform("b", "a", 2))  # none at any one time
    with pytest.raises(LookupException, match=r"contains a loop\.\nFrame b exists with parent a\."):
        buffer.lookup_transform_core("c", "b", LATEST)
    assert buffer.can_transform_core("c", "b", at(1))[0]


@pytest.mark.parametrize("bad", [None, "a", 3, Time(), transform("a", "b", 1).transform])
def test_what_is_no_transform_is_a_type_error(bad: Any) -> None:
    with pytest.raises(TypeError, match="expected a TransformStamped, got"):
        BufferCore().set_transform(bad, "x")


@given(st.lists(st.tuples(st.sampled_from("abcd"), st.sampled_from("abcd"), st.integers(0, 5), st.booleans())))
def test_whatever_comes_there_is_an_answer_or_a_transform_exception(sent: list[Any]) -> None:
    buffer = BufferCore()
    for parent, child, second, static in sent:
        (buffer.set_transform_static if static else buffer.set_transform)(transform(parent, child, second), "x")
    for target in "abcd":
        for second in range(6):
            can, why = buffer.can_transform_core(target, "a", at(second))
            assert can == (why == "")
            try:
                buffer.lookup_transform_core(target, "a", at(second))
                assert can
            except TransformException:
                assert not can
    yaml.safe_load(buffer.all_frames_as_yaml())
