"""Times and durations: whole nanoseconds, 64 bits, and clocks that do not mix."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from datetime import datetime
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.clock_type import ClockType
from robolink.constants import S_TO_NS
from robolink.duration import Duration, Infinite
from robolink.interfaces.builtin_interfaces.msg import Duration as DurationMsg
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.time import Time

LIMIT = 2**63
spans = st.integers(-LIMIT, LIMIT - 1)
instants = st.integers(0, LIMIT - 1)
clock_types = st.sampled_from(ClockType)


@given(spans)
def test_a_duration_keeps_every_nanosecond_through_its_message(nanoseconds: int) -> None:
    duration = Duration(nanoseconds=nanoseconds)
    message = duration.to_msg()
    assert 0 <= message.nanosec < S_TO_NS
    assert Duration.from_msg(message) == duration


@given(instants, clock_types)
def test_a_time_keeps_every_nanosecond_through_its_message(nanoseconds: int, clock_type: ClockType) -> None:
    time = Time(nanoseconds=nanoseconds, clock_type=clock_type)
    assert Time.from_msg(time.to_msg(), clock_type) == time
    assert time.seconds_nanoseconds() == divmod(nanoseconds, S_TO_NS)


def test_a_time_read_from_a_message_is_ros_time() -> None:
    assert Time.from_msg(TimeMsg(sec=1, nanosec=5)).clock_type is ClockType.ROS_TIME


def test_seconds_and_nanoseconds_add_up_and_fractions_of_a_nanosecond_are_cut() -> None:
    assert Duration(seconds=1.5, nanoseconds=7.9).nanoseconds == 1_500_000_007
    assert Duration(seconds=-0.5, nanoseconds=1).nanoseconds == -499_999_999
    assert Time(seconds=2, nanoseconds=5e8).nanoseconds == 2_500_000_000


@pytest.mark.parametrize("nanoseconds", [LIMIT, -LIMIT - 1])
def test_what_does_not_fit_in_64_bits_overflows(nanoseconds: int) -> None:
    with pytest.raises(OverflowError, match=str(nanoseconds)):
        Duration(nanoseconds=nanoseconds)
    with pytest.raises(OverflowError if nanoseconds > 0 else ValueError):
        Time(nanoseconds=nanoseconds)


@pytest.mark.parametrize("seconds", [math.inf, -math.inf])
def test_infinite_seconds_overflow(seconds: float) -> None:
    with pytest.raises(OverflowError):
        Duration(seconds=seconds)


def test_a_time_is_never_negative() -> None:
    with pytest.raises(ValueError, match="negative"):
        Time(seconds=-1)
    with pytest.raises(ValueError, match="negative"):
        Time(seconds=1) - Duration(seconds=2)


def test_a_clock_type_must_be_one() -> None:
    with pytest.raises(TypeError, match="ClockType"):
        Time(clock_type="ROS_TIME")  # type: ignore[arg-type]  # the point of the test


@given(instants, instants, clock_types)
def test_times_of_one_clock_order_and_subtract_as_their_nanoseconds(a: int, b: int, clock_type: ClockType) -> None:
    first, second = Time(nanoseconds=a, clock_type=clock_type), Time(nanoseconds=b, clock_type=clock_type)
    assert (first < second, first <= second, first > second, first >= second) == (a < b, a <= b, a > b, a >= b)
    assert (first == second, first != second) == (a == b, a != b)
    assert (first - second).nanoseconds == a - b
    assert second + (first - second) == first
    assert (first - second) + second == first


@given(spans, spans)
def test_durations_order_and_add_as_their_nanoseconds(a: int, b: int) -> None:
    first, second = Duration(nanoseconds=a), Duration(nanoseconds=b)
    assert (first < second, first <= second, first > second, first >= second) == (a < b, a <= b, a > b, a >= b)
    assert (first == second) == (a == b)
    if -LIMIT <= a + b < LIMIT:
        assert (first + second).nanoseconds == a + b
    else:
        with pytest.raises(OverflowError):
            first + second


def test_times_of_different_clocks_do_not_mix() -> None:
    ros, system = Time(nanoseconds=2, clock_type=ClockType.ROS_TIME), Time(nanoseconds=2)
    for operation in ("__lt__", "__le__", "__eq__", "__sub__"):
        with pytest.raises(TypeError, match="ROS_TIME and SYSTEM_TIME"):
            getattr(ros, operation)(system)


@pytest.mark.parametrize("other", [1, 1.0, "1", None, Duration(nanoseconds=1)])
def test_a_time_differs_from_what_is_no_time_and_cannot_be_ordered_against_it(other: Any) -> None:
    time = Time(nanoseconds=1)
    assert time != other
    with pytest.raises(TypeError):
        assert time < other
    with pytest.raises(TypeError):
        assert time >= other


@pytest.mark.parametrize(
    ("operation", "left", "right"),
    [
        (operator.add, Time(nanoseconds=1), Time(nanoseconds=1)),
        (operator.sub, Duration(nanoseconds=1), Time(nanoseconds=1)),
        (operator.add, Duration(nanoseconds=1), 1),
        (operator.sub, Time(nanoseconds=1), 1),
        (operator.mul, Duration(nanoseconds=1), "2"),
    ],
)
def test_sums_that_mean_nothing_are_type_errors(
    operation: Callable[[Any, Any], Any], left: object, right: object
) -> None:
    with pytest.raises(TypeError):
        operation(left, right)


def test_a_duration_is_scaled_by_numbers() -> None:
    second = Duration(seconds=1)
    assert second * 3 == Duration(seconds=3)
    assert second * -0.5 == Duration(nanoseconds=-500_000_000)
    assert second * math.inf is Infinite
    for bad in (math.nan, -math.inf):
        with pytest.raises(ValueError, match="cannot be multiplied"):
            second * bad


def test_messages_of_other_types_are_refused() -> None:
    with pytest.raises(TypeError, match="Duration"):
        Time.from_msg(DurationMsg())  # type: ignore[arg-type]  # the point of the test
    with pytest.raises(TypeError, match="Time"):
        Duration.from_msg(TimeMsg())  # type: ignore[arg-type]  # the point of the test


def test_they_show_what_they_are() -> None:
    assert repr(Time(seconds=1, clock_type=ClockType.ROS_TIME)) == "Time(nanoseconds=1000000000, clock_type=ROS_TIME)"
    assert repr(Duration(nanoseconds=5)) == "Duration(nanoseconds=5)"
    assert (str(Duration(nanoseconds=5)), str(Infinite)) == ("5 nanoseconds", "Infinite")


@pytest.mark.parametrize("value", [Time(), Duration()])
def test_they_are_not_hashable_as_in_rclpy(value: Any) -> None:
    with pytest.raises(TypeError, match="unhashable"):
        hash(value)


@pytest.mark.parametrize("clock_type", [ClockType.ROS_TIME, ClockType.SYSTEM_TIME])
def test_a_time_is_a_local_date(clock_type: ClockType) -> None:
    moment = datetime(2026, 5, 22, 14, 30, 5, 250_000)
    time = Time(seconds=int(moment.timestamp()), nanoseconds=250_000_999, clock_type=clock_type)
    assert time.to_datetime() == moment.replace(microsecond=250_001)
    assert time.to_datetime().tzinfo is None


def test_a_time_of_a_steady_clock_is_no_date() -> None:
    with pytest.raises(TypeError, match="steady clock"):
        Time(seconds=1, clock_type=ClockType.STEADY_TIME).to_datetime()
