"""The expressions of --filter: Python's spelling, read by us and never given to `eval`.

    wanted = compile_filter("m.linear.x > 0.2 and len(m.name) < 20", Twist)
    if wanted(message): ...

An expression is a tree of a few known kinds; each becomes a function that does just that. A name is only `m` or one
of `FUNCTIONS`, an attribute only a field of the message's type, and no number or text can be made to grow.
"""

from __future__ import annotations

import ast
import functools
import operator
import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

from robolink.cli.topic.filter_functions import FUNCTIONS, METHODS, OPERATORS, comparable, simple, takes, truth
from robolink.exceptions import RobolinkError, nearest
from robolink.message.annotations import FieldType

LONGEST = 1000
"""Characters of an expression."""

DEEPEST = 40
"""Levels of an expression."""

COMPARISONS: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.In: lambda element, container: element in container,
    ast.NotIn: lambda element, container: element not in container,
}

TEXT = FieldType(base="string")


class FilterError(RobolinkError, ValueError):
    """An expression that is none, asks for what a message has not, or cannot be computed for one message."""

    def __init__(self, text: str, column: int = 0) -> None:
        super().__init__(f"--filter: column {column}: {text}" if column else f"--filter: {text}")


class Part(NamedTuple):
    """A part of an expression: what computes it from the message, and its type where it is a field's."""

    value: Callable[[Any], Any]
    kind: FieldType | None = None


def compile_filter(text: str, kind: type[Any] | FieldType) -> Callable[[Any], bool]:
    """Give the function that tells whether a message passes; `kind` is what `m` is, a message class or a field.

    Raises FilterError, which names the column, for what is no such expression. So does the function, for a message
    that it cannot be computed for: a division by zero, an index beyond the end.
    """
    line = " ".join(text.splitlines()).strip()
    root = kind if isinstance(kind, FieldType) else FieldType(base=kind.__ros_type__, message=kind)
    value = _Compiler(line, root).part(_parsed(line), 0).value

    def passes(message: Any) -> bool:
        return truth(value(message))

    return passes


def _parsed(line: str) -> ast.expr:
    if not line:
        raise FilterError("expected an expression such as 'm.data > 3', got nothing")
    if len(line) > LONGEST:
        raise FilterError(f"an expression has at most {LONGEST} characters, got {len(line)}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of escapes that Python does not know
            return ast.parse(line, mode="eval").body
    except SyntaxError as error:
        problem = " ".join(str(error.msg).split())
        raise FilterError(f"no Python expression: {problem}", error.offset or len(line) + 1) from None  # 0: at the end
    except (ValueError, RecursionError, MemoryError, OverflowError):
        raise FilterError("no Python expression: nested too deeply, or with characters that are none") from None


class _Compiler:
    """Turns each node of the tree into a Part, or refuses it."""

    def __init__(self, line: str, root: FieldType) -> None:
        self.line, self.root = line, root
        self.rules: dict[type[ast.expr], Callable[[Any, int], Part]] = {
            ast.Constant: self._constant,
            ast.Name: self._name,
            ast.Attribute: self._attribute,
            ast.Subscript: self._subscript,
            ast.BoolOp: self._bool_op,
            ast.UnaryOp: self._unary_op,
            ast.BinOp: self._bin_op,
            ast.Compare: self._compare,
            ast.IfExp: self._if_else,
            ast.Call: self._call,
            ast.List: self._elements,
            ast.Tuple: self._elements,
        }

    def part(self, node: ast.expr, depth: int) -> Part:
        """Compile a node that stands `depth` levels deep."""
        rule = self.rules.get(type(node))
        if depth > DEEPEST:
            raise self.refused(node, f"nested more than {DEEPEST} levels deep")
        if rule is None:
            raise self.refused(node, f"{_WORDS.get(type(node), type(node).__name__)} cannot stand in a filter")
        return rule(node, depth + 1)

    def refused(self, node: ast.expr, text: str) -> FilterError:
        """Make the error about a node."""
        return FilterError(text, self.column(node))

    def column(self, node: ast.expr) -> int:
        """Give where a node begins, from 1; the tree counts bytes."""
        return len(self.line.encode()[: node.col_offset].decode(errors="replace")) + 1

    def said(self, node: ast.expr) -> str:
        """Give a node as it was written."""
        return self.line.encode()[node.col_offset : node.end_col_offset].decode(errors="replace")[:60]

    def guarded(self, node: ast.expr, compute: Callable[[Any], Any]) -> Callable[[Any], Any]:
        """Have what goes wrong with one message told as a FilterError."""
        column = self.column(node)

        def guarded(message: Any) -> Any:
            try:
                return compute(message)
            except FilterError:
                raise
            except IndexError:
                raise FilterError("there is no such element", column) from None
            except (ArithmeticError, TypeError, ValueError, AttributeError) as error:
                raise FilterError(" ".join(str(error).split()), column) from None

        return guarded

    def _constant(self, node: ast.Constant, depth: int) -> Part:
        value = node.value
        if isinstance(value, str):
            return Part(lambda _: value, TEXT)
        if not isinstance(value, (bool, int, float)):
            raise self.refused(node, f"expected a number, a text, True or False, got {self.said(node)}")
        return Part(lambda _: value)

    def _name(self, node: ast.Name, depth: int) -> Part:
        if node.id == "m":
            return Part(simple, self.root)
        known = ["m", *FUNCTIONS]
        if node.id in FUNCTIONS:
            raise self.refused(node, f"{node.id} is a function: {node.id}(...)")
        raise self.refused(
            node, f"no name '{node.id}'{nearest(node.id, known)}; there is m, the message, and {_listed()}"
        )

    def _attribute(self, node: ast.Attribute, depth: int) -> Part:
        holder = self.part(node.value, depth)
        step, kind = node.attr, holder.kind
        if kind is None or kind.message is None or kind.shape != "one":
            what = "a sequence" if kind is not None and kind.shape != "one" else "no message"
            raise self.refused(node, f"no field '{step}': what stands before it is {what}")
        fields = kind.message.__ros_fields__
        if step not in fields:
            there = ", ".join(fields) or "nothing"
            raise self.refused(
                node, f"no field '{step}'{nearest(step, fields)}; {kind.message.__ros_type__} has {there}"
            )
        get = holder.value
        return Part(lambda message: simple(getattr(get(message), step)), fields[step])

    def _subscript(self, node: ast.Subscript, depth: int) -> Part:
        get, kind = self.part(node.value, depth)
        if kind is None or (kind.shape == "one" and kind.base not in ("string", "wstring")):
            raise self.refused(node, "what stands before [ is neither a sequence nor a text")
        if isinstance(node.slice, ast.Slice):
            cut = self._slice(node.slice, depth)
            return Part(self.guarded(node, lambda message: get(message)[cut(message)]), kind)
        at = self.part(node.slice, depth).value
        element = kind if kind.shape == "one" else FieldType(base=kind.base, message=kind.message)
        return Part(self.guarded(node, lambda message: simple(get(message)[at(message)])), element)

    def _slice(self, node: ast.Slice, depth: int) -> Callable[[Any], slice]:
        given = (node.lower, node.upper, node.step)
        parts = [None if each is None else self.part(each, depth).value for each in given]
        return lambda message: slice(*[None if each is None else each(message) for each in parts])

    def _bool_op(self, node: ast.BoolOp, depth: int) -> Part:
        values = [self.part(each, depth).value for each in node.values]
        ends_with = isinstance(node.op, ast.Or)
        return Part(lambda message: ends_with if any(truth(v(message)) is ends_with for v in values) else not ends_with)

    def _unary_op(self, node: ast.UnaryOp, depth: int) -> Part:
        value = self.part(node.operand, depth).value
        if isinstance(node.op, ast.Not):
            return Part(lambda message: not truth(value(message)))
        action = OPERATORS[type(node.op)]
        return Part(self.guarded(node, lambda message: action(value(message))))

    def _bin_op(self, node: ast.BinOp, depth: int) -> Part:
        action = OPERATORS.get(type(node.op))
        if action is None:
            raise self.refused(node, f"{self.said(node)}: that operator cannot stand in a filter")
        left, right = self.part(node.left, depth).value, self.part(node.right, depth).value
        return Part(self.guarded(node, lambda message: action(left(message), right(message))))

    def _compare(self, node: ast.Compare, depth: int) -> Part:
        values = [self.part(each, depth).value for each in (node.left, *node.comparators)]
        tests = [COMPARISONS.get(type(each)) for each in node.ops]
        if None in tests:
            raise self.refused(node, "'is' cannot stand in a filter: use ==")

        def compare(message: Any) -> bool:
            left = comparable(values[0](message))
            for test, value in zip(tests, values[1:], strict=True):
                right = comparable(value(message))
                if not test(left, right):  # type: ignore[misc]
                    return False
                left = right
            return True

        return Part(self.guarded(node, compare))

    def _if_else(self, node: ast.IfExp, depth: int) -> Part:
        test, yes, no = (self.part(each, depth).value for each in (node.test, node.body, node.orelse))
        return Part(lambda message: yes(message) if truth(test(message)) else no(message))

    def _elements(self, node: ast.List | ast.Tuple, depth: int) -> Part:
        values = [self.part(each, depth).value for each in node.elts]
        return Part(lambda message: [value(message) for value in values])

    def _call(self, node: ast.Call, depth: int) -> Part:
        if node.keywords:
            raise self.refused(node, "a function takes no named arguments in a filter")
        arguments = [self.part(each, depth).value for each in node.args]
        function = self._function(node, depth)
        return Part(self.guarded(node, lambda message: function(message)(*[each(message) for each in arguments])))

    def _function(self, node: ast.Call, depth: int) -> Callable[[Any], Callable[..., Any]]:
        """Give what gives the function that is called: one of ours, or a text's own."""
        called = node.func
        if isinstance(called, ast.Name) and called.id in FUNCTIONS:
            function = FUNCTIONS[called.id]
            self._check_count(node, called.id, takes(function))
            return lambda _: function
        if isinstance(called, ast.Attribute) and called.attr in METHODS:
            method, holder = METHODS[called.attr], self.part(called.value, depth)
            if holder.kind is None or holder.kind.shape != "one" or holder.kind.base not in ("string", "wstring"):
                raise self.refused(called, f".{called.attr}() needs a text before it")
            self._check_count(node, called.attr, takes(method, of_text=True))
            get = holder.value
            return lambda message: functools.partial(method, get(message))
        name = self.said(called)
        raise self.refused(called, f"no function '{name}'{nearest(name, FUNCTIONS)}; there is {_listed()}")

    def _check_count(self, node: ast.Call, name: str, wanted: int | None) -> None:
        if wanted is not None and len(node.args) != wanted:
            plural = "" if wanted == 1 else "s"
            raise self.refused(node, f"{name}() takes {wanted} argument{plural} in a filter, got {len(node.args)}")


def _listed() -> str:
    return ", ".join(FUNCTIONS)


_WORDS: dict[type[ast.expr], str] = {
    ast.Lambda: "a lambda",
    ast.GeneratorExp: "a generator",
    ast.ListComp: "a comprehension",
    ast.SetComp: "a comprehension",
    ast.DictComp: "a comprehension",
    ast.JoinedStr: "an f-string",
    ast.NamedExpr: "an assignment",
    ast.Dict: "a dict",
    ast.Set: "a set",
    ast.Starred: "a starred value",
    ast.Await: "await",
    ast.Yield: "yield",
    ast.YieldFrom: "yield",
    ast.Slice: "a slice",
}
