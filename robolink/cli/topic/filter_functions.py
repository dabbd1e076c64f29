"""What the expressions of --filter can compute: numbers only, and none that grows without bound."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable
from typing import Any

CO_VARARGS = 0x04
"""The flag of a function's code that takes any number of arguments; `inspect` is slow to import."""

MOST_BITS = 4096
"""Of an integer: beyond, what is computed is refused."""


def simple(value: Any) -> Any:
    """Give a field's value as Python's own number or text: no numpy scalar, and a ROS byte as the number it is."""
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    if hasattr(value, "dtype") and not getattr(value, "shape", ()):
        return value.item()
    return value


def truth(value: Any) -> bool:
    """Whether a value counts as true: a sequence when it has elements, as in Python."""
    return len(value) > 0 if hasattr(value, "__len__") else bool(value)


def comparable(value: Any) -> Any:
    """Give something of which == and `in` speak as Python's lists do."""
    if hasattr(value, "tolist"):  # array.array, memoryview, numpy
        return value.tolist()
    return [simple(each) for each in value] if isinstance(value, (list, tuple)) else value


def number(value: Any) -> int | float:
    """Give a number back. Raises TypeError for anything else, text above all, which could be made to grow."""
    if not isinstance(value, (int, float)):
        raise TypeError(f"expected a number, got {_kind(value)}")
    return value


def _kind(value: Any) -> str:
    if isinstance(value, str):
        return "a text"
    if hasattr(value, "__ros_type__"):
        return f"a {value.__ros_type__}"
    return "a sequence" if hasattr(value, "__len__") else type(value).__name__


def _bounded(bits: int) -> None:
    if bits > MOST_BITS:
        raise OverflowError(f"an integer of more than {MOST_BITS} bits")


def _multiply(left: Any, right: Any) -> Any:
    if isinstance(left, int) and isinstance(right, int):
        _bounded(left.bit_length() + right.bit_length())
    return left * right


def _power(left: Any, right: Any) -> Any:
    if isinstance(left, int) and isinstance(right, int):
        _bounded(left.bit_length() * max(right, -right))
    found = left**right
    if isinstance(found, complex):
        raise ArithmeticError("the root of a negative number")
    return found


def _shift_left(left: Any, right: Any) -> Any:
    if isinstance(left, int) and isinstance(right, int):
        _bounded(left.bit_length() + max(right, 0))
    return left << right


def _of_numbers(action: Callable[..., Any]) -> Callable[..., Any]:
    return lambda *values: action(*[number(each) for each in values])


OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: _of_numbers(operator.add),
    ast.Sub: _of_numbers(operator.sub),
    ast.Mult: _of_numbers(_multiply),
    ast.Div: _of_numbers(operator.truediv),
    ast.FloorDiv: _of_numbers(operator.floordiv),
    ast.Mod: _of_numbers(operator.mod),
    ast.Pow: _of_numbers(_power),
    ast.LShift: _of_numbers(_shift_left),
    ast.RShift: _of_numbers(operator.rshift),
    ast.BitAnd: _of_numbers(operator.and_),
    ast.BitOr: _of_numbers(operator.or_),
    ast.BitXor: _of_numbers(operator.xor),
    ast.UAdd: _of_numbers(operator.pos),
    ast.USub: _of_numbers(operator.neg),
    ast.Invert: _of_numbers(operator.invert),
}


def _of_many(action: Callable[[list[Any]], Any]) -> Callable[..., Any]:
    """A function of the elements of one sequence, or of its arguments: numbers."""

    def function(*values: Any) -> Any:
        if len(values) == 1:
            values = tuple(comparable(values[0])) if hasattr(values[0], "__len__") else values
        return action([number(each) for each in values])

    return function


def _length(value: Any) -> int:
    if not hasattr(value, "__len__"):
        raise TypeError(f"len() of {_kind(value)}")
    return len(value)


def _one_number(action: Callable[[Any], Any]) -> Callable[[Any], Any]:
    return lambda value: action(number(value))


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": _one_number(abs),
    "bool": truth,
    "float": _one_number(float),
    "hypot": lambda *values: math.hypot(*[number(each) for each in values]),
    "int": _one_number(int),
    "isfinite": _one_number(math.isfinite),
    "isinf": _one_number(math.isinf),
    "isnan": _one_number(math.isnan),
    "len": _length,
    "max": _of_many(max),
    "min": _of_many(min),
    "round": _one_number(round),
    "sqrt": _one_number(math.sqrt),
    "sum": _of_many(sum),
}
"""Python's, of numbers; `len` of sequences and texts, `min`, `max` and `sum` also of a sequence."""


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"expected a text, got {_kind(value)}")
    return value


METHODS: dict[str, Callable[..., Any]] = {
    "startswith": lambda text, start: text.startswith(_text(start)),
    "endswith": lambda text, end: text.endswith(_text(end)),
    "lower": lambda text: text.lower(),
    "upper": lambda text: text.upper(),
}
"""What a text can be asked."""


def takes(function: Any, *, of_text: bool = False) -> int | None:
    """Give how many arguments one of these functions takes, beside its text if it is `of_text`; None for any number."""
    code = function.__code__
    return None if code.co_flags & CO_VARARGS else code.co_argcount - of_text
