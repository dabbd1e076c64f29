"""Loader of hosted programs' code: each program has modules of its own where that is cheap to give.

A node's own file is loaded anew for every start, as in a process of its own: two programs from one file, and one that
was started again, share none of its variables. What it imports is shared: its neighbours, modules of packages.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

from robolink.host.participants import ProgramLike
from robolink.workspace import NodeLoadError, NodeSource, load_node


def load(source: NodeSource, program: ProgramLike) -> Callable[[], Any]:
    """Return the Node class of a source, or a function that runs its script. Raises what `load_node` raises."""
    if not source.module:
        _forget(str(source.path.resolve()))
    return load_node(source, script=lambda found, reach: _script(found, reach, program))


def _forget(path: str) -> None:
    """Remove the module of a file, by whichever name it was imported (one of a package has its dotted name)."""
    for name, each in list(sys.modules.items()):
        if getattr(each, "__dict__", {}).get("__file__") == path:
            del sys.modules[name]


def _script(source: NodeSource, reach: Callable[[], None], program: ProgramLike) -> Callable[[], None]:
    """Return a function that runs a script as ``__main__``, of which each program has its own."""

    def run() -> None:
        reach()
        module = program.main_module = ModuleType("__main__")
        code = _code_of_module(source.module, module) if source.module else _code_of_file(source.path, module)
        program.host.scheduler.view.show(program)
        exec(code, vars(module))  # noqa: S102 - that is what running a script is

    return run


def _code_of_file(path: Path | None, module: ModuleType) -> CodeType:
    assert path is not None
    vars(module).update(__file__=str(path), __builtins__=__builtins__)
    return compile(path.read_bytes(), str(path), "exec", dont_inherit=True)


def _code_of_module(name: str, module: ModuleType) -> CodeType:
    spec = importlib.util.find_spec(name)
    if spec is not None and spec.submodule_search_locations is not None:
        return _code_of_module(f"{name}.__main__", module)
    code = getattr(spec.loader, "get_code", lambda name: None)(name) if spec is not None else None
    if spec is None or code is None:
        raise NodeLoadError(f"{name} is not a module that can be run")
    vars(module).update(
        __file__=spec.origin, __spec__=spec, __package__=spec.parent, __loader__=spec.loader, __builtins__=__builtins__
    )
    found: CodeType = code
    return found
