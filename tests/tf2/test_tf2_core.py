"""The buffer of transforms: what it answers, what it refuses, and that it never makes anything up."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import assume, given
from hypothesis import strategies as st

from robolink.duration import Duration
from robolink.impl.log_output import Record
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.tf2 import (
    BufferCore,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)
from robolink.time import Time
from tests.support.buffers import LATEST, at, filled, x_of
from tests.support.transforms import HALF, between, matrix, transform

S = 10**9


# --- random trees ---------------------------------------------------------------------------------------------

NUMBER = st.floats(-10.0, 10.0)
PLACE = st.tuples(NUMBER, NUMBER, NUMBER)


def _unit(numbers: tuple[float, ...]) -> tuple[float, ...]:
    length = sum(each * each for each in numbers) ** 0.5
    return tuple(each / length for each in numbers)


TURN = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: sum(each * each for each in q) > 0.01).map(_unit)


@st.composite
def trees(draw: st.DrawFn) -> tuple[list[Any], list[Any], int]:
    """Moving and static transforms of a random tree of frames f0, f1, ...; each moving one at 1 s, 2 s and 3 s."""
    count = draw(st.integers(2, 7))
    moving, static = [], []
    for child in range(1, count):
        parent = draw(st.integers(0, child - 1))
        names = f"f{parent}", f"f{child}"
        if draw(st.booleans()):
            moving += [transform(*names, second, draw(PLACE), draw(TURN)) for second in (1, 2, 3)]
        else:
            static.append(transform(*names, 0, draw(PLACE), draw(TURN)))
    return draw(st.permutations(moving)), static, count


TIMES = st.integers(1 * S, 3 * S)


@given(trees(), TIMES, st.data())
def test_lookups_chain_and_invert(tree: Any, nanoseconds: int, data: st.DataObject) -> None:
    moving, static, count = tree
    buffer, time = filled(*moving, static=static), Time(nanoseconds=nanoseconds)
    a, b, c = (f"f{data.draw(st.integers(0, count - 1))}" for _ in range(3))
    found = {pair: matrix(buffer.lookup_transform_core(*pair, time)) for pair in [(a, c), (a, b), (b, c), (c, a)]}
    assert np.allclose(found[a, c], found[a, b] @ found[b, c], atol=1e-9)
    assert np.allclose(found[a, c] @ found[c, a], np.identity(4), atol=1e-9)
    full = buffer.lookup_transform_full_core(a, time, c, time, b)
    assert np.allclose(matrix(full), found[a, c], atol=1e-9)


@given(trees())
def test_known_times_give_what_was_stored(tree: Any) -> None:
    moving, static, _ = tree
    buffer = filled(*moving, static=static)
    for each in moving + static:
        stamp = each.header.stamp if each in moving else at(2.5)
        found = buffer.lookup_transform_core(each.header.frame_id, each.child_frame_id, stamp)
        assert np.allclose(matrix(found), matrix(each), atol=1e-9)


@given(PLACE, TURN, PLACE, TURN, st.integers(1, S - 1))
def test_between_two_times_it_interpolates_as_scipy_does(p: Any, q: Any, r: Any, s: Any, after: int) -> None:
    dot = abs(sum(a * b for a, b in zip(q, s, strict=True)))
    assume(dot > 1e-6)  # else both ways round are as short
    one, other = transform("a", "b", 1, p, q), transform("a", "b", 2, r, s)
    found = filled(other, one).lookup_transform_core("a", "b", Time(nanoseconds=S + after))
    assert np.allclose(matrix(found), between(one, other, after / S), atol=1e-6)
    turn = found.transform.rotation
    assert turn.x**2 + turn.y**2 + turn.z**2 + turn.w**2 == pytest.approx(1.0, abs=1e-12)
    assert (found.header.stamp.sec, found.header.stamp.nanosec) == (1, after)


@given(st.lists(st.integers(1, 40 * S), min_size=1, max_size=30), st.integers(1, 41 * S), st.integers(1, 15))
def test_nothing_outside_of_the_times_it_has_is_ever_given(stamps: list[int], asked: int, keep: int) -> None:
    buffer = BufferCore(Duration(seconds=keep))
    taken: list[int] = []
    for stamp in stamps:
        if not taken or stamp >= max(taken) - keep * S:
            taken.append(stamp)
        buffer.set_transform(moved_at(stamp), "test")
    can, why = buffer.can_transform_core("a", "b", Time(nanoseconds=asked))
    if can:
        assert min(taken) <= asked <= max(taken)
        assert x_of(buffer, "a", "b", Time(nanoseconds=asked)) == pytest.approx(asked / S)
    else:
        assert asked != max(taken)
        with pytest.raises(ExtrapolationException) as error:
            buffer.lookup_transform_core("a", "b", Time(nanoseconds=asked))
        assert str(error.value) == why
    assert x_of(buffer, "a", "b") == pytest.approx(max(taken) / S)


def moved_at(stamp: int) -> Any:
    made = transform("a", "b", 0, (stamp / S, 0, 0))
    made.header.stamp = Time(nanoseconds=stamp).to_msg()
    return made


# --- times ----------------------------------------------------------------------------------------------------


def test_the_latest_is_the_latest_that_all_have() -> None:
    buffer = filled(transform("a", "b", 1), transform("a", "b", 5), transform("b", "c", 1), transform("b", "c", 3))
    assert buffer.lookup_transform_core("a", "c", LATEST).header.stamp == TimeMsg(sec=3)
    assert buffer.lookup_transform_core("a", "b", LATEST).header.stamp == TimeMsg(sec=5)
    assert buffer.get_latest_common_time("c", "a") == at(3)


def test_what_is_static_has_no_say_in_the_latest_time() -> None:
    buffer = filled(transform("a", "b", 4), static=[transform("b", "c", 9), transform("c", "d", 9)])
    assert buffer.get_latest_common_time("a", "d") == at(4)
    assert buffer.get_latest_common_time("b", "d") == LATEST
    assert buffer.lookup_transform_core("b", "d", at(7)).header.stamp == TimeMsg(sec=7)


@pytest.mark.parametrize("time", [at(1.5), TimeMsg(sec=1, nanosec=500_000_000), Duration(seconds=1.5)])
def test_a_time_is_whatever_says_seconds_or_nanoseconds(time: Any) -> None:
    assert x_of(filled(moved_at(S), moved_at(2 * S)), "a", "b", time) == 1.5


@pytest.mark.parametrize("time", [None, 1.5, "now"])
def test_what_is_no_time_is_a_type_error(time: Any) -> None:
    with pytest.raises(TypeError, match="time must have sec and nanosec, or nanoseconds; got"):
        filled(moved_at(S)).lookup_transform_core("a", "b", time)


def test_between_two_frames_and_two_times() -> None:
    buffer = filled(*(transform("odom", "base", s, (s, 0, 0)) for s in (1, 2)), static=[transform("odom", "wall")])
    moved = buffer.lookup_transform_full_core("base", at(2), "base", at(1), "odom")
    assert (moved.transform.translation.x, moved.header.stamp.sec) == (-1.0, 2)
    assert buffer.can_transform_full_core("base", at(2), "base", at(1), "wall") == (True, "")
    can, why = buffer.can_transform_full_core("base", at(2), "base", at(0.5), "odom")
    assert (can, "extrapolation into the past" in why) == (False, True)
    can, why = buffer.can_transform_full_core("base", at(2), "base", at(1), "oddom")
    assert (can, "canTransform argument fixed_frame does not exist" in why) == (False, True)


def test_ten_seconds_are_kept_and_older_data_is_refused(log_lines: list[Record]) -> None:
    buffer = filled(*(moved_at(s * S) for s in range(1, 21)))
    assert buffer.can_transform_core("a", "b", at(10))[0]
    assert not buffer.can_transform_core("a", "b", at(8.9))[0]
    buffer.set_transform(moved_at(9 * S), "late one")
    assert len(log_lines) == 1
    assert "TF_OLD_DATA: ignored the transform from 'a' to 'b' of 'late one'" in log_lines[0].message
    assert "it is 11.000 s older than the latest, and 10 s are kept" in log_lines[0].message


def test_of_one_stamp_the_last_counts_and_nothing_piles_up() -> None:
    buffer = filled(*(transform("a", "b", 1, (x, 0, 0)) for x in range(100)))
    assert x_of(buffer, "a", "b", at(1)) == 99
    assert yaml.safe_load(buffer.all_frames_as_yaml())["b"]["rate"] == 10_000


# --- the tree -------------------------------------------------------------------------------------------------


def test_only_the_part_below_the_meeting_point_is_needed() -> None:
    buffer = filled(transform("map", "odom", 1), static=[transform("odom", "l"), transform("odom", "r")])
    assert buffer.can_transform_core("l", "r", at(500)) == (True, "")


def test_a_frame_may_change_its_parent() -> None:
    buffer = filled(
        transform("table", "cup", 1, (1, 0, 0)),
        transform("hand", "cup", 2, (5, 0, 0)),
        static=[transform("map", "table"), transform("map", "hand")],
    )
    assert x_of(buffer, "table", "cup", at(1)) == 1
    assert x_of(buffer, "table", "cup", at(1.5)) == 1  # it is not between two parents
    assert x_of(buffer, "hand", "cup", at(2)) == 5
    assert "Frame cup exists with parent hand." in buffer.all_frames_as_string()


def test_what_moved_may_become_static_and_move_again() -> None:
    buffer = filled(transform("a", "b", 1, (1, 0, 0)), static=[transform("a", "b", 0, (2, 0, 0))])
    assert x_of(buffer, "a", "b", at(50)) == 2
    buffer.set_transform(transform("a", "b", 3, (3, 0, 0)), "test")
    assert x_of(buffer, "a", "b", at(3)) == 3
    assert not buffer.can_transform_core("a", "b", at(50))[0]


def test_clear_forgets_what_moves_and_keeps_what_does_not() -> None:
    buffer = filled(transform("a", "b", 1), static=[transform("b", "c")])
    buffer.clear()
    assert buffer.can_transform_core("b", "c", LATEST)[0]
    with pytest.raises(ConnectivityException):
        buffer.lookup_transform_core("a", "b", LATEST)
    with pytest.raises(ExtrapolationException, match="no data is in the buffer"):
        buffer.lookup_transform_core("a", "b", at(1))
    assert buffer.get_all_frame_names() == ["b", "a", "c"]
    assert buffer._getFrameStrings() == ["b", "a", "c"]


def test_a_frame_in_itself_is_where_it_is() -> None:
    found = filled(transform("a", "b", 3)).lookup_transform_core("b", "b", LATEST)
    assert (found.transform.rotation.w, found.header.stamp.sec) == (1.0, 3)
    assert BufferCore().can_transform_core("new", "new", at(4)) == (True, "")


def test_slashes_in_front_are_taken_off() -> None:
    assert filled(transform("/a", "/b", 1)).can_transform_core("a", "b", LATEST)[0]


def test_the_sign_of_a_quaternion_is_tf2s() -> None:
    for turn, wanted in [((0, 0, 0, -1), (0, 0, 0, 1)), ((0, 0, -0.9848, 0.1736), (0, 0, 0.9848, -0.1736))]:
        found = filled(transform("a", "b", 1, turn=turn)).lookup_transform_core("a", "b", LATEST).transform.rotation
        assert (found.x, found.y, found.z, found.w) == pytest.approx(wanted, abs=1e-4)


def test_a_quaternion_that_is_a_little_off_is_made_a_unit() -> None:
    found = filled(transform("a", "b", 1, turn=(0, 0, 0.707, 0.707))).lookup_transform_core("a", "b", LATEST)
    assert found.transform.rotation.z == pytest.approx(HALF, abs=1e-15)


# --- errors ---------------------------------------------------------------------------------------------------

PAST = "past.  Requested time 0.500000 but the earliest data is at time 1.000000"
FUTURE = "future.  Requested time 9.000000 but the latest data is at time 2.000000"


@pytest.mark.parametrize(("seconds", "said"), [(0.5, PAST), (9, FUTURE)])
def test_an_extrapolation_names_frames_and_times(seconds: float, said: str) -> None:
    buffer = filled(moved_at(S), moved_at(2 * S))
    said = f"Lookup would require extrapolation into the {said}, when looking up transform from frame [b] to frame [a]"
    with pytest.raises(ExtrapolationException) as error:
        buffer.lookup_transform_core("a", "b", at(seconds))
    assert str(error.value) == said
    assert buffer.can_transform_core("a", "b", at(seconds)) == (False, said)


def test_a_single_time_is_named() -> None:
    with pytest.raises(ExtrapolationException, match=r"at time 2\.000000, but only time 1\.000000 is in the buffer"):
        filled(moved_at(S)).lookup_transform_core("b", "a", at(2))


def test_two_trees_are_named() -> None:
    buffer = filled(static=[transform("map", "odom"), transform("odom", "base"), transform("rig", "camera")])
    with pytest.raises(ConnectivityException) as error:
        buffer.lookup_transform_core("base", "camera", LATEST)
    assert str(error.value) == (
        "Could not find a connection between 'base' and 'camera' because they are not part of the same tree. Tf has"
        " two or more unconnected trees: 'base' is in that of 'map', 'camera' in that of 'rig'."
    )


@pytest.mark.parametrize(("frames", "role"), [(("bb", "a"), "target"), (("a", "bb"), "source")])
def test_an_unknown_frame_is_named_with_the_nearest(frames: tuple[str, str], role: str) -> None:
    buffer = filled(static=[transform("a", "base")])
    with pytest.raises(LookupException, match=f'"bb" passed to lookupTransform argument {role}_frame does not exist'):
        buffer.lookup_transform_core(*frames, LATEST)
    assert "(did you mean 'base'?)" in buffer.can_transform_core("a", "bas", LATEST)[1]


@pytest.mark.parametrize(("frame", "said"), [("", "cannot be empty"), ("/a", "cannot start with a '/'")])
def test_a_name_that_cannot_be_is_an_invalid_argument(frame: str, said: str) -> None:
    buffer = filled(static=[transform("a", "b")])
    for pair in ((frame, "b"), ("b", frame)):
        with pytest.raises(InvalidArgumentException, match=said):
            buffer.lookup_transform_core(*pair, LATEST)
        assert said in buffer.can_transform_core(*pair, LATEST)[1]
        with pytest.raises(InvalidArgumentException, match=said):
            buffer.get_latest_common_time(*pair)


def test_errors_are_of_one_family_and_of_the_standard_librarys() -> None:
    for kind in (LookupException, ConnectivityException, ExtrapolationException):
        assert issubclass(kind, TransformException)
        assert issubclass(kind, LookupError)
    assert issubclass(InvalidArgumentException, ValueError)


# --- threads --------------------------------------------------------------------------------------------------


def test_threads_may_write_and_read_at_once() -> None:
    buffer, errors = filled(transform("a", "b", 1), transform("b", "c", 1)), []

    def write(child: str, parent: str) -> None:
        for step in range(300):
            buffer.set_transform(transform(parent, child, 1 + step / 100), "x")

    def read() -> None:
        try:
            for _ in range(300):
                buffer.lookup_transform_core("a", "c", LATEST)
                buffer.all_frames_as_yaml()
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=write, args=each) for each in [("b", "a"), ("c", "b")]]
    threads += [threading.Thread(target=read) for _ in range(2)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert errors == []
