"""Source of a node: a file, or a module of a package; and the workspace that comes with robolink."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple, TypeAlias

Folder: TypeAlias = "str | os.PathLike[str] | None"


class NodeSource(NamedTuple):
    """Source of a node, `name`: the file `path` and its `attribute` ('' for the only node).

    A file of a package is imported as `module`, with `root` on `sys.path`, so that it can import its neighbours. A file
    without a `module` may have a `root`, too.
    """

    name: str
    path: Path
    attribute: str = ""
    module: str = ""
    root: Path | None = None

    @property
    def spec(self) -> str:
        """Text that finds this again from anywhere: `PATH` or `PATH:attribute`."""
        return f"{self.path}:{self.attribute}" if self.attribute else str(self.path)


def canonical(name: str) -> str:
    """Return `name` with `-` as `_`, since the two are the same in names."""
    return name.replace("-", "_")


PACKAGE = Path(__file__).resolve().parent.parent
"""Folder of the package `robolink`."""


def built_in_workspace() -> Path:
    """Return the workspace that comes with robolink: inside the wheel, or the repository."""
    shared = PACKAGE / "share"
    return shared if shared.is_dir() else PACKAGE.parent
