"""The number of arguments that a callback takes, found without `inspect`, is the one that `inspect` finds."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from types import MethodType
from typing import Any

import pytest

from robolink.running.execution import takes_arguments


class Calls:
    def none(self) -> None: ...
    def one(self, a: Any) -> None: ...
    def one_or_two(self, a: Any, b: int = 1) -> None: ...
    def any_number(*a: Any) -> None: ...
    def with_a_key(self, a: Any, *, k: Any) -> None: ...
    def with_a_default_key(self, a: Any, *, k: int = 1) -> None: ...
    def __call__(self, a: Any) -> None: ...
    @staticmethod
    def static(a: Any) -> None: ...
    @classmethod
    def of_class(cls, a: Any) -> None: ...


def without_self() -> None: ...
def by_position(a: Any, /, b: int = 1) -> None: ...
def all_kinds(a: Any, *rest: Any, k: int = 1, **more: Any) -> None: ...


@functools.wraps(by_position)
def wrapped(*a: Any) -> None: ...


CALLS = Calls()
CALLBACKS = [
    *(CALLS.none, CALLS.one, CALLS.one_or_two, CALLS.any_number, CALLS.with_a_key, CALLS.with_a_default_key),
    *(
        MethodType(without_self, CALLS),
        CALLS,
        CALLS.static,
        CALLS.of_class,
        Calls.one,
        Calls,
        by_position,
        all_kinds,
        wrapped,
    ),
    *(lambda: 0, lambda message: 0, print, len, int, functools.partial(CALLS.one_or_two, 1)),
]


def by_inspect(function: Callable[..., Any], count: int) -> bool:
    try:
        inspect.signature(function).bind(*[None] * count)
    except TypeError:
        return False
    except ValueError:
        return True
    return True


@pytest.mark.parametrize("callback", CALLBACKS)
def test_a_callback_takes_what_inspect_says(callback: Callable[..., Any]) -> None:
    counts = range(5)
    assert [takes_arguments(callback, each) for each in counts] == [by_inspect(callback, each) for each in counts]
