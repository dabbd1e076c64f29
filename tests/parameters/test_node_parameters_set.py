"""The parameters of a node, bare and real: set, described anew, watched by callbacks, used by several threads."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from robolink.clock import Clock
from robolink.exceptions import (
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
)
from robolink.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from robolink.parameter import Parameter
from tests.support.parameter_nodes import Make, made, makes

Type = Parameter.Type


@pytest.fixture
def make() -> Iterator[Make]:
    with makes() as make:
        yield make


# Setting


def test_each_is_set_or_refused_on_its_own(make: Make) -> None:
    node = make()
    node.declare_parameters("", [("a", 1), ("fixed", 2, ParameterDescriptor(read_only=True)), ("c", 3)])
    results = node.set_parameters([made("a", 10), made("fixed", 20), made("c", "x"), made("c", 30)])
    assert [each.successful for each in results] == [True, False, False, True]
    assert "read-only parameter: fixed" in results[1].reason
    assert results[2].reason == "Wrong parameter type for 'c': expected INTEGER, got STRING"
    assert [each.value for each in node.get_parameters(["a", "fixed", "c"])] == [10, 2, 30]


def test_atomically_means_all_or_none(make: Make) -> None:
    node = make()
    node.declare_parameters("", [("a", 1), ("b", 2)])
    node.events.clear()
    assert not node.set_parameters_atomically([made("a", 10), made("b", "x")]).successful
    assert [each.value for each in node.get_parameters(["a", "b"])] == [1, 2]
    assert node.events == []
    assert node.set_parameters_atomically([made("a", 10), made("b", 20)]).successful
    assert [each.value for each in node.get_parameters(["a", "b"])] == [10, 20]
    assert len(node.events) == 1


def test_those_before_an_undeclared_one_stay_set(make: Make) -> None:
    node = make()
    node.declare_parameters("", [("a", 1), ("b", 2)])
    with pytest.raises(ParameterNotDeclaredException, match="ghost"):
        node.set_parameters([made("a", 10), made("ghost", 0), made("b", 20)])
    assert [each.value for each in node.get_parameters(["a", "b"])] == [10, 2]


@pytest.mark.usefixtures("known_as_robolink")
def test_only_parameters_can_be_set(make: Make) -> None:
    wrong: Any = [42]
    with pytest.raises(TypeError, match=r"expected a robolink\.parameter\.Parameter, got 42"):
        make(allow_undeclared=True).set_parameters(wrong)


def test_no_value_undeclares_a_dynamic_parameter_and_no_other(make: Make) -> None:
    node = make()
    node.declare_parameters("", [("free", 1, ParameterDescriptor(dynamic_typing=True)), ("static", 2)])
    node.events.clear()
    free, static = node.set_parameters([Parameter("free"), Parameter("static")])
    assert free.successful
    assert not node.has_parameter("free")
    assert [each.name for each in node.events[0].deleted_parameters] == ["free"]
    assert static.reason == "Static parameter cannot be undeclared"
    assert node.get_parameter("static").value == 2


def test_undeclared_parameters_are_dynamic_where_they_are_allowed(make: Make) -> None:
    node = make(allow_undeclared=True)
    assert node.get_parameter("new").type_ is Type.NOT_SET
    assert node.get_parameter_type("new") is Type.NOT_SET
    assert node.describe_parameter("new") == ParameterDescriptor()
    assert node.set_descriptor("new", ParameterDescriptor()) == ParameterValue()
    for value, type_ in ((5, ParameterType.PARAMETER_INTEGER), ("five", ParameterType.PARAMETER_STRING)):
        assert node.set_parameters([made("new", value)])[0].successful
        assert node.get_parameter("new").value == value
        assert node.describe_parameter("new") == ParameterDescriptor(name="new", type=type_, dynamic_typing=True)
    with pytest.raises(ParameterAlreadyDeclaredException):
        node.declare_parameter("new", 5)


def test_a_refused_value_leaves_the_descriptor_as_it_was(make: Make) -> None:
    node = make()
    node.declare_parameter("free", 1, ParameterDescriptor(dynamic_typing=True))
    node.add_on_set_parameters_callback(lambda _: SetParametersResult(successful=False, reason="no"))
    assert node.set_parameters([made("free", "one")])[0].reason == "no"
    assert node.describe_parameter("free").type == ParameterType.PARAMETER_INTEGER


def test_an_event_says_what_is_new_changed_and_deleted(make: Make) -> None:
    node = make()
    before = Clock().now().nanoseconds
    node.declare_parameter("count", Type.INTEGER)
    node.declare_parameter("free", 1, ParameterDescriptor(dynamic_typing=True))
    node.set_parameters_atomically([made("count", 3), Parameter("free")])
    node.set_parameters([made("count", 4)])
    told = [
        tuple([each.name for each in them] for them in (e.new_parameters, e.changed_parameters, e.deleted_parameters))
        for e in node.events
    ]
    assert told == [(["count"], [], []), (["free"], [], []), (["count"], [], ["free"]), ([], ["count"], [])]
    assert node.events[-1].changed_parameters[0].value.integer_value == 4
    for event in node.events:
        assert event.node == "/arm/driver"
        assert event.stamp.sec * 10**9 + event.stamp.nanosec >= before


# Ranges and descriptors


def test_ranges_hold_for_declaring_and_setting(make: Make) -> None:
    node = make({"speed": 7.0})
    slow = ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=0.0, to_value=2.0)])
    with pytest.raises(InvalidParameterValueException, match=r"7\.0 is not within 0\.0 to 2\.0"):
        node.declare_parameter("speed", 1.0, slow)
    node.declare_parameter("speed", 1.0, slow, ignore_override=True)
    assert "out of range" in node.set_parameters([made("speed", 2.5)])[0].reason
    assert node.set_parameters([made("speed", 2.0)])[0].successful
    assert node.get_parameter("speed").value == 2.0


def test_a_new_descriptor_keeps_the_value_that_fits(make: Make) -> None:
    node = make()
    node.declare_parameter("count", 5)
    node.events.clear()
    described = ParameterDescriptor(
        name="ignored", type=ParameterType.PARAMETER_INTEGER, integer_range=[IntegerRange(from_value=0, to_value=9)]
    )
    assert node.set_descriptor("count", described).integer_value == 5
    assert node.describe_parameter("count").name == "count"
    assert described.name == "ignored"
    assert "out of range" in node.set_parameters([made("count", 10)])[0].reason
    dynamic = ParameterDescriptor(type=ParameterType.PARAMETER_BOOL, dynamic_typing=True)
    node.set_descriptor("count", dynamic)
    assert node.describe_parameter("count").type == ParameterType.PARAMETER_INTEGER
    node.set_parameters([made("count", "ten")])
    assert node.get_parameter("count").value == "ten"


def test_a_new_descriptor_takes_the_alternative_or_is_refused(make: Make) -> None:
    node = make()
    node.declare_parameter("count", 50)
    narrow = ParameterDescriptor(
        type=ParameterType.PARAMETER_INTEGER, integer_range=[IntegerRange(from_value=0, to_value=9)]
    )
    with pytest.raises(InvalidParameterValueException, match="50 is not within 0 to 9"):
        node.set_descriptor("count", narrow)
    with pytest.raises(InvalidParameterValueException, match="70 is not within 0 to 9"):
        node.set_descriptor("count", narrow, made("", 70).get_parameter_value())
    assert node.describe_parameter("count").integer_range == []
    assert node.set_descriptor("count", narrow, made("", 7).get_parameter_value()).integer_value == 7
    assert node.get_parameter("count").value == 7
    node.set_descriptor("count", ParameterDescriptor(type=ParameterType.PARAMETER_INTEGER, read_only=True))
    with pytest.raises(ParameterImmutableException):
        node.set_descriptor("count", narrow)
    with pytest.raises(ParameterNotDeclaredException, match="did you mean 'count'"):
        node.set_descriptor("coumt", narrow)
