"""The parameters of a node, bare and real: set, described anew, watched by callbacks, used by several threads."""

from __future__ import annotations

import threading
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
from tests.parameter_nodes import Make, made, makes

Type = Parameter.Type
OK = SetParametersResult(successful=True)


@pytest.fixture(params=["alone", "node"])
def make(request: pytest.FixtureRequest) -> Iterator[Make]:
    with makes(request.param) as make:
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


# Callbacks


def test_callbacks_run_in_turn_the_latest_first(make: Make) -> None:
    node, calls = make(), list[str]()

    def add(number: int) -> None:
        def before(them: list[Parameter[Any]]) -> list[Parameter[Any]]:
            calls.append(f"pre {number}")
            return them if number == 1 else []

        def check(them: list[Parameter[Any]]) -> SetParametersResult:
            calls.append(f"on {number} {len(them)}")
            return OK

        node.add_pre_set_parameters_callback(before)
        node.add_on_set_parameters_callback(check)
        node.add_post_set_parameters_callback(lambda them: calls.append(f"post {number} {them[0].value}"))

    node.declare_parameters("", [("a", 1), ("b", 2)])
    add(1)
    add(2)
    assert node.set_parameters_atomically([made("a", 10), made("b", 20)]).successful
    assert calls == ["pre 2", "pre 1", "on 2 2", "on 1 2", "post 2 10", "post 1 10"]
    calls.clear()
    node.declare_parameter("c", 3)
    assert calls == ["on 2 1", "on 1 1", "post 2 3", "post 1 3"]


def test_a_callback_sees_the_old_value_before_and_the_new_one_after(make: Make) -> None:
    node, seen = make(), list[Any]()

    def see(_: list[Parameter[Any]]) -> SetParametersResult:
        seen.append(node.get_parameter("a").value)
        return OK

    node.declare_parameter("a", 1)
    node.add_on_set_parameters_callback(see)
    node.add_post_set_parameters_callback(lambda _: seen.append(node.get_parameter("a").value))
    node.set_parameters([made("a", 2)])
    assert seen == [1, 2]


def test_a_refusal_is_handed_on_and_nobody_else_is_asked(make: Make) -> None:
    node, asked = make(), list[Any]()
    node.declare_parameter("a", 1)
    node.events.clear()
    refused = SetParametersResult(successful=False, reason="too much")

    def not_asked(them: list[Parameter[Any]]) -> SetParametersResult:
        asked.append(them)
        return OK

    node.add_post_set_parameters_callback(asked.append)
    node.add_on_set_parameters_callback(not_asked)
    node.add_on_set_parameters_callback(lambda them: refused)
    assert node.set_parameters([made("a", 2)]) == [refused]
    assert (asked, node.events, node.get_parameter("a").value) == ([], [], 1)
    # An empty result is a refusal, as in rclpy: ROS's default of a bool is False.
    node.add_on_set_parameters_callback(lambda them: SetParametersResult())
    assert not node.set_parameters([made("a", 2)])[0].successful


def test_a_pre_set_callback_gives_another_list(make: Make) -> None:
    node = make()
    node.declare_parameters("", [("width", 1), ("area", 1)])

    def with_area(them: list[Parameter[Any]]) -> list[Parameter[Any]]:
        return [*them, *(made("area", each.value**2) for each in them if each.name == "width")]

    node.add_pre_set_parameters_callback(with_area)
    assert node.set_parameters([made("width", 3)])[0].successful
    assert node.get_parameter("area").value == 9
    node.undeclare_parameter("area")
    with pytest.raises(ParameterNotDeclaredException, match="area"):
        node.set_parameters([made("width", 4)])
    assert node.get_parameter("width").value == 3
    node.remove_pre_set_parameters_callback(with_area)
    node.add_pre_set_parameters_callback(lambda them: [])
    result = node.set_parameters_atomically([made("width", 5)])
    assert not result.successful
    assert "parameter list cannot be empty" in result.reason


def test_a_removed_callback_is_silent_and_cannot_be_removed_again(make: Make) -> None:
    node, calls = make(), list[Any]()

    def no(them: Any) -> SetParametersResult:
        calls.append(them)
        return SetParametersResult(successful=False)

    def nothing(them: Any) -> list[Parameter[Any]]:
        calls.append(them)
        return []

    node.add_on_set_parameters_callback(no)
    node.add_pre_set_parameters_callback(nothing)
    node.add_post_set_parameters_callback(calls.append)
    node.remove_on_set_parameters_callback(no)
    node.remove_pre_set_parameters_callback(nothing)
    node.remove_post_set_parameters_callback(calls.append)
    node.declare_parameter("a", 1)
    assert node.set_parameters([made("a", 2)])[0].successful
    assert calls == []
    with pytest.raises(ValueError, match="not in list"):
        node.remove_on_set_parameters_callback(no)
    with pytest.raises(ValueError, match="not in list"):
        node.remove_pre_set_parameters_callback(nothing)
    with pytest.raises(ValueError, match="not in list"):
        node.remove_post_set_parameters_callback(calls.append)


def test_a_callback_that_forgets_to_return_is_named(make: Make) -> None:
    node = make()
    node.declare_parameter("a", 1)

    def forgetful(them: list[Parameter[Any]]) -> Any:
        them[0].value + 1

    node.add_on_set_parameters_callback(forgetful)
    with pytest.raises(TypeError, match=r"forgetful.* must return a SetParametersResult, got None"):
        node.set_parameters([made("a", 2)])
    assert node.get_parameter("a").value == 1


def test_a_callback_that_returns_something_else_is_named(make: Make) -> None:
    node = make()
    node.declare_parameter("a", 1)

    def agrees(them: list[Parameter[Any]]) -> Any:
        return True

    def prints(them: list[Parameter[Any]]) -> Any: ...

    node.add_on_set_parameters_callback(agrees)
    with pytest.raises(TypeError, match=r"agrees.* must return a SetParametersResult, got True"):
        node.set_parameters([made("a", 2)])
    node.add_pre_set_parameters_callback(prints)
    with pytest.raises(TypeError, match=r"prints.* must return a list of parameters, got None"):
        node.set_parameters([made("a", 2)])
    assert node.get_parameter("a").value == 1


@pytest.mark.parametrize("value", ["\udc80", ["a", "\udc80"], [2**63]])
def test_what_nobody_can_be_told_is_refused_before_it_is_kept(make: Make, value: Any) -> None:
    node = make()
    with pytest.raises(InvalidParameterValueException, match="parameter 'a'"):
        node.declare_parameter("a", value)
    assert not node.has_parameter("a")
    node.declare_parameter("a", "x", ParameterDescriptor(dynamic_typing=True))
    assert "parameter 'a'" in node.set_parameters([made("a", value)])[0].reason
    assert node.get_parameter("a").value == "x"
    with pytest.raises(InvalidParameterValueException, match="not valid Unicode"):
        node.declare_parameter("\udc80", 1)


def test_callbacks_run_outside_any_lock_and_may_set_and_remove(make: Make) -> None:
    node = make()
    node.declare_parameters("", [("a", 1), ("b", 1), ("c", 1)])

    def also(name: str) -> None:
        node.set_parameters([made(name, 2)])

    def on_set(them: list[Parameter[Any]]) -> SetParametersResult:
        if them[0].name == "a":
            node.remove_on_set_parameters_callback(on_set)
            other = threading.Thread(target=also, args=("b",), daemon=True)
            other.start()
            other.join(30)
            return SetParametersResult(successful=not other.is_alive(), reason="locked")
        return OK

    node.add_on_set_parameters_callback(on_set)
    node.add_post_set_parameters_callback(lambda them: also("c") if them[0].name == "a" else None)
    assert node.set_parameters([made("a", 2)])[0].reason == ""
    assert [each.value for each in node.get_parameters(["a", "b", "c"])] == [2, 2, 2]


def test_a_callback_that_removes_itself_does_not_hide_the_next(make: Make) -> None:
    node = make()
    node.declare_parameter("a", 1)

    def once(_: list[Parameter[Any]]) -> SetParametersResult:
        node.remove_on_set_parameters_callback(once)
        return OK

    node.add_on_set_parameters_callback(lambda _: SetParametersResult(successful=False, reason="the next"))
    node.add_on_set_parameters_callback(once)
    assert node.set_parameters([made("a", 2)])[0].reason == "the next"


def test_several_are_read_as_of_one_moment(make: Make) -> None:
    node = make()
    node.declare_parameters("", [("x", 1), ("y", 1)])

    class Names(list[str]):
        """Between the names, another value is set."""

        def __iter__(self) -> Iterator[str]:
            yield "x"
            node.set_parameters_atomically([made(name, node.get_parameter("x").value + 1) for name in "xy"])
            yield "y"

    x, y = node.get_parameters(Names())
    assert x.value == y.value
    assert node.get_parameter("y").value > y.value


def test_threads_lose_nothing_and_see_whole_steps(make: Make) -> None:
    node = make(allow_undeclared=True)
    node.declare_parameters("", [("x", 0), ("y", 0)])
    start, torn = threading.Barrier(4), list[Any]()

    def write(label: str) -> None:
        start.wait(30)
        for number in range(100):
            node.set_parameters([made(f"{label}.{number}", number)])
            node.set_parameters_atomically([made("x", number), made("y", number)])

    def read() -> None:
        start.wait(30)
        while any(writer.is_alive() for writer in writers):
            x, y = node.get_parameters(["x", "y"])
            if x.value != y.value:
                torn.append((x, y))
            node.list_parameters([], 0)

    writers = [threading.Thread(target=write, args=(label,), daemon=True) for label in "abc"]
    reader = threading.Thread(target=read, daemon=True)
    for thread in (*writers, reader):
        thread.start()
    for thread in (*writers, reader):
        thread.join(30)
        assert not thread.is_alive()
    assert torn == []
    for label in "abc":
        assert len(node.get_parameters_by_prefix(label)) == 100


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
