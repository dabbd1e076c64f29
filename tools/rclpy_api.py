"""Extractor of the names and signatures in rclpy's source: facts only, no words of it.

Usage: python tools/rclpy_api.py CHECKOUT/rclpy/rclpy 8.0.0 > tests/data/rclpy_api.json
"""

from __future__ import annotations

import ast
import json
import sys
from pathlib import Path

LEFT_OUT = {
    "handle": "a handle of the C library",
    "*_impl": "a constructor's parameter that takes a handle of the C library",
    "get_c_*": "gives an object of the C library",
    "capsule": "a handle of the C library, older name",
    "TypedDict, TypeVar, TypeAlias, Protocol": "for type checkers only; those of rclpy.type_support are kept",
    "imports": "what a module needs itself; those of the packages' own __init__.py are their face, and kept",
    "_name": "private",
}
CLASSES_FOR_CHECKERS = {"TypedDict", "Protocol"}
MAKERS_FOR_CHECKERS = {"TypeVar", "NewType", "ParamSpec", "Union", "Optional", "Callable", "Literal", "Type", "Tuple"}
DROPPED = {"typing", "typing_extensions", "__future__", "rpyutils", "_rclpy", "rclpy_implementation"}


def is_public(name: str) -> bool:
    """Return whether a name is part of the face, and no handle of the C library."""
    return not name.startswith("_") and name not in ("handle", "capsule") and not name.startswith("get_c_")


def name_of(node: ast.expr | None) -> str:
    """Return the last name in ``a.b[c](d)``: b."""
    if isinstance(node, ast.Subscript):
        return name_of(node.value)
    if isinstance(node, ast.Call):
        return name_of(node.func)
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def signature(function: ast.FunctionDef | ast.AsyncFunctionDef) -> str:
    """Return the parameters without their types; text that `def f(...)` takes."""
    args = function.args
    for each in [*args.posonlyargs, *args.args, *args.kwonlyargs, args.vararg, args.kwarg]:
        if each is not None:
            each.annotation = None
    return ast.unparse(args)


def methods(body: list[ast.stmt]) -> tuple[dict[str, str], dict[str, str]]:
    """Return the functions with their signatures, and the properties: r or rw."""
    calls: dict[str, str] = {}
    properties: dict[str, str] = {}
    for each in body:
        if not isinstance(each, (ast.FunctionDef, ast.AsyncFunctionDef)):
            continue
        marks = [name_of(mark) for mark in each.decorator_list]
        if "overload" in marks:
            continue
        dunder = each.name.startswith("__") and each.name.endswith("__")
        if not is_public(each.name) and not dunder:
            continue
        if "property" in marks:
            properties.setdefault(each.name, "r")
        elif "setter" in marks:
            properties[each.name] = "rw"
        else:
            kind = "".join(f"@{mark} " for mark in marks if mark in ("staticmethod", "classmethod"))
            calls[each.name] = kind + signature(each)
    return calls, properties


def described_class(node: ast.ClassDef) -> dict[str, object]:
    """Return the members of a class."""
    calls, properties = methods(node.body)
    made = {
        "bases": [name_of(base) for base in node.bases],
        "calls": calls,
        "properties": properties,
        "attributes": sorted(targets(node.body)),
    }
    return {key: value for key, value in made.items() if value}


def targets(body: list[ast.stmt]) -> set[str]:
    """Return the public names that statements bind to a value."""
    found: set[str] = set()
    for each in body:
        if isinstance(each, ast.Assign) and name_of(each.value) not in MAKERS_FOR_CHECKERS:
            found |= {target.id for target in each.targets if isinstance(target, ast.Name)}
        elif isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name):
            alias = "TypeAlias" in ast.unparse(each.annotation)
            if not alias or (each.value is not None and "_rclpy" in ast.unparse(each.value)):
                found.add(each.target.id)
    return {name for name in found if is_public(name)}


def imported(node: ast.ImportFrom) -> set[str]:
    """Return the names that an import brings in from rclpy or a package of messages."""
    root = (node.module or "").partition(".")[0]
    if not node.level and (root in DROPPED or root in sys.stdlib_module_names):
        return set()
    return {each.asname or each.name for each in node.names} - DROPPED


def described_module(path: Path) -> dict[str, object]:
    """Return the members of a module."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    functions, _ = methods(tree.body)
    functions = {name: text for name, text in functions.items() if is_public(name)}
    classes, names = {}, targets(tree.body)
    for each in tree.body:
        if isinstance(each, ast.ClassDef) and is_public(each.name):
            keep = path.name == "type_support.py" or not {name_of(base) for base in each.bases} & CLASSES_FOR_CHECKERS
            if keep:
                classes[each.name] = described_class(each)
        elif isinstance(each, ast.ImportFrom) and path.name == "__init__.py":
            names |= {name for name in imported(each) if is_public(name)}
    if path.name == "type_support.py":
        names |= {name_of(each.targets[0]) for each in tree.body if isinstance(each, ast.Assign)}
    made = {"functions": functions, "classes": classes, "names": sorted(names)}
    return {key: value for key, value in made.items() if value}


def main() -> None:
    """Write the table to standard output."""
    root = Path(sys.argv[1])
    modules = {}
    for path in sorted(root.rglob("*.py")):
        parts = path.relative_to(root).with_suffix("").parts
        name = ".".join(part for part in parts if part != "__init__")
        modules[name] = described_module(path)
    table = {"source": f"ros2/rclpy {sys.argv[2]}", "left_out": LEFT_OUT, "modules": modules}
    sys.stdout.write(json.dumps(table, indent=1, sort_keys=True) + "\n")


if __name__ == "__main__":
    main()
