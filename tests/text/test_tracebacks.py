"""Tracebacks as text: a misspelt name is told with the nearest, whatever the version of Python."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from typing import Any

import pytest

import robolink
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.std_msgs import msg as std_msgs
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.text.suggestions import LackingAttributeError
from robolink.text.tracebacks import formatted, suggestion, without_own_frames


def misspelt_local() -> None:
    value = 3
    str(valeu) + str(value)  # type: ignore[name-defined]  # noqa: F821


def misspelt_global() -> None:
    str(maths.pi)  # type: ignore[name-defined]  # noqa: F821


def misspelt_builtin() -> None:
    pritn(3)  # type: ignore[name-defined]  # noqa: F821


def misspelt_attribute() -> None:
    math.sinn(3)  # type: ignore[attr-defined]


def raised_by(act: Callable[[], object]) -> BaseException:
    with pytest.raises(Exception) as caught:  # noqa: PT011
        act()
    return caught.value


@pytest.mark.parametrize(
    ("act", "meant"),
    [(misspelt_local, "value"), (misspelt_global, "math"), (misspelt_builtin, "print"), (misspelt_attribute, "sin")],
)
def test_a_misspelt_name_is_told_with_the_nearest(act: Callable[[], object], meant: str) -> None:
    error = raised_by(act)
    assert suggestion(error) == f". Did you mean: '{meant}'?"
    text = formatted(error)
    assert text.splitlines()[-1].endswith(f". Did you mean: '{meant}'?")
    assert text.count("Did you mean") == 1


class Robot:
    """Has messages at hand in the ways in which nodes have them."""

    def __init__(self) -> None:
        self.twist = Twist()

    def change(self) -> None:
        self.twist.liner = Vector3()  # type: ignore[attr-defined]

    def change_below(self) -> None:
        self.twist.linear.xx = 3.0  # type: ignore[attr-defined]

    def look(self) -> None:
        str(self.twist.angle)  # type: ignore[attr-defined]

    def make(self) -> None:
        std_msgs.String(
            dta="text",  # type: ignore[call-arg]
        )


def make_a_request() -> None:
    request = SetBool.Request
    if request(dat=True):  # type: ignore[call-arg]
        pass


@pytest.mark.parametrize(
    ("act", "meant"),
    [
        (Robot().change, "linear"),
        (Robot().change_below, "x"),
        (Robot().look, "angular"),
        (lambda: getattr([Twist()][0], "liner"), "linear"),  # noqa: B009 - what only code gives
        (Robot().make, "data"),
        (make_a_request, "data"),
    ],
)
def test_a_misspelt_field_is_told_with_the_nearest(act: Callable[[], object], meant: str) -> None:
    error = raised_by(act)
    assert formatted(error).splitlines()[-1].endswith(f"'. Did you mean: '{meant}'?")


def test_where_no_field_is_near_all_are_told() -> None:
    error = raised_by(lambda: getattr(Vector3(), "w"))  # noqa: B009 - mypy would see it
    assert formatted(error).splitlines()[-1] == "AttributeError: 'Vector3' object has no attribute 'w' (only x, y, z)"


def not_a_message() -> None:
    dict.fromkeys(dta="x")  # type: ignore[call-overload]


def one_that_only_code_gives() -> None:
    [Twist()][0].liner = 3  # type: ignore[attr-defined]


class Hostile:
    """A class whose names cannot be listed."""

    def __dir__(self) -> list[str]:
        raise RuntimeError("no")


@pytest.mark.parametrize(
    "error",
    [
        raised_by(lambda: Hostile().name),  # type: ignore[attr-defined]
        raised_by(lambda: math.quite_another),  # type: ignore[attr-defined]
        raised_by(lambda: 1 // 0),
        raised_by(not_a_message),
        TypeError("Unexpected keyword argument 'dta'"),
        NameError("a text alone"),
        AttributeError("a text alone"),
        LackingAttributeError("rclpy.ko", lambda: ["ok"]),
    ],
)
def test_where_nothing_is_near_nothing_is_said(error: BaseException) -> None:
    assert suggestion(error) == ""


def test_a_field_that_only_code_gives_is_known_where_python_tells_the_object() -> None:
    """From Python 3.13 on, which names the object in the error; before, no word of the line is the field's."""
    told = ". Did you mean: 'linear'?" if sys.version_info >= (3, 13) else ""
    assert suggestion(raised_by(one_that_only_code_gives)) == told


def test_a_part_of_a_traceback() -> None:
    error = raised_by(misspelt_builtin)
    trace: Any = error.__traceback__
    while trace.tb_next is not None:
        trace = trace.tb_next
    lines = formatted(error, trace).splitlines()
    assert [line.split(", in ")[1] for line in lines if line.startswith("  File")] == ["misspelt_builtin"]
    assert "raised_by" in formatted(error)


def test_lines_of_own_files_are_left_out_of_a_traceback() -> None:
    text = "\n".join(
        (
            "it failed",
            "Traceback (most recent call last):",
            f'  File "{own_file()}", line 3, in execute',
            "    result = callback(*args)",
            "             ^^^^^^^^^^^^^^^",
            '  File "/home/ada/mine.py", line 7, in on_scan',
            "    twist.liner = 3",
            "    ~~~~~^^^^^^",
            '  File "<encode geometry_msgs/msg/Twist>", line 9, in run',
            "AttributeError: liner",
        )
    )
    left = ["it failed", "Traceback (most recent call last):", '  File "/home/ada/mine.py", line 7, in on_scan']
    assert without_own_frames(text).splitlines() == [*left, "    twist.liner = 3", "AttributeError: liner"]
    assert without_own_frames("no traceback at all\n    ... at all") == "no traceback at all\n    ... at all"


def own_file() -> str:
    """Return the path of a file of robolink's."""
    return robolink.__file__


def test_a_refusal_ends_in_the_programs_own_line(node: robolink.Node) -> None:
    refused = raised_by(lambda: node.create_publisher("cmd_vel", Twist, 10))  # type: ignore[arg-type]
    text = formatted(refused)
    assert text.count('File "') == text.count(__file__) > 0
    assert text.endswith("(the type comes first)")


def test_a_fault_of_robolinks_own_keeps_its_frames(monkeypatch: pytest.MonkeyPatch, node: robolink.Node) -> None:
    monkeypatch.setattr("robolink.arguments.remapping.validate_topic_name", lambda *_, **__: len(3))  # type: ignore[arg-type]
    assert "remapping.py" in formatted(raised_by(lambda: node.create_publisher(Twist, "cmd_vel", 10)))
