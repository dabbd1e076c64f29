"""Lister of the public names that a package of ROS 2 has in a checkout, and that robolink's of this name lacks.

    git clone https://github.com/ros2/launch
    git clone --branch 3.7.1 https://github.com/ros2/launch launch_3.7.1
    python -m tools.upstream launch [--package launch_xml] [--since launch_3.7.1]

The checkout is read and nothing of it is imported. Names are modules, classes, functions, methods, properties,
constants and arguments. An argument is not missing where robolink's function takes any keyword. How the findings are
used is in docs/development/upstream.md.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import inspect
import re
import sys
import warnings
from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from robolink.compat import ALWAYS, activate
from robolink.compat.names import ROOMS
from tools.rclpy_api import described_module

PACKAGES = sorted({name.partition(".")[0] for name in ROOMS})
"""Packages of ROS 2 that robolink stands in for."""
NOT_SHIPPED = {"test", "tests", "build", "install", "doc", "docs", "examples", "conftest"}
"""Folders of a checkout with packages of a name that are not the one that is installed."""


class Name(NamedTuple):
    """Public name of a package.

    Args:
        module: Name of the module, as in an import.
        path: Name in it, `Class.method` or `function`; '' is the module itself.
        argument: Name of a parameter; '' is what the path names.
    """

    module: str
    path: str = ""
    argument: str = ""

    @property
    def is_inner(self) -> bool:
        """True if it is below a class or function."""
        return bool(self.argument) or "." in self.path

    def parents(self) -> Iterator[Name]:
        """Yield the names without which this one cannot be there, from the module on."""
        if self.path:
            yield Name(self.module)
        parts = self.path.split(".")
        last = len(parts) if self.argument else len(parts) - 1
        yield from (Name(self.module, ".".join(parts[:count])) for count in range(1, last + 1))


# --- Upstream ---------------------------------------------------------------------------------------------------------


def packages_in(checkout: Path) -> dict[str, Path]:
    """Return the folders in a checkout of the packages that robolink stands in for, by name."""
    found: dict[str, Path] = {}
    for name in PACKAGES:
        places = [file.parent for file in checkout.rglob(f"{name}/__init__.py")]
        shipped = [each for each in places if not NOT_SHIPPED & set(each.relative_to(checkout).parts[:-1])]
        if shipped:
            found[name] = min(shipped, key=lambda each: len(each.parts))
    return found


def names_in(folder: Path) -> Iterator[Name]:
    """Yield the public names of the package in a folder; of a compiled module those that its stub has."""
    for path in sorted([*folder.rglob("*.py"), *folder.rglob("*.pyi")]):
        parts = [folder.name, *path.relative_to(folder).with_suffix("").parts]
        if path.stem == "__init__":
            parts.pop()
        elif path.suffix == ".pyi" and path.stem.startswith("_"):
            parts.pop()  # a compiled module, whose names its package gives out
        if not any(part.startswith("_") or part in NOT_SHIPPED for part in parts):
            yield from names_of(".".join(parts), described_module(path))


def names_of(module: str, described: dict[str, Any]) -> Iterator[Name]:
    """Yield the names of a module that `described_module` has described."""
    yield Name(module)
    yield from (Name(module, name) for name in described.get("names", ()) if name != "*")
    for function, signature in described.get("functions", {}).items():
        yield from callee(module, function, signature)
    for owner, parts in described.get("classes", {}).items():
        yield Name(module, owner)
        for member in (*parts.get("properties", ()), *parts.get("attributes", ())):
            yield Name(module, f"{owner}.{member}")
        for method, signature in parts.get("calls", {}).items():
            yield from callee(module, f"{owner}.{method}", signature)


def callee(module: str, path: str, signature: str) -> Iterator[Name]:
    """Yield a function and its arguments; those of Python's own methods, such as `__eq__`, have any names."""
    yield Name(module, path)
    if path.endswith("__") and not path.endswith(".__init__"):
        return
    made = ast.parse(f"def f({signature.rpartition('@')[2].partition(' ')[2] if '@' in signature else signature}): 0")
    taken = made.body[0].args  # type: ignore[attr-defined]
    for each in (*taken.args, *taken.kwonlyargs):
        if each.arg not in ("self", "cls", "mcs") and not re.match(
            r"_|arg\d+$", each.arg
        ):  # stubs number what has no name
            yield Name(module, path, each.arg)


# --- robolink ---------------------------------------------------------------------------------------------------------


@cache
def module_here(name: str) -> ModuleType | None:
    """Return robolink's module of this name; None when there is none."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # modules of an older name say so
        try:
            return importlib.import_module(name)
        except ImportError:
            return None


def is_here(name: Name) -> bool:
    """Return whether robolink has the name."""
    found: Any = module_here(name.module)
    if found is None:
        return False
    owner = None
    for part in filter(None, name.path.split(".")):
        owner, found = found, getattr(found, part, inspect.Parameter.empty)
        if found is inspect.Parameter.empty:
            return is_set_by_instances(owner, part) or module_here(f"{name.module}.{part}") is not None
    return not name.argument or takes(owner if name.path.endswith(".__init__") else found, name.argument)


def is_set_by_instances(owner: Any, name: str) -> bool:
    """Return whether a class annotates the attribute, or its constructor speaks of it."""
    for each in getattr(owner, "__mro__", ()):
        code = getattr(vars(each).get("__init__"), "__code__", None)
        if name in getattr(each, "__annotations__", {}) or (code is not None and name in code.co_names):
            return True
    return False


def takes(function: Any, argument: str) -> bool:
    """Return whether a function or class takes the argument by its name, or any."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):  # of a compiled function nothing is known, and an attribute is called by nobody
        return True
    return any(each.name == argument or each.kind is each.VAR_KEYWORD for each in parameters)


# --- Both -------------------------------------------------------------------------------------------------------------


def missing(names: Iterable[Name]) -> list[Name]:
    """Return the names that robolink lacks; of what is below one of them only the classes and functions of a module."""
    absent = {name: None for name in names if not is_here(name)}
    return [name for name in absent if not any(each in absent for each in name.parents() if each.path or name.is_inner)]


def lines(names: Iterable[Name]) -> Iterator[str]:
    """Yield a line for each module that is missing or lacks names, and each function that lacks arguments."""
    of_modules: defaultdict[str, list[str]] = defaultdict(list)
    of_functions: defaultdict[str, list[str]] = defaultdict(list)
    for name in names:
        if name.argument:
            of_functions[f"{name.module}.{name.path}"].append(name.argument)
        else:
            of_modules[name.module] += [name.path] if name.path else []
    for module, found in of_modules.items():
        begin = module if module_here(module) else f"{module} (no such module)"
        yield f"{begin}: {', '.join(found)}" if found else begin
    yield from (f"{function}(): {', '.join(f'{each}=' for each in found)}" for function, found in of_functions.items())


def compared(checkout: Path, since: Path | None = None, package: str = "") -> dict[str, list[Name]]:
    """Return the names that each package of a checkout has and robolink lacks.

    Args:
        checkout: The checkout.
        since: An older checkout, whose names are left out.
        package: The only package that is compared; '' for all.

    Raises:
        FileNotFoundError: The checkout has no such package.
    """
    folders = {name: folder for name, folder in packages_in(checkout).items() if package in ("", name)}
    if not folders:
        raise FileNotFoundError(f"{checkout} has no package {package or 'that robolink stands in for'}")
    older = packages_in(since) if since else {}
    known = {name: set(names_in(folder)) for name, folder in older.items()}
    return {
        name: missing(each for each in dict.fromkeys(names_in(folder)) if each not in known.get(name, ()))
        for name, folder in folders.items()
    }


def main(given: Iterable[str] | None = None) -> int:
    """Print the names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkout", type=Path, help="a checkout of a repository with packages of ROS 2")
    parser.add_argument("--package", choices=PACKAGES, default="", help="only this package")
    parser.add_argument("--since", type=Path, metavar="CHECKOUT", help="only names that this older checkout lacks")
    options = parser.parse_args(None if given is None else list(given))
    activate(ALWAYS)
    try:
        found = compared(options.checkout, options.since, options.package)
    except FileNotFoundError as error:
        parser.error(str(error))
    for package, names in found.items():
        sys.stdout.writelines(f"{line}\n" for line in (f"# {package}", *lines(names), ""))
    return 0


if __name__ == "__main__":
    sys.exit(main())
