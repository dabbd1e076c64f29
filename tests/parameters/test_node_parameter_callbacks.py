"""The callbacks of a node's parameters, bare and real: their order, what they may do, and several threads."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest

from robolink.exceptions import (
    InvalidParameterValueException,
    ParameterNotDeclaredException,
)
from robolink.interfaces.rcl_interfaces.msg import (
    ParameterDescriptor,
    SetParametersResult,
)
from robolink.parameter import Parameter
from tests.support.parameter_nodes import Make, made, makes

OK = SetParametersResult(successful=True)


@pytest.fixture
def make() -> Iterator[Make]:
    with makes() as make:
        yield make


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
    with pytest.warns(UserWarning, match=r"forgetful.* must return a SetParametersResult, got None"):
        (result,) = node.set_parameters([made("a", 2)])
    assert (result.successful, result.reason) == (False, "Callback returned an invalid type")
    assert node.get_parameter("a").value == 1


def test_a_callback_that_returns_something_else_is_named(make: Make) -> None:
    node = make()
    node.declare_parameter("a", 1)

    def agrees(them: list[Parameter[Any]]) -> Any:
        return True

    def prints(them: list[Parameter[Any]]) -> Any: ...

    node.add_on_set_parameters_callback(agrees)
    with pytest.warns(UserWarning, match=r"agrees.* must return a SetParametersResult, got True"):
        assert not node.set_parameters_atomically([made("a", 2)]).successful
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
