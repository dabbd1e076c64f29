"""Docstrings of the source files, read with `ast`: nothing is imported, so each file of each platform is seen."""

from __future__ import annotations

import ast
import functools
import itertools
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]

Function = ast.FunctionDef | ast.AsyncFunctionDef
Documented = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef

ARGUMENT = re.compile(r"^ *\*{0,2}([\w, *]+?)(?: \(.*?\))?:(?: |$)")
"""A line of an Args section: `name: ...`; several names may share one line."""

INHERITED = frozenset({"property", "setter", "getter", "deleter", "overload", "cached_property"})
"""Decorators of functions that document no arguments: a property has none that a caller names."""


class Text(NamedTuple):
    """A docstring and its place."""

    path: Path
    line: int
    of: str
    text: str

    def __str__(self) -> str:
        return f"{self.path.relative_to(ROOT).as_posix()}:{self.line}: {self.of}: {self.text.splitlines()[0]}"


class Module:
    """A parsed source file: its classes and functions, and where the names are from that it imports."""

    def __init__(self, name: str, path: Path, tree: ast.Module) -> None:
        self.name, self.path, self.tree = name, path, tree
        self.imports = {
            alias.asname or alias.name: (node.module, alias.name)
            for node in ast.walk(tree)
            if isinstance(node, ast.ImportFrom) and node.module is not None
            for alias in node.names
        }
        here = list(_run(tree.body))
        self.classes = {each.name: each for each in here if isinstance(each, ast.ClassDef)}
        self.functions: dict[str, Function] = {each.name: each for each in here if isinstance(each, Function)}


@functools.cache
def module(path: Path) -> Module:
    """The file's module; a file is read once."""
    return parsed(path, path.read_text(encoding="utf-8"))


def parsed(path: Path, text: str) -> Module:
    """The module that this text makes in this file."""
    tree = ast.parse(text)
    parts = (path.relative_to(ROOT) if path.is_relative_to(ROOT) else Path(path.name)).with_suffix("").parts
    name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
    return Module(name, path, tree)


def _run(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """The statements that run: those below `if`, but not what type checkers alone see."""
    for each in body:
        if isinstance(each, ast.If):
            if "TYPE_CHECKING" not in ast.unparse(each.test):
                yield from _run(each.body)
            yield from _run(each.orelse)
        else:
            yield each


def texts(path: Path) -> Iterator[Text]:
    """All docstrings of a file: of the module, classes, functions, and those below constants and attributes."""
    tree = module(path).tree
    for node in ast.walk(tree):
        if isinstance(node, Documented):
            own = ast.get_docstring(node)
            if own:
                yield Text(path, node.body[0].lineno, getattr(node, "name", "module"), own)
        for body in (getattr(node, "body", None), getattr(node, "orelse", None)):
            if isinstance(body, list):
                yield from _below_assignments(path, body)


def _below_assignments(path: Path, body: list[ast.stmt]) -> Iterator[Text]:
    for before, each in itertools.pairwise(body):
        if isinstance(before, ast.Assign | ast.AnnAssign) and isinstance(each, ast.Expr):
            value = each.value
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                target = before.targets[0] if isinstance(before, ast.Assign) else before.target
                yield Text(path, each.lineno, ast.unparse(target), value.value.strip())


# Arguments


class Undocumented(NamedTuple):
    """A function, and those of its arguments that no docstring names."""

    path: Path
    line: int
    of: str
    """The function's name, behind that of its class."""
    arguments: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.path.relative_to(ROOT).as_posix()}:{self.line}: {self.of}: {', '.join(self.arguments)}"


def undocumented(source: Module, names: frozenset[str] | None = None) -> Iterator[Undocumented]:
    """The public functions, methods and constructors of a module that leave arguments undocumented.

    `names` are the functions and classes to look at, all public ones by default. A class comes with its base classes.
    """
    wanted = {each for each in (*source.functions, *source.classes) if _is_public(each)} if names is None else names
    for name, function in source.functions.items():
        if name in wanted:
            yield from _missing(source, function, name, [ast.get_docstring(function) or ""])
    for name, class_ in source.classes.items():
        if name in wanted:
            for where, each in dict.fromkeys(_with_bases(source, class_)):
                yield from _of_class(where, each)


def undocumented_fields(source: Module, names: frozenset[str] | None = None) -> Iterator[Undocumented]:
    """The public fields of records (NamedTuple, dataclass, Struct, TypedDict), which are arguments of constructors.

    A field may be named in its class's docstring as an argument is, or have a docstring of its own below it.
    """
    for name, class_ in source.classes.items():
        if (_is_public(name) if names is None else name in names) and _is_record(source, class_):
            named = documented(ast.get_docstring(class_) or "")
            fields = [each for each in _bare_fields(class_) if each not in named]
            if fields:
                yield Undocumented(source.path, class_.lineno, name, tuple(fields))


def _is_record(source: Module, class_: ast.ClassDef) -> bool:
    if any("dataclass" in ast.unparse(each) for each in class_.decorator_list):
        return True
    if any(ast.unparse(base).rpartition(".")[2] in RECORDS for base in class_.bases):
        return True
    return any(_is_record(where, parent) for where, parent in _bases(source, class_))


RECORDS = frozenset({"NamedTuple", "Struct", "TypedDict"})


def _bare_fields(class_: ast.ClassDef) -> Iterator[str]:
    """The public fields without a docstring of their own."""
    for each, after in itertools.zip_longest(class_.body, class_.body[1:]):
        is_bare = not (isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant))
        if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name) and is_bare:
            yield from filter(_is_public, [each.target.id])


def _with_bases(source: Module, class_: ast.ClassDef) -> Iterator[tuple[Module, ast.ClassDef]]:
    yield source, class_
    for where, parent in _bases(source, class_):
        yield from _with_bases(where, parent)


def _bases(source: Module, class_: ast.ClassDef) -> Iterator[tuple[Module, ast.ClassDef]]:
    """The base classes that are the package's own."""
    for base in class_.bases:
        found = _find_class(source, ast.unparse(base).partition("[")[0])
        if found is not None:
            yield found


def _is_public(name: str) -> bool:
    return not name.startswith("_")


def _of_class(source: Module, class_: ast.ClassDef) -> Iterator[Undocumented]:
    for each in _run(class_.body):
        if isinstance(each, ast.ClassDef) and _is_public(each.name):
            yield from _of_class(source, each)
        elif isinstance(each, Function) and (_is_public(each.name) or each.name in ("__init__", "__new__", "__call__")):
            if each.name in ("__init__", "__new__"):
                makers = [each for each in class_.body if isinstance(each, Function) and each.name in MAKERS]
                docs = [ast.get_docstring(node) or "" for node in (class_, *makers)]
            else:
                docs = [ast.get_docstring(each) or "", *_inherited(source, class_, each.name)]
            yield from _missing(source, each, f"{class_.name}.{each.name}", docs, is_method=True)


MAKERS = ("__init__", "__new__")


def _inherited(source: Module, class_: ast.ClassDef, method: str) -> Iterator[str]:
    """The docstrings of what a method overrides, in the package's own classes."""
    for where, parent in _bases(source, class_):
        for each in _run(parent.body):
            if isinstance(each, Function) and each.name == method:
                yield ast.get_docstring(each) or ""
        yield from _inherited(where, parent, method)


def _find_class(source: Module, name: str) -> tuple[Module, ast.ClassDef] | None:
    while name not in source.classes:
        imported = source.imports.get(name)
        if imported is None:
            return None
        path = file_of(imported[0])
        if path is None:
            return None
        source, name = module(path), imported[1]
    return source, source.classes[name]


def file_of(name: str) -> Path | None:
    """The file of a module of this repository."""
    base = ROOT.joinpath(*name.split("."))
    return next((each for each in (base.with_suffix(".py"), base / "__init__.py") if each.is_file()), None)


def _missing(
    source: Module, function: Function, name: str, docs: list[str], *, is_method: bool = False
) -> Iterator[Undocumented]:
    if any(ast.unparse(each).rpartition(".")[2] in INHERITED for each in function.decorator_list):
        return
    static = any(ast.unparse(each) == "staticmethod" for each in function.decorator_list)
    named = {name for text in docs for name in documented(text)}
    arguments = [each for each in _arguments(function, skip_first=is_method and not static) if each not in named]
    if arguments:
        yield Undocumented(source.path, function.lineno, name, tuple(arguments))


def _arguments(function: Function, *, skip_first: bool) -> Iterator[str]:
    given = function.args
    positional = [*given.posonlyargs, *given.args][int(skip_first) :]
    for each in (*positional, given.vararg, *given.kwonlyargs, given.kwarg):
        if each is not None and _is_public(each.arg):
            yield each.arg


def documented(text: str) -> set[str]:
    """The arguments that a docstring names: in its Args section, or in backticks, also as they are called.

    >>> sorted(documented("Return `a` and ``*b``.\\n\\nArgs:\\n    c, d: Two.\\n        e: More of it.\\n"))
    ['a', 'b', 'c', 'd']
    """
    found = {each.lstrip("*") for each in re.findall(r"`(\*{0,2}\w+)(?:\([^`]*\))?`", text)}
    section = re.search(r"^Args:\n((?: .*\n?|\n)*)", text, re.MULTILINE)
    if section is not None:
        lines = [line for line in section[1].splitlines() if re.match(r" {4}\S", line)]
        names = [match[1] for line in lines if (match := ARGUMENT.match(line)) is not None]
        found.update(each.strip().lstrip("*") for name in names for each in name.split(","))
    return found
