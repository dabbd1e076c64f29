"""Import finder for modules that are not files, with functions that know names and how each module is made.

It also changes modules of others, once they are loaded.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any, TypeAlias

Fill: TypeAlias = Callable[[ModuleType], None]
"""Function that fills a new, empty module; or puts another module in its place in `sys.modules`."""
Maker: TypeAlias = Callable[[str], "Fill | None"]
"""Function that returns the Fill of a module's full name, ``my_msgs.msg``; None for a name that it does not know."""


class ModuleFinder:
    """Finder on `sys.meta_path`, in front, of the modules that its makers know; the first that knows a name makes it.

    An installed module or package of the same name is found instead, unless `hides(name)` is true. That is decided for
    each module by itself: where a package `my_robot` is installed that has no `my_robot.msg`, a maker's `my_robot.msg`
    is found in it. Only a folder that Python takes for a package though it has no `__init__.py` stands back, since
    otherwise a mere folder of interface files named `my_msgs` in the working directory would be an empty package.
    """

    def __init__(self) -> None:
        self.makers: list[Maker] = []
        self.hides: Callable[[str], bool] = lambda _: False
        self.changes: dict[str, Fill] = {}
        """Functions that change a module of others after it was loaded, by its name."""
        self._changing: set[str] = set()

    def change(self, fullname: str, act: Fill) -> None:
        """Call `act(module)` whenever a module of others with this name has been loaded."""
        self.changes[fullname] = act
        self._ask_first()

    def add(self, maker: Maker, *, first: bool = False) -> None:
        """Add a maker, before or after those that are there; make Python ask this finder first."""
        if maker not in self.makers:
            self.makers.insert(0 if first else len(self.makers), maker)
        self._ask_first()

    def _ask_first(self) -> None:
        if self not in sys.meta_path:
            sys.meta_path.insert(0, self)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec from which Python makes a module, None for a name of others."""
        if fullname in self.changes and fullname not in self._changing:
            return self._changed(fullname, path, target)
        fill = next(filter(None, (maker(fullname) for maker in self.makers)), None)
        if fill is None:
            return None
        real = None if self.hides(fullname) else self.real(fullname, path, target)
        if real is not None and real.loader is not None:
            return None
        spec = ModuleSpec(fullname, Filling(fill), is_package=True)  # type: ignore[arg-type]
        if real is not None and real.submodule_search_locations:
            spec.submodule_search_locations = list(real.submodule_search_locations)
        return spec

    def _changed(self, fullname: str, path: Sequence[str] | None, target: ModuleType | None) -> ModuleSpec | None:
        """Return the spec of a module that is changed once it is loaded."""
        spec = self.real(fullname, path, target)
        if spec is not None and spec.loader is not None and hasattr(spec.loader, "exec_module"):
            spec.loader = Changing(spec.loader, self.changes[fullname], self._changing)  # type: ignore[assignment]
        return spec

    def real(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec that is found without this finder; that of a folder without `__init__.py` has no loader."""
        for finder in sys.meta_path:
            if finder is not self and hasattr(finder, "find_spec"):
                spec = finder.find_spec(fullname, path, target)
                if spec is not None:
                    return spec
        return None


class Filling:
    """Loader that makes a module by a function that fills it. Without importlib.abc, which takes 2 ms to import."""

    def __init__(self, fill: Fill) -> None:
        self.fill = fill

    def create_module(self, _: ModuleSpec) -> None:
        """Leave it to Python to make an empty module."""

    def exec_module(self, module: ModuleType) -> None:
        """Fill it."""
        self.fill(module)


class Changing:
    """Loader that loads a module as another one does, and then changes it; the module remembers the other one only.

    cv2, for one, imports its library by its own name while it is loaded: that one is not changed, hence `busy`, the
    names of the modules that are being loaded.
    """

    def __init__(self, loader: Any, act: Fill, busy: set[str]) -> None:
        self._loader, self._act, self._busy = loader, act, busy

    def __getattr__(self, name: str) -> Any:
        return getattr(self._loader, name)  # who asks for a module's spec may want its file or its code

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        """Make the module as the other loader does."""
        made: ModuleType | None = self._loader.create_module(spec)
        return made

    def exec_module(self, module: ModuleType) -> None:
        """Load it, and change it."""
        name = module.__name__
        module.__loader__ = self._loader
        if module.__spec__ is not None:
            module.__spec__.loader = self._loader
        self._busy.add(name)
        try:
            self._loader.exec_module(module)
        finally:
            self._busy.discard(name)
        self._act(module)


FINDER = ModuleFinder()
"""The one finder of a process, for all that are not files: a workspace's types, and the names of `robolink.compat`."""
