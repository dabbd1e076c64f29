"""A workspace with types of its own, for tests."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

Write = Callable[[str, str], Path]

PACKAGES = ("zoo_msgs", "std_copy_msgs", "geometry_msgs", "plain")


def imported(name: str) -> Any:
    importlib.invalidate_caches()
    return importlib.import_module(name)
