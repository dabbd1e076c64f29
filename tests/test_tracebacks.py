"""Tracebacks as text: a misspelt name is told with the nearest, whatever the version of Python."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from robolink.lacking import LackingAttributeError
from robolink.tracebacks import formatted, suggestion


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
        NameError("a text alone"),
        AttributeError("a text alone"),
        LackingAttributeError("rclpy.ko", lambda: ["ok"]),
    ],
)
def test_where_nothing_is_near_nothing_is_said(error: BaseException) -> None:
    assert suggestion(error) == ""


def test_a_part_of_a_traceback() -> None:
    error = raised_by(misspelt_builtin)
    trace: Any = error.__traceback__
    while trace.tb_next is not None:
        trace = trace.tb_next
    lines = formatted(error, trace).splitlines()
    assert [line.split(", in ")[1] for line in lines if line.startswith("  File")] == ["misspelt_builtin"]
    assert "raised_by" in formatted(error)
