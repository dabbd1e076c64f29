"""The parameters of a node, bare and real: declared, read, listed, overridden from outside, told about."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.exceptions import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    ParameterDescriptor,
    ParameterEvent,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from robolink.parameter import Parameter
from tests.support.parameter_nodes import Make, made, makes
from tests.support.spins import spin_until

Type = Parameter.Type


@pytest.fixture
def make() -> Iterator[Make]:
    with makes() as make:
        yield make


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context(transport="memory")
    context.init([])
    yield context
    context.try_shutdown()


# Declaring


def test_declaring_gives_the_parameter_as_it_is(make: Make) -> None:
    node = make()
    speed = node.declare_parameter("speed", 0.5)
    assert (speed.name, speed.type_, speed.value) == ("speed", Type.DOUBLE, 0.5)
    assert node.get_parameter("speed") is speed
    node.set_parameters([made("speed", 0.7)])
    assert speed.value == 0.5
    assert node.get_parameter("speed").value == 0.7
    [declared] = node.declare_parameters("", [("names", ["a"])])
    assert declared.type_ is Type.STRING_ARRAY


def test_an_override_goes_before_the_default_unless_it_is_ignored(make: Make) -> None:
    node = make({"speed": 0.9, "arm.reach": 2})
    assert node.declare_parameter("speed", 0.5).value == 0.9
    assert node.declare_parameters("arm", [("reach", 1), ("name", "left")])[0].value == 2
    node.undeclare_parameter("speed")
    assert node.declare_parameter("speed", 0.5, ignore_override=True).value == 0.5
    assert node.get_parameter("arm.name").value == "left"


def test_overrides_can_declare_all_that_they_name(make: Make) -> None:
    node = make({"speed": 0.9, "arm.reach": 2}, declare_all=True)
    assert node.get_parameter("speed").value == 0.9
    assert node.describe_parameter("arm.reach").type == ParameterType.PARAMETER_INTEGER
    with pytest.raises(ParameterAlreadyDeclaredException, match="speed"):
        node.declare_parameter("speed", 0.5)


def test_an_override_of_another_type_is_refused(make: Make) -> None:
    node = make({"speed": 1, "limit": "high", "route": 0x10})
    told = r"'speed' to '1' of type 'INTEGER', expecting type 'DOUBLE': write 1\.0"
    with pytest.raises(InvalidParameterTypeException, match=told):
        node.declare_parameter("speed", 0.5)
    assert not node.has_parameter("speed")
    with pytest.raises(InvalidParameterTypeException, match=r"expecting type 'STRING': .* needs quotes"):
        node.declare_parameter("route", "0x10")
    dynamic = ParameterDescriptor(dynamic_typing=True)
    limit: Parameter[Any] = node.declare_parameter("limit", 5, dynamic)
    assert limit.value == "high"
    assert node.describe_parameter("limit").type == ParameterType.PARAMETER_STRING


def test_an_empty_list_as_override_is_an_array_of_the_declared_type(make: Make) -> None:
    node = make({"names": [], "speed": []})
    names = node.declare_parameter("names", ["a", "b"])
    assert (names.type_, names.value) == (Type.STRING_ARRAY, [])
    with pytest.raises(InvalidParameterTypeException, match="BYTE_ARRAY"):
        node.declare_parameter("speed", 0.5)


def test_a_type_alone_leaves_a_parameter_without_value_until_it_is_set(make: Make) -> None:
    node = make({"given": 3})
    assert node.declare_parameter("given", Type.INTEGER).value == 3
    assert node.declare_parameter("count", Type.INTEGER).type_ is Type.NOT_SET
    with pytest.raises(ParameterUninitializedException, match="count"):
        node.get_parameter("count")
    fallback = made("other", 8)
    assert node.get_parameter_or("count", fallback) is fallback
    assert node.get_parameter_type("count") is Type.NOT_SET
    assert not node.set_parameters([made("count", "three")])[0].successful
    assert node.set_parameters([made("count", 3)])[0].successful
    assert node.get_parameter("count").value == 3


def test_a_name_alone_is_dynamic_and_warned_about_where_it_stands(make: Make) -> None:
    node = make()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert node.declare_parameter("thing").value is None
        node.declare_parameters("", [("other",)])
    assert [each.category for each in caught] == [UserWarning, UserWarning]
    assert {each.filename for each in caught} == {__file__}
    assert "'thing'" in str(caught[0].message)
    assert node.get_parameter("thing").type_ is Type.NOT_SET
    assert node.set_parameters([made("thing", 1)])[0].successful
    assert node.set_parameters([made("thing", "one")])[0].successful


@pytest.mark.parametrize(
    ("entry", "error", "text"),
    [
        (("x", None, ParameterDescriptor()), ValueError, "'x' has neither value nor type"),
        (("x", Type.NOT_SET), ValueError, "'x' has neither value nor type"),
        (("x", Type.DOUBLE, ParameterDescriptor(dynamic_typing=True)), ValueError, "exclude each other"),
        (("x", ParameterValue()), ValueError, "neither value nor type"),
        (("x", ParameterValue(type=ParameterType.PARAMETER_BOOL)), ValueError, "ParameterValue is not a default"),
        (("x", {"a": 1}), TypeError, "parameter 'x': "),
        (("x", [1, 2.0]), TypeError, "parameter 'x': "),
        (("x", 1, ParameterValue()), TypeError, "'x': expected a ParameterDescriptor"),
        ((1, 1), TypeError, "declaration 1: the name must be a str, got 1"),
        ((), TypeError, "expected a tuple"),
        (("x", 1, ParameterDescriptor(), 4), TypeError, "expected a tuple"),
        ("ab", TypeError, "expected a tuple"),
        (("", 1), InvalidParameterException, "Invalid parameter name"),
    ],
)
def test_a_declaration_that_cannot_be_read_declares_nothing(
    make: Make, entry: Any, error: type[Exception], text: str
) -> None:
    node = make()
    with pytest.raises(error, match=text):
        node.declare_parameters("", [("first", 1), entry])
    assert not node.has_parameter("first")


def test_declaring_twice_names_those_that_are_taken_and_declares_none(make: Make) -> None:
    node = make()
    node.declare_parameters("", [("a", 1), ("b", 2)])
    with pytest.raises(ParameterAlreadyDeclaredException, match=r"\['b', 'a'\]"):
        node.declare_parameters("", [("new", 0), ("b", 2), ("a", 1)])
    assert not node.has_parameter("new")


def test_when_a_callback_refuses_one_those_before_it_stay_declared(make: Make) -> None:
    node = make()
    node.add_on_set_parameters_callback(
        lambda them: SetParametersResult(successful=them[0].name != "bad", reason="not that one")
    )
    with pytest.raises(InvalidParameterValueException, match="not that one"):
        node.declare_parameters("", [("good", 1), ("bad", 2), ("late", 3)])
    assert [node.has_parameter(each) for each in ("good", "bad", "late")] == [True, False, False]


def test_a_descriptor_may_serve_several_parameters(make: Make) -> None:
    node, shared = make(), ParameterDescriptor(description="as seen from above")
    node.declare_parameters("", [("width", 1.5, shared), ("count", 2, shared)])
    width, count = node.describe_parameters(["width", "count"])
    assert (width.name, width.type) == ("width", ParameterType.PARAMETER_DOUBLE)
    assert (count.name, count.type) == ("count", ParameterType.PARAMETER_INTEGER)
    assert width.description == count.description == shared.description
    assert shared == ParameterDescriptor(description="as seen from above")


def test_undeclaring_forgets_value_and_descriptor(make: Make) -> None:
    node = make()
    node.declare_parameters("", [("a", 1), ("fixed", 2, ParameterDescriptor(read_only=True))])
    node.events.clear()
    node.undeclare_parameter("a")
    assert not node.has_parameter("a")
    with pytest.raises(ParameterNotDeclaredException):
        node.describe_parameter("a")
    with pytest.raises(ParameterNotDeclaredException):
        node.undeclare_parameter("a")
    with pytest.raises(ParameterImmutableException, match="fixed"):
        node.undeclare_parameter("fixed")
    assert node.get_parameter("fixed").value == 2
    assert node.events == []


# Reading


def test_an_unknown_name_is_answered_with_the_nearest(make: Make) -> None:
    node = make()
    node.declare_parameters("", [("stop_distance", 1.0), ("speed", 1.0)])
    for ask in (node.get_parameter, node.get_parameter_type, node.describe_parameter, node.undeclare_parameter):
        with pytest.raises(ParameterNotDeclaredException, match=r"stop_distanc \(did you mean 'stop_distance'\?\)"):
            ask("stop_distanc")
    with pytest.raises(ParameterNotDeclaredException) as caught:
        node.set_parameters_atomically([made("sped", 1.0), made("speed", 1.0), made("qqq", 1.0)])
    assert caught.value.parameters == ["sped", "qqq"]
    assert "sped (did you mean 'speed'?), qqq" in str(caught.value)
    assert isinstance(caught.value, LookupError)


def test_several_are_read_by_name_prefix_and_type(make: Make) -> None:
    node = make()
    node.declare_parameters("pid", [("p", 1.0), ("i", 2)])
    node.declare_parameter("pidgin", "no")
    assert [each.value for each in node.get_parameters(["pid.i", "pid.p"])] == [2, 1.0]
    assert node.get_parameter_types(["pid.p", "pid.i"]) == [Type.DOUBLE, Type.INTEGER]
    assert {name: each.value for name, each in node.get_parameters_by_prefix("pid").items()} == {"p": 1.0, "i": 2}
    assert {"pid.p", "pid.i", "pidgin"} <= set(node.get_parameters_by_prefix(""))
    assert node.get_parameters_by_prefix("pi") == {}
    wrong: list[Any] = [["pid.p", 1], [None]]
    for names in wrong:
        with pytest.raises(TypeError, match="must be a str"):
            node.get_parameters(names)
        with pytest.raises(TypeError, match="must be a str"):
            node.get_parameter_types(names)


def test_an_alternative_stands_in_for_what_is_not_declared(make: Make) -> None:
    node = make()
    alternative = made("anything", 5)
    assert node.get_parameter_or("speed", alternative) is alternative
    missing = node.get_parameter_or("speed")
    assert (missing.name, missing.type_) == ("speed", Type.NOT_SET)
    declared = node.declare_parameter("speed", 1.0)
    assert node.get_parameter_or("speed", alternative) is declared


@pytest.mark.parametrize(
    ("prefixes", "depth", "names"),
    [
        ([], 0, ["a", "b.c", "b.d.e", "bb.f"]),
        ([], 1, ["a"]),
        ([], 2, ["a", "b.c", "bb.f"]),
        (["b"], 0, ["b.c", "b.d.e"]),
        (["b"], 1, ["b.c"]),
        (["a", "b.d"], 1, ["a", "b.d.e"]),
        (["b.c.x", "c"], 0, []),
    ],
)
def test_listing_filters_by_prefix_and_depth(make: Make, prefixes: list[str], depth: int, names: list[str]) -> None:
    node = make()
    node.declare_parameters("", [(name, 1) for name in ("a", "b.c", "b.d.e", "bb.f")])
    result = node.list_parameters(prefixes, depth)
    # A node has some of its own, such as use_sim_time.
    listed = [name for name in result.names if "_" not in name]
    assert listed == names
    assert result.prefixes == list(dict.fromkeys(name.rpartition(".")[0] for name in names if "." in name))


@pytest.mark.parametrize(
    ("prefixes", "depth", "error"),
    [("b", 0, TypeError), ([1], 0, TypeError), ([], 1.5, TypeError), ([], -1, ValueError)],
)
def test_listing_refuses_arguments_of_another_kind(
    make: Make, prefixes: Any, depth: Any, error: type[Exception]
) -> None:
    with pytest.raises(error):
        make().list_parameters(prefixes, depth)


# The node around it


def test_a_command_line_overrides_what_a_node_declares(context: Context) -> None:
    args = ["--ros-args", "-p", "speed:=0.9", "-p", "other:gain:=2.0", "-p", "names:=[a, b]"]
    node = Node("driver", context=context, cli_args=args, parameter_overrides=[made("mode", "fast")])
    assert node.declare_parameter("speed", 0.5).value == 0.9
    assert node.declare_parameter("names", ["x"]).value == ["a", "b"]
    assert node.declare_parameter("mode", "slow").value == "fast"
    assert node.declare_parameter("gain", 1.0).value == 1.0
    node.destroy_node()


WRITTEN = {"speed": "1", "gains": "[1, 2]", "count": "1", "any": "1", "name": "1", "is_on": "1"}
LINES = [word for name, value in WRITTEN.items() for word in ("-p", f"{name}:={value}")]
FILE = f"/driver: {{ros__parameters: {{{', '.join(f'{name}: {value}' for name, value in WRITTEN.items())}}}}}"


@pytest.mark.parametrize("is_file", [False, True])
def test_an_integer_that_is_written_serves_as_a_double_and_as_nothing_else(
    context: Context, tmp_path: Path, is_file: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "driver.yaml").write_text(FILE)
    args = ["--params-file", str(tmp_path / "driver.yaml")] if is_file else LINES
    with Node("driver", context=context, cli_args=["--ros-args", *args]) as node:
        limits = FloatingPointRange(from_value=0.0, to_value=2.0)
        declared = [
            node.declare_parameter("speed", 0.5, ParameterDescriptor(floating_point_range=[limits])),
            node.declare_parameter("gains", Type.DOUBLE_ARRAY),
            node.declare_parameter("count", 5),
            node.declare_parameter("any", 0.5, ParameterDescriptor(dynamic_typing=True)),
        ]
        expected = [(Type.DOUBLE, "1.0"), (Type.DOUBLE_ARRAY, "[1.0, 2.0]"), (Type.INTEGER, "1"), (Type.INTEGER, "1")]
        assert [(each.type_, repr(each.value)) for each in declared] == expected
        for name, default in (("name", "x"), ("is_on", True)):
            with pytest.raises(InvalidParameterTypeException, match="of type 'INTEGER'"):
                node.declare_parameter(name, default)
        assert not node.set_parameters([made("speed", 2)])[0].successful
    told = capsys.readouterr().err
    assert "'speed' is a DOUBLE and was given 1: ROS 2 refuses integers for it, so write 1.0" in told
    assert "'gains' is a DOUBLE_ARRAY and was given [1, 2]" in told
    assert told.count("ROS 2 refuses") == 2


def test_an_empty_list_that_is_written_is_told(context: Context, capsys: pytest.CaptureFixture[str]) -> None:
    with Node("driver", context=context, cli_args=["--ros-args", "-p", "names:=[]"]) as node:
        assert node.declare_parameter("names", ["a"]).value == []
    assert "'names' was given an empty list: in ROS 2 it has no value then" in capsys.readouterr().err


def test_an_integer_that_a_program_gives_is_one(context: Context) -> None:
    written = ["--ros-args", "-p", "speed:=2"]
    given = [made("speed", 1)]
    with (
        Node("driver", context=context, cli_args=written, parameter_overrides=given) as node,
        pytest.raises(InvalidParameterTypeException, match="expecting type 'DOUBLE'"),
    ):
        node.declare_parameter("speed", 0.5)


def test_changes_are_published_on_parameter_events(context: Context) -> None:
    node, listener = Node("driver", context=context), Node("listener", context=context)
    heard: list[ParameterEvent] = []
    listener.create_subscription(ParameterEvent, "/parameter_events", heard.append, 10)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(listener)
    node.declare_parameter("speed", 0.5)
    node.set_parameters([made("speed", 0.7)])
    spin_until(executor, lambda: len(heard) == 2)
    assert [each.node for each in heard] == ["/driver", "/driver"]
    assert heard[0].new_parameters[0].name == "speed"
    assert heard[1].changed_parameters[0].value.double_value == 0.7
    executor.shutdown()
