"""Loader of the repository's node files, which are no package."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).parents[2]


def load_node_file(name: str) -> ModuleType:
    """Give the module of ``nodes/NAME.py``, always the same one."""
    path = ROOT / "nodes" / f"{name}.py"
    if loaded := sys.modules.get(str(path)):
        return loaded
    spec = importlib.util.spec_from_file_location(str(path), path)
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[str(path)] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
