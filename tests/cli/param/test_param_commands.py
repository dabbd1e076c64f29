"""param list, get, describe, dump, set, load and delete: ros2's output, and what cannot be asked or set."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node, Parameter
from robolink.arguments.parameter_file import parse_parameter_file
from robolink.cli.main import main
from robolink.cli.param import each_with_its_flag, verbs
from robolink.cli.param.values import as_file, fitting, nested, read
from robolink.cli.shared import complete
from robolink.interfaces.rcl_interfaces.msg import (
    ParameterDescriptor,
    SetParametersResult,
)
from robolink.interfaces.rcl_interfaces.srv import SetParameters
from robolink.parameter import parameter_value_to_python
from tests.support.commands import BUSY_ROBOLINK, Command
from tests.support.dumped import DUMPED
from tests.support.programs import Program
from tests.support.seen_by_commands import spinning

Captured = pytest.CaptureFixture[str]
Type = Parameter.Type
DYNAMIC = ParameterDescriptor(dynamic_typing=True)


# --- set, load, delete --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "text", "value", "note"),
    [
        ("speed", "1.5", 1.5, ""),
        ("speed", "1", 1.0, "speed is of type double; ros2 takes 1 for one of type integer"),
        ("name", "123", "123", "name is of type string; ros2 takes 123 for one of type integer"),
        ("name", "'quoted'", "quoted", ""),
        ("name", "{a: 1}", "{a: 1}", ""),
        (
            "gains",
            "[1, 2]",
            [1.0, 2.0],
            "gains is of type double array; ros2 takes [1, 2] for one of type integer array",
        ),
        ("gains", "[]", [], "gains is of type double array; ros2 takes [] for one of type boolean array"),
        ("free", "-0.5", -0.5, ""),
        ("free", "-3", -3, ""),
        ("free", "[a, b]", ["a", "b"], ""),
        ("odd..", "no", False, ""),
    ],
)
def test_a_value_is_set_in_the_parameters_own_type(
    driver: Node, name: str, text: str, value: Any, note: str, capsys: Captured
) -> None:
    assert main(["param", "set", "/lab/driver", name, text]) == 0
    told = f"note: {note} and refuses it\n" if note else ""
    assert capsys.readouterr() == ("Set parameter successful\n", told)
    assert parameter_value_to_python(driver.get_parameter(name).get_parameter_value()) == value


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["speed", "5.0"], "parameter 'speed' out of range: 5.0 is not within 0.0 to 2.0"),
        (["speed", "fast"], "Wrong parameter type for 'speed': expected DOUBLE, got STRING"),
        (["spede", "1.0"], "Parameter not declared: spede (did you mean 'speed'?)"),
        (["arm.length", "4"], "Trying to set a read-only parameter: arm.length."),
        (["name", "no"], r"not\n\x1b[31mthis"),
    ],
)
def test_a_refusal_is_one_line_with_its_reason(driver: Node, words: list[str], reason: str, capsys: Captured) -> None:
    def check(parameters: list[Parameter[Any]]) -> SetParametersResult:
        return SetParametersResult(successful=parameters[0].value != "no", reason=r"not\n" + "\x1b[31mthis")

    driver.add_on_set_parameters_callback(check)
    before = driver.get_parameters_by_prefix("")
    assert main(["param", "set", "/lab/driver", *words]) == 1
    assert capsys.readouterr() == ("", f"robolink: Setting parameter failed: {reason}\n")
    assert driver.get_parameters_by_prefix("") == before
    assert main(["param", "set", "/lab/driver", *words, "--json"]) == 1
    assert not json.loads(capsys.readouterr().out)["successful"]


def test_a_dump_can_be_loaded_again(driver: Node, tmp_path: Path, capsys: Captured) -> None:
    file = tmp_path / "driver.yaml"
    file.write_text(DUMPED.replace("speed: 1.0", "speed: 2"))
    driver.undeclare_parameter("free")
    driver.declare_parameter("free", "other", DYNAMIC)
    assert main(["param", "load", "/lab/driver", str(file)]) == 0
    said, told = capsys.readouterr()
    assert told == "note: speed is of type double; ros2 takes 2 for one of type integer and refuses it\n"
    assert "Set parameter speed successful\n" in said
    assert "Set parameter arm.length successful: it is read-only and has this value already\n" in said
    assert [each.value for each in driver.get_parameters(["speed", "free", "name"])] == [2.0, 1, "1e3"]


FILE = """
/**: {ros__parameters: {speed: 0.5, name: all}}
/lab/driver: {ros__parameters: {name: mine, arm: {length: 4}}}
/lab/other: {ros__parameters: {free: 99}}
"""


@pytest.mark.parametrize(("options", "speed"), [([], 0.5), (["--no-use-wildcard"], 1.0)])
def test_a_file_is_loaded_for_this_node_and_each_refusal_told(
    driver: Node, options: list[str], speed: float, tmp_path: Path, capsys: Captured
) -> None:
    file = tmp_path / "params.yaml"
    file.write_text(FILE)
    assert main(["param", "load", "/lab/driver", str(file), *options]) == 1
    said, told = capsys.readouterr()
    assert told == "robolink: Set parameter arm.length failed: Trying to set a read-only parameter: arm.length.\n"
    assert "Set parameter name successful\n" in said
    assert [each.value for each in driver.get_parameters(["speed", "name", "free"])] == [speed, "mine", 1]
    assert main(["param", "load", "/lab/driver", str(file), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["name"] == {"successful": True, "reason": ""}


def test_a_file_of_one_other_node_is_loaded_and_of_two_is_not(driver: Node, tmp_path: Path, capsys: Captured) -> None:
    file = tmp_path / "params.yaml"
    file.write_text("/one: {ros__parameters: {speed: 1.5}}")
    assert main(["param", "load", "/lab/driver", str(file)]) == 0
    assert driver.get_parameter("speed").value == 1.5
    file.write_text("/one: {ros__parameters: {speed: 0.5}}\n/two: {ros__parameters: {speed: 0.5}}")
    capsys.readouterr()
    assert main(["param", "load", "/lab/driver", str(file)]) == 1
    assert capsys.readouterr() == ("", f"robolink: {file}: no parameters for /lab/driver: it has /one, /two\n")


def test_dynamic_parameters_can_be_deleted(driver: Node, capsys: Captured) -> None:
    assert main(["param", "delete", "/lab/driver", "free"]) == 0
    assert capsys.readouterr() == ("Deleted parameter successfully\n", "")
    assert not driver.has_parameter("free")
    assert main(["param", "delete", "/lab/driver", "speed"]) == 1
    told = "robolink: Deleting parameter failed: Static parameter cannot be undeclared\n"
    assert capsys.readouterr() == ("", told)


# --- what cannot be asked -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["get", "/lab/driver", "sped"], "no parameter named 'sped' in /lab/driver (did you mean 'speed'?)"),
        (["describe", "/lab/driver", "speed", "x\n"], r"no parameter named 'x\n' in /lab/driver"),
        (["get", "/lab/driver", "unset"], "'unset' of /lab/driver: Parameter not set"),
        (["list", "/lab/drivr"], "no node named '/lab/drivr' in domain 7 (did you mean '/lab/driver'?)"),
        (["dump", "/lab/robot", "--timeout", "0"], "/lab/robot has no parameter services: it was made without them"),
        (["set", "/../..", "a", "1", "--timeout", "0"], "no node named '/../..' in domain 7"),
        (["load", "/lab/driver", "/no/such.yaml"], "no file '/no/such.yaml'"),
    ],
)
@pytest.mark.usefixtures("driver")
def test_what_is_not_there_is_one_line(words: list[str], told: str, capsys: Captured) -> None:
    assert main(["param", *words]) == 1
    said, line = capsys.readouterr()
    assert (said, line.startswith(f"robolink: {told}"), line.count("\n")) == ("", True, 1), line


def test_a_server_that_has_gone_is_told_at_once(robot: Node, capsys: Captured) -> None:
    robot.create_service(SetParameters, "robot/set_parameters", lambda request, response: response)  # and no other
    assert main(["param", "get", "/lab/robot", "a"]) == 1
    assert capsys.readouterr() == (
        "",
        "robolink: service /lab/robot/get_parameters: nobody serves it, or the server went away\n",
    )


@pytest.mark.parametrize(
    "words",
    [
        ["list", "--filter", "("],
        ["get", "/lab/driver"],
        ["get"],
        ["set", "/lab/driver", "speed"],
        ["set", "/lab/driver", "speed", "1", "name"],
        ["set", "/lab/driver", "speed", "1", "--timeut", "3"],
        ["get", "/lab/driver", "speed", "--timeout", "-1"],
        ["describe", "/lab/driver"],
        ["gte"],
    ],
)
@pytest.mark.usefixtures("robot")
def test_wrong_usage_is_one_line_and_2(words: list[str], capsys: Captured) -> None:
    assert main(["param", *words]) == 2
    said, told = capsys.readouterr()
    assert (said, told.count("\n")) == ("", 1)


@pytest.mark.usefixtures("driver")
def test_several_values_of_a_node_are_shown_under_their_names(capsys: Captured) -> None:
    assert main(["param", "get", "/lab/driver", "speed", "arm.length"]) == 0
    assert capsys.readouterr() == ("speed:\n  Double value is: 1.0\narm.length:\n  Integer value is: 3\n", "")
    assert main(["param", "get", "/lab/driver", "speed", "name", "--json"]) == 0
    assert [each["name"] for each in json.loads(capsys.readouterr().out)] == ["speed", "name"]


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        (["speed"], "/lab/driver:\n  Double value is: 1.0\n/other:\n  Integer value is: 7\n"),
        (["speed", "--hide-type"], "/lab/driver:\n  1.0\n/other:\n  7\n"),
        (["name"], "/lab/driver:\n  String value is: 1e3\n"),
        (["sped"], "Parameter 'sped' not set on any node\n"),
        (["unset"], "Parameter 'unset' not set on any node\n"),
    ],
)
def test_a_parameter_of_all_nodes(driver: Node, words: list[str], shown: str, capsys: Captured) -> None:
    other = Node("other", context=driver.context)
    other.declare_parameter("speed", 7)
    with spinning(other):
        assert main(["param", "get", *words]) == 0
    assert capsys.readouterr() == (shown, "")


def test_several_parameters_are_set(driver: Node, capsys: Captured) -> None:
    assert main(["param", "set", "/lab/driver", "speed", "0.5", "free", "-3"]) == 0
    assert capsys.readouterr() == ("speed: Set parameter successful\nfree: Set parameter successful\n", "")
    assert (driver.get_parameter("speed").value, driver.get_parameter("free").value) == (0.5, -3)
    assert main(["param", "set", "/lab/driver", "arm.length", "4", "speed", "1.5", "--json"]) == 1
    results = json.loads(capsys.readouterr().out)
    assert {name: each["successful"] for name, each in results.items()} == {"arm.length": False, "speed": True}
    assert driver.get_parameter("speed").value == 1.5


def test_the_node_is_waited_for(robot: Node, capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    looked, done = threading.Event(), threading.Event()
    served = verbs.serves

    def serves(*args: Any) -> bool:
        looked.set()
        return served(*args)

    def come() -> None:
        looked.wait()
        with spinning(Node("late", context=robot.context)):
            done.wait()

    monkeypatch.setattr(verbs, "serves", serves)
    thread = threading.Thread(target=come)
    thread.start()
    try:
        assert main(["param", "get", "/late", "use_sim_time", "--timeout", "5"]) == 0
    finally:
        done.set()
        thread.join()
    assert capsys.readouterr().out == "Boolean value is: False\n"


# --- completion ---------------------------------------------------------------------------------------------------


class Typed:
    """What is on the command line so far."""

    def __init__(self, node: str) -> None:
        self.params = {"node": node}


@pytest.mark.usefixtures("driver")
def test_names_are_completed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.cli.param.verbs.WITHIN", 5.0)
    assert verbs.of_node(Typed("/lab/driver"), "s") == ["speed", "start_type_description_service"]
    assert verbs.of_node(Typed("lab/driver"), "arm.") == ["arm.ids", "arm.length"]
    assert verbs.of_node(Typed("/nobody"), "") == []
    assert verbs.of_node(Typed(""), "") == []
    assert complete.node_names("/lab/d") == ["/lab/driver"]


# --- pure ---------------------------------------------------------------------------------------------------------


def test_each_word_behind_the_flag_gets_its_own() -> None:
    assert each_with_its_flag(["--param-prefixes", "a", "b", "--json", "c"]) == [
        *["--param-prefixes", "a", "--param-prefixes", "b"],
        "--json",
        "c",
    ]


@given(st.text(max_size=10), st.sampled_from([*Type, 77]), st.booleans())
def test_any_text_is_some_value(text: str, type_: int, dynamic: bool) -> None:
    assert read(text, ParameterDescriptor(type=type_, dynamic_typing=dynamic)).type in list(Type)


def test_bytes_are_typed_as_numbers() -> None:
    described = ParameterDescriptor(type=Type.BYTE_ARRAY)
    assert parameter_value_to_python(read("[1, 255]", described)) == [b"\x01", b"\xff"]
    assert fitting([1, 256], described).type == Type.INTEGER_ARRAY


PARTS = st.text(st.characters(codec="utf-8", exclude_characters=".\0"), max_size=4)
SCALARS = st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False) | st.text(max_size=8)


@given(
    st.dictionaries(
        st.lists(PARTS, min_size=1, max_size=3).map(".".join).filter(bool),
        SCALARS | st.lists(st.integers(-9, 9), max_size=3) | st.lists(st.text(max_size=4), max_size=3),
        min_size=1,
        max_size=6,
    )
)
def test_a_dump_gives_back_what_it_was_made_of(values: dict[str, Any]) -> None:
    text = as_file("/lab/driver", values)
    assert {each.name: each.value for each in parse_parameter_file(text, "dump")} == values


def test_a_parameter_above_others_stays_beside_them() -> None:
    assert nested({"a": 1, "a.b": 2, "c.d": 3}) == {"a": 1, "a.b": 2, "c": {"d": 3}}


# --- processes ----------------------------------------------------------------------------------------------------

PROGRAM = """
    import robolink

    class Driver(robolink.Node):
        def __init__(self) -> None:
            super().__init__("driver")
            self.declare_parameter("speed", 0.5)
            self.add_post_set_parameters_callback(lambda given: print(given[0].value))

    with robolink.init():
        node = Driver()
        print("ready")
        robolink.spin(node)
"""


@pytest.mark.processes
def test_a_process_sets_a_parameter_of_another(tmp_path: Path, domain: int) -> None:
    with Program(tmp_path, PROGRAM, domain) as program:
        assert program.line() == "ready"
        with Command(domain, "param", "set", "/driver", "speed", "2", program=BUSY_ROBOLINK) as command:
            assert command.end() == 0
            assert [each.text for each in command.lines] == ["Set parameter successful"]
        assert program.line() == "2.0"
