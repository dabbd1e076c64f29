"""param list, get, describe and dump: ros2's output."""

from __future__ import annotations

import json

import pytest

from robolink import Node
from robolink.cli.main import main
from robolink.cli.param import verbs
from tests.support.dumped import DUMPED
from tests.support.seen_by_commands import spinning

Captured = pytest.CaptureFixture[str]


NAMES = [
    "arm.ids",
    "arm.length",
    "free",
    "gains",
    "name",
    "odd..",
    "speed",
    "start_type_description_service",
    "unset",
    "use_sim_time",
]


@pytest.mark.parametrize(
    ("options", "lines"),
    [
        ([], ["/lab/driver:", *(f"  {each}" for each in NAMES)]),
        (["/lab/driver"], [f"  {each}" for each in NAMES]),
        (["lab/driver", "--filter", "s"], ["  speed", "  start_type_description_service"]),
        (["/lab/driver", "--param-prefixes", "arm", "gains"], ["  arm.ids", "  arm.length", "  gains"]),
        (
            ["/lab/driver", "--param-type", "--filter", "(gains|odd|unset)"],
            ["  gains (type: double array)", "  odd.. (type: boolean)", "  unset (type: string)"],
        ),
        (["--filter", "nothing"], []),
    ],
)
@pytest.mark.usefixtures("driver")
def test_parameters_are_listed_as_ros2_lists_them(options: list[str], lines: list[str], capsys: Captured) -> None:
    assert main(["param", "list", *options]) == 0
    assert capsys.readouterr() == ("".join(f"{each}\n" for each in lines), "")


@pytest.mark.usefixtures("driver")
def test_hidden_nodes_are_listed_when_asked(robot: Node, capsys: Captured) -> None:
    with spinning(Node("_quiet", context=robot.context)):
        assert main(["param", "list"]) == 0
        assert "/_quiet" not in capsys.readouterr().out
        assert main(["param", "list", "--include-hidden-nodes", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert listed == {"/_quiet": ["start_type_description_service", "use_sim_time"], "/lab/driver": NAMES}


def test_a_node_that_does_not_answer_is_told_of_and_the_others_are_listed(
    driver: Node, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    Node("silent", context=driver.context)  # nobody spins it
    monkeypatch.setattr(verbs, "ANSWER_WITHIN", 0.2)
    assert main(["param", "list", "--filter", "speed"]) == 0
    said, told = capsys.readouterr()
    assert said == "/lab/driver:\n  speed\n"
    assert told.startswith("robolink: /silent: no answer within 0.2 s from /silent/list_parameters")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("speed", "Double value is: 1.0"),
        ("name", "String value is: 1e3"),
        ("arm.length", "Integer value is: 3"),
        ("arm.ids", "Integer values are: [1, 2]"),
        ("gains", "Double values are: [1.0, 2.5]"),
        ("odd..", "Boolean value is: True"),
    ],
)
@pytest.mark.usefixtures("driver")
def test_a_value_is_shown_as_ros2_shows_it(name: str, said: str, capsys: Captured) -> None:
    assert main(["param", "get", "/lab/driver", name]) == 0
    assert capsys.readouterr() == (said + "\n", "")
    assert main(["param", "get", "lab/driver", name, "--hide-type"]) == 0
    assert capsys.readouterr() == (said.partition(": ")[2] + "\n", "")


@pytest.mark.usefixtures("driver")
def test_values_are_json_for_programs(capsys: Captured) -> None:
    assert main(["param", "get", "/lab/driver", "gains", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"name": "gains", "type": "double array", "value": [1.0, 2.5]}
    assert main(["param", "dump", "/lab/driver", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["arm.ids"] == [1, 2]
    assert main(["param", "describe", "/lab/driver", "speed", "--json"]) == 0
    (described,) = json.loads(capsys.readouterr().out)
    assert (described["range"], described["type"]) == ({"from_value": 0.0, "to_value": 2.0, "step": 0.5}, "double")


@pytest.mark.usefixtures("driver")
def test_parameters_are_described_as_ros2_describes_them(capsys: Captured) -> None:
    assert main(["param", "describe", "/lab/driver", "speed", "arm.length"]) == 0
    assert capsys.readouterr().out == (
        "Parameter name: speed\n  Type: double\n  Description: m/s\n  Constraints:\n"
        "    Min value: 0.0\n    Max value: 2.0\n    Step: 0.5\n"
        "Parameter name: arm.length\n  Type: integer\n  Constraints:\n"
        "    Read only: true\n    Min value: 1\n    Max value: 5\n"
    )


@pytest.mark.usefixtures("driver")
def test_a_dump_is_a_parameter_file(capsys: Captured) -> None:
    assert main(["param", "dump", "/lab/driver"]) == 0
    assert capsys.readouterr() == (DUMPED, "")


def test_what_no_file_can_hold_is_left_out_and_told(driver: Node, capsys: Captured) -> None:
    driver.declare_parameter("raw", [b"\x01", b"\xff"])
    assert main(["param", "dump", "/lab/driver"]) == 0
    said, told = capsys.readouterr()
    assert (said, told) == (DUMPED, "robolink: left out 'raw': a parameter file cannot hold a byte array\n")
    assert main(["param", "get", "/lab/driver", "raw"]) == 0
    assert capsys.readouterr().out == "Byte values are: [b'\\x01', b'\\xff']\n"
