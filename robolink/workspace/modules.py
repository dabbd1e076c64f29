"""Modules that are no files: a finder for `import`, with functions that know names and say how each is made."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import TypeAlias

Fill: TypeAlias = Callable[[ModuleType], None]
"""Gives a new, empty module what is in it; or puts another module in its place in `sys.modules`."""
Maker: TypeAlias = Callable[[str], "Fill | None"]
"""Gives what fills the module of a full name, ``my_msgs.msg``; None for a name that it does not know."""


class ModuleFinder:
    """Finds what its makers know, for `sys.meta_path`; it stands first there.

    An installed module or package of the same name is found instead: nothing real is hidden. That is decided for each
    module by itself: where a package `my_robot` is installed that has no `my_robot.msg`, a maker's `my_robot.msg` is
    found in it. Only a folder that Python takes for a package though it has no `__init__.py` stands back, since
    otherwise a mere folder of interface files named `my_msgs` in the working directory would be an empty package.
    """

    def __init__(self) -> None:
        self.makers: list[Maker] = []

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Give what Python needs to make a module, None for a name of others."""
        fill = next(filter(None, (maker(fullname) for maker in self.makers)), None)
        if fill is None:
            return None
        real = self._real(fullname, path, target)
        if real is not None and real.loader is not None:
            return None
        spec = ModuleSpec(fullname, _Filling(fill), is_package=True)  # type: ignore[arg-type]
        if real is not None and real.submodule_search_locations:
            spec.submodule_search_locations = list(real.submodule_search_locations)
        return spec

    def _real(self, fullname: str, path: Sequence[str] | None, target: ModuleType | None) -> ModuleSpec | None:
        """Give what is found without this finder; a folder without `__init__.py` has no loader."""
        for finder in sys.meta_path:
            if finder is not self and hasattr(finder, "find_spec"):
                spec = finder.find_spec(fullname, path, target)
                if spec is not None:
                    return spec
        return None


class _Filling:
    """Makes a module with a function that fills it. A loader without importlib.abc, which takes 2 ms to import."""

    def __init__(self, fill: Fill) -> None:
        self.fill = fill

    def create_module(self, _: ModuleSpec) -> None:
        """Leave it to Python to make an empty module."""

    def exec_module(self, module: ModuleType) -> None:
        """Fill it."""
        self.fill(module)
