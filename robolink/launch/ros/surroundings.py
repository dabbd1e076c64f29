"""Surroundings of a launch file's code: ROS 2's names, the workspace's modules, and packages that may be missing."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from robolink import compat
from robolink.companions.ament_index.packages import packages_may_lack
from robolink.compat.launch_files import names_of_launch_files
from robolink.launch.ros.absent import Absences
from robolink.workspace import VARIABLE
from robolink.workspace.packages import import_roots, source_packages


def roots_of(home: Path | None) -> list[str]:
    """Return the folders from which the packages of a workspace are imported; None has none."""
    if home is None:
        return []
    return list(dict.fromkeys(str(root) for each in source_packages(home).values() for root in import_roots(each)))


@contextmanager
def surroundings(home: Path | None, roots: Sequence[str] | None = None) -> Iterator[Absences]:
    """Let the code of a launch file find what it would find in ROS 2, while the block runs.

    `import launch` is robolink's, modules of the workspace's packages can be imported, and the folders of packages are
    those of the workspace `home`. Modules that nobody has are placeholders, whose finder the block gets.
    The path of imports and the environment are as before afterwards. `roots` are those of `home`, if they are known
    already: to list the folders of a workspace at each event takes too long.
    """
    compat.activate(compat.ALWAYS)
    before, named = list(sys.path), os.environ.get(VARIABLE)
    if home is not None:
        sys.path.extend(each for each in (roots_of(home) if roots is None else roots) if each not in sys.path)
        os.environ[VARIABLE] = str(home)
    try:
        with packages_may_lack(), names_of_launch_files(), Absences() as absences:
            yield absences
    finally:
        sys.path[:] = before
        if named is None:
            os.environ.pop(VARIABLE, None)
        else:
            os.environ[VARIABLE] = named
