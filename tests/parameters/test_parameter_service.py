"""The parameter services: what they answer, to good requests and bad, and that the node is what they have told."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink import Context, Node, Parameter
from robolink.client import Client
from robolink.exceptions import ParameterAlreadyDeclaredException, ParameterNotDeclaredException
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.rcl_interfaces import srv
from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor, ParameterValue, SetParametersResult
from robolink.node_parts.request_limit import LARGEST, MOST_NAMES, why_refused
from robolink.parameter import parameter_value_to_python
from tests.support.spins import done

Type = Parameter.Type
SERVICES = {
    "describe_parameters": srv.DescribeParameters,
    "get_parameter_types": srv.GetParameterTypes,
    "get_parameters": srv.GetParameters,
    "list_parameters": srv.ListParameters,
    "set_parameters": srv.SetParameters,
    "set_parameters_atomically": srv.SetParametersAtomically,
}


class Asker:
    """Asks the services of /lab/robot, and spins until they answer."""

    def __init__(self, executor: SingleThreadedExecutor, robot: Node) -> None:
        self.executor, self.robot = executor, robot
        asker = Node("asker", context=robot.context, start_parameter_services=False)
        executor.add_node(asker)
        executor.add_node(robot)
        self.clients: dict[str, Client] = {
            name: asker.create_client(srv_type, f"/lab/robot/{name}") for name, srv_type in SERVICES.items()
        }

    def __call__(self, name: str, **request: Any) -> Any:
        return done(self.executor, self.clients[name].call_async(SERVICES[name].Request(**request)))

    def set(self, *messages: ParameterMsg) -> list[SetParametersResult]:
        return list(self("set_parameters", parameters=list(messages)).results)


@contextmanager
def asking(**options: Any) -> Iterator[Asker]:
    with Context(transport="memory") as context, SingleThreadedExecutor(context=context) as executor:
        yield Asker(executor, Node("robot", namespace="/lab", context=context, **options))


@pytest.fixture
def ask() -> Iterator[Asker]:
    with asking() as asker:
        yield asker


def message(name: str, value: Any) -> ParameterMsg:
    return Parameter(name, value=value).to_parameter_msg()


def reasons(results: list[SetParametersResult]) -> list[str]:
    assert all(each.successful == (each.reason == "") for each in results)
    return [each.reason for each in results]


def test_every_node_serves_its_parameters_unless_told_not_to(context: Context) -> None:
    expected = [(f"/lab/robot/{name}", [each.__ros_type__]) for name, each in SERVICES.items()]
    description = ("/lab/robot/get_type_description", ["type_description_interfaces/srv/GetTypeDescription"])
    with Node("robot", namespace="/lab", context=context) as node:
        assert node.get_service_names_and_types_by_node("robot", "/lab") == sorted([*expected, description])
    with Node("robot", namespace="/lab", context=context, start_parameter_services=False) as node:
        assert node.get_service_names_and_types_by_node("robot", "/lab") == [description]


def test_they_follow_a_remapped_name(context: Context) -> None:
    arguments = ["--ros-args", "-r", "__node:=arm", "-r", "__ns:=/right"]
    with Node("robot", context=context, cli_args=arguments) as node:
        assert node.count_services("/right/arm/get_parameters") == 1


def test_what_is_declared_can_be_read_and_described(ask: Asker) -> None:
    ask.robot.declare_parameter("speed", 0.5, ParameterDescriptor(description="m/s"))
    ask.robot.declare_parameter("arm.ids", [1, 2])
    found = ask("get_parameters", names=["speed", "arm.ids"]).values
    assert [parameter_value_to_python(each) for each in found] == [0.5, [1, 2]]
    assert list(ask("get_parameter_types", names=["arm.ids", "speed"]).types) == [Type.INTEGER_ARRAY, Type.DOUBLE]
    (speed,) = ask("describe_parameters", names=["speed"]).descriptors
    assert (speed.name, speed.type, speed.description) == ("speed", Type.DOUBLE, "m/s")
    below = ask("list_parameters", prefixes=["arm"]).result
    assert (below.names, below.prefixes) == (["arm.ids"], ["arm"])


@pytest.mark.parametrize("name", ["get_parameters", "get_parameter_types", "describe_parameters"])
def test_one_unknown_name_empties_an_answer(ask: Asker, name: str) -> None:
    ask.robot.declare_parameter("speed", 0.5)
    answer = ask(name, names=["speed", "x" * 100_000, ""])
    assert not len(
        getattr(answer, {"get_parameters": "values", "get_parameter_types": "types"}.get(name, "descriptors"))
    )


def test_a_parameter_without_value_has_a_type_but_nothing_to_get(ask: Asker) -> None:
    ask.robot.declare_parameter("name", Type.STRING)
    assert list(ask("get_parameters", names=["name"]).values) == []
    assert ask("describe_parameters", names=["name"]).descriptors[0].type == Type.STRING
    assert list(ask("get_parameter_types", names=["name"]).types) == [Type.NOT_SET]


def test_each_is_set_or_refused_with_its_reason(ask: Asker) -> None:
    ask.robot.declare_parameter("speed", 0.5)
    ask.robot.declare_parameter("fixed", 1, ParameterDescriptor(read_only=True))
    ask.robot.declare_parameter("free", 1, ParameterDescriptor(dynamic_typing=True))
    told = ask.set(
        message("speed", 0.7),
        message("speed", "fast"),
        message("spede", 1.0),
        message("fixed", 2),
        message("speed", None),
        message("free", None),
        message("free", 1),
        message("", 1),
        ParameterMsg(name="speed", value=ParameterValue(type=77)),
    )
    assert reasons(told) == [
        "",
        "Wrong parameter type for 'speed': expected DOUBLE, got STRING",
        "Parameter not declared: spede (did you mean 'speed'?)",
        "Trying to set a read-only parameter: fixed.",
        "Static parameter cannot be undeclared",
        "",
        "Parameter not declared: free",
        "a parameter's name must not be empty",
        "77 is not a valid Parameter.Type",
    ]
    assert ask.robot.get_parameter("speed").value == 0.7


def test_atomically_sets_all_or_none(ask: Asker) -> None:
    ask.robot.declare_parameters("", [("a", 1), ("b", 2)])
    for parameters, taken in (
        ([("a", 5), ("b", "x")], False),
        ([("a", 5), ("c", 1)], False),
        ([("a", 5), ("b", 6)], True),
    ):
        before = [each.value for each in ask.robot.get_parameters(["a", "b"])]
        result = ask("set_parameters_atomically", parameters=[message(*each) for each in parameters]).result
        assert result.successful == taken == (result.reason == "")
        assert [each.value for each in ask.robot.get_parameters(["a", "b"])] == ([5, 6] if taken else before)


def test_a_callback_that_fails_is_answered_and_logged_and_the_node_lives(ask: Asker, log_lines: list[Record]) -> None:
    def check(parameters: list[Parameter[Any]]) -> SetParametersResult:
        if parameters[0].value == "boom":
            raise ZeroDivisionError("too much")
        return SetParametersResult(successful=parameters[0].value != "no", reason="I said so")

    ask.robot.declare_parameter("name", "a")
    ask.robot.add_on_set_parameters_callback(check)
    told = ask.set(message("name", "boom"), message("name", "no"), message("name", "b"))
    assert [(each.successful, each.reason) for each in told] == [
        (False, "a callback of the node's failed: ZeroDivisionError: too much"),
        (False, "I said so"),
        (True, ""),
    ]
    assert ask.robot.get_parameter("name").value == "b"
    (line,) = log_lines
    assert line.name == "lab.robot"
    assert line.message.endswith("ZeroDivisionError: too much")


@pytest.mark.usefixtures("log_lines")
def test_what_was_set_before_a_callback_failed_is_told_as_set(ask: Asker) -> None:
    def fail(parameters: list[Parameter[Any]]) -> None:
        raise ValueError("late")

    ask.robot.declare_parameter("name", "a")
    ask.robot.add_post_set_parameters_callback(fail)
    (told,) = ask.set(message("name", "b"))
    assert told.successful
    assert told.reason == "it was set, and then a callback of the node's failed: ValueError: late"
    assert ask.robot.get_parameter("name").value == "b"


@pytest.mark.parametrize("answer", [None, True, SetParametersResult(successful=False, reason=None)])  # type: ignore[arg-type]
@pytest.mark.usefixtures("log_lines")
def test_a_callback_that_answers_nonsense_does_not_end_the_node(ask: Asker, answer: Any) -> None:
    ask.robot.declare_parameter("name", "a")
    ask.robot.add_on_set_parameters_callback(lambda _: answer)
    (told,) = ask.set(message("name", "b"))
    assert not told.successful
    assert ask.robot.get_parameter("name").value == "a"


def test_as_many_as_one_request_may_name_are_answered(ask: Asker) -> None:
    ask.robot.declare_parameter("a.b.c", 1)
    many = [f"x{number}" for number in range(MOST_NAMES)]
    assert set(reasons(ask.set(*(message(each, 1) for each in many)))) == {
        f"Parameter not declared: {each}" for each in many
    }
    assert ask("list_parameters", prefixes=[*many[1:], "a"], depth=2**64 - 1).result.names == ["a.b.c"]
    assert ask("list_parameters", prefixes=[*many[1:], "a"], depth=1).result.names == []
    assert not len(ask("get_parameters", names=["y" * 300_000] * 10).values)
    assert len(ask("get_parameter_types", names=["a.b.c"] * MOST_NAMES).types) == MOST_NAMES


@pytest.mark.parametrize("name", ["get_parameters", "get_parameter_types", "describe_parameters", "list_parameters"])
def test_too_many_names_are_answered_with_nothing(ask: Asker, name: str, log_lines: list[Record]) -> None:
    ask.robot.declare_parameter("speed", 0.5)
    field = "prefixes" if name == "list_parameters" else "names"
    for names in (["speed"] * (MOST_NAMES + 1), ["x" * LARGEST]):
        assert ask(name, **{field: names}) == SERVICES[name].Response()
    told = [each.message for each in log_lines if "refused a request" in each.message]
    reason = "one request may name 10,000, this one names 10,001"
    assert told == [f"/lab/robot/{name}: refused a request: {reason} (the next ones are only counted)"]


@pytest.mark.usefixtures("log_lines")
def test_too_many_to_set_are_refused_with_the_reason_once(ask: Asker) -> None:
    ask.robot.declare_parameter("speed", 0.5)
    many = [message("speed", 0.7)] * (MOST_NAMES + 1)
    reason = "one request may name 10,000, this one names 10,001"
    assert reasons(ask.set(*many)) == [reason]
    assert reasons([ask("set_parameters_atomically", parameters=many).result]) == [reason]
    assert ask.robot.get_parameter("speed").value == 0.5
    assert reasons(ask.set(message("speed", "x" * LARGEST)))[0].startswith("one request may have 3,145,728 bytes")


@given(st.binary(max_size=12))
def test_any_payload_is_looked_at(payload: bytes) -> None:
    assert why_refused(payload) == "" or len(payload) > 4


def test_undeclared_parameters_where_they_are_allowed() -> None:
    with asking(allow_undeclared_parameters=True) as ask:
        assert [each.type for each in ask("get_parameters", names=["new"]).values] == [Type.NOT_SET]
        assert reasons(ask.set(message("new", 1), message("", 1), message("new", "x"))) == [
            "",
            "a parameter's name must not be empty",
            "",
        ]
        assert ask.robot.get_parameter("new").value == "x"


# --- whatever is asked, the node is what a plain dict says ------------------------------------------------------

NAMES = st.sampled_from(["a", "b", "a.b", "c"])
VALUES = st.sampled_from([None, True, 3, -1, 2.5, "text", [1, 2], ["x"], [b"\x01"]])
STEPS = st.lists(
    st.tuples(st.sampled_from(["declare", "declare any", "undeclare", "set", "ask", "ask all"]), NAMES, VALUES),
    max_size=12,
)


class Model:
    """What parameters are: each with its value, and whether its type may change."""

    def __init__(self) -> None:
        self.values: dict[str, Any] = {}
        self.dynamic: dict[str, bool] = {}

    def declare(self, name: str, value: Any, dynamic: bool) -> bool:
        if name in self.values or (value is None and not dynamic):
            return False
        self.values[name], self.dynamic[name] = value, dynamic
        return True

    def undeclare(self, name: str) -> bool:
        return self.values.pop(name, self) is not self

    def set(self, name: str, value: Any) -> bool:
        if name not in self.values:
            return False
        if value is None:
            return self.dynamic[name] and self.undeclare(name)
        before = Type.from_parameter_value(self.values[name])
        if not self.dynamic[name] and Type.from_parameter_value(value) is not before:
            return False
        self.values[name] = value
        return True


def act(ask: Asker, step: str, name: str, value: Any) -> bool:
    """Do it to the node; whether it was taken."""
    robot = ask.robot
    try:
        if step.startswith("declare"):
            robot.declare_parameter(name, value, ParameterDescriptor(dynamic_typing=step == "declare any"))
        elif step == "undeclare":
            robot.undeclare_parameter(name)
        elif step == "set":
            return robot.set_parameters([Parameter(name, value=value)])[0].successful
        elif step == "ask":
            return ask.set(message(name, value))[0].successful
        else:
            both = [message(name, value), message("always", 1)]
            return bool(ask("set_parameters_atomically", parameters=both).result.successful)
    except (ParameterAlreadyDeclaredException, ParameterNotDeclaredException, ValueError):
        return False
    return True


def plain(value: Any) -> Any:
    return list(value) if isinstance(value, array) else value


def expected(model: Model, step: str, name: str, value: Any) -> bool:
    if step.startswith("declare"):
        return model.declare(name, value, step == "declare any")
    return model.undeclare(name) if step == "undeclare" else model.set(name, value)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(STEPS)
def test_node_and_services_agree_with_a_dict(steps: list[tuple[str, str, Any]]) -> None:
    with asking(parameter_overrides=[]) as ask:
        ask.robot.declare_parameter("always", 1)
        model = Model()
        own = {"always", "use_sim_time", "start_type_description_service"}
        for step, name, value in steps:
            assert act(ask, step, name, value) == expected(model, step, name, value), step
            assert set(ask("list_parameters").result.names) == model.values.keys() | own
            names = sorted(model.values)
            values = [model.values[each] for each in names]
            assert [parameter_value_to_python(each) for each in ask("get_parameters", names=names).values] == values
            assert [plain(ask.robot.get_parameter(each).value) for each in names] == values
