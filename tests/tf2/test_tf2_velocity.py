"""Velocities between frames, and the listings of all frames."""

from __future__ import annotations

import numpy as np
import pytest
import yaml
from hypothesis import assume, given
from hypothesis import strategies as st

from robolink.duration import Duration
from robolink.tf2 import (
    BufferCore,
    InvalidArgumentException,
    listing,
)
from tests.support.buffers import LATEST, at, filled
from tests.support.transforms import HALF, transform


def test_velocity() -> None:
    driving = [transform("odom", "base", s, (2 * s, 0, 0), (0, 0, np.sin(s / 20), np.cos(s / 20))) for s in range(1, 6)]
    buffer = filled(*driving, static=[transform("odom", "north", turn=(0, 0, HALF, HALF))])
    linear, angular = buffer.lookupVelocityCore("base", "odom", at(3), Duration(seconds=2))
    assert linear == pytest.approx((2, 0, 0))
    assert angular == pytest.approx((0, 0, 0.1))
    turned = buffer.lookupVelocityFullCore("base", "odom", "north", (0, 0, 0), "base", at(3), Duration(seconds=2))
    assert turned[0] == pytest.approx((0, -2, 0))
    ahead = buffer.lookupVelocityFullCore("base", "odom", "odom", (6, 1, 0), "odom", at(3), Duration(seconds=2))
    assert ahead[0] == pytest.approx((2 - 0.1, 0, 0))  # a point to the left of the base goes slower
    with pytest.raises(InvalidArgumentException, match="holds no two known times"):
        buffer.lookupVelocityCore("base", "odom", at(3), Duration())


def test_the_yaml_has_what_tf2s_has() -> None:
    buffer = filled(*(transform("odom", "base", 1 + s / 10) for s in range(11)), static=[transform("map", "it's: odd")])
    found = yaml.safe_load(buffer.all_frames_as_yaml())
    assert found["base"] == {
        "parent": "odom",
        "broadcaster": "test",
        "rate": 11.0,
        "most_recent_transform": 2.0,
        "oldest_transform": 1.0,
        "buffer_length": 1.0,
    }
    assert found["it's: odd"]["parent"] == "map"
    assert BufferCore().all_frames_as_yaml() == "[]"
    assert "base: \n  parent: 'odom'\n  broadcaster: 'test'\n  rate: 11.000\n" in buffer.all_frames_as_yaml()


@pytest.mark.parametrize("word", [*sorted(listing.NOT_TEXT), "No", "1e5", "0x1", "_1", "a: b", "~", "=", "<<"])
def test_words_that_yaml_reads_otherwise_come_through(word: str) -> None:
    for names in ((word, "frame"), ("frame", word)):
        assert yaml.safe_load(filled(static=[transform(*names)]).all_frames_as_yaml())[names[1]]["parent"] == names[0]


@given(st.text(min_size=1), st.text(min_size=1))
def test_names_of_any_letters_come_through_the_yaml(parent: str, child: str) -> None:
    names = parent.removeprefix("/"), child.removeprefix("/")
    assume(all(names) and names[0] != names[1])
    buffer = filled(static=[transform(parent, child)])
    assert yaml.safe_load(buffer.all_frames_as_yaml())[names[1]]["parent"] == names[0]


def test_a_frame_exists_from_when_it_is_first_heard_of() -> None:
    """By the name that tf2_py has for it, which programs use for want of another."""
    buffer = BufferCore()
    assert not buffer._frameExists("map")
    buffer.set_transform(transform("map", "base"), "test")
    assert [buffer._frameExists(each) for each in ("map", "base", "cup")] == [True, True, False]
    buffer.clear()
    assert buffer._frameExists("base")


def test_the_graph_for_dot() -> None:
    text = filled(transform('o"m', "base", 1))._allFramesAsDot(at(3))
    assert '"o\\"m" -> "base"[label="Broadcaster: test' in text
    assert "(2.000 sec old)" in text
    assert BufferCore()._allFramesAsDot() == 'digraph G {\n"no tf data received"\n}'


def test_the_chain_from_source_to_target() -> None:
    buffer = filled(static=[transform("m", "o"), transform("o", "b"), transform("b", "l"), transform("m", "w")])
    assert buffer._chain("w", LATEST, "l", LATEST, "m") == ["l", "b", "o", "m", "w"]
    assert buffer._chain("l", LATEST, "o", LATEST, "o") == ["o", "b", "l"]
    assert buffer._chain("w", LATEST, "o", LATEST, "w") == ["o", "m", "w"]
