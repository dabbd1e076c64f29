"""Surroundings of a launch file's code: ROS 2's names, the workspace's modules, and packages that may be missing."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from robolink import compat
from robolink.companions.ament_index.packages import packages_may_lack
from robolink.compat.launch_files import names_of_launch_files
from robolink.launch.ros.absent import Absences
from robolink.workspace import VARIABLE
from robolink.workspace.packages import import_roots, source_packages


@contextmanager
def surroundings(home: Path | None) -> Iterator[Absences]:
    """Let the code of a launch file find what it would find in ROS 2, while the block runs.

    `import launch` is robolink's, modules of the workspace's packages can be imported, and the folders of packages are
    those of the workspace `home`. Modules that nobody has are placeholders, whose finder the block gets.
    The path of imports and the environment are as before afterwards.
    """
    compat.activate(compat.ALWAYS)
    before, named = list(sys.path), os.environ.get(VARIABLE)
    if home is not None:
        roots = dict.fromkeys(root for each in source_packages(home).values() for root in import_roots(each))
        sys.path.extend(str(each) for each in roots if str(each) not in sys.path)
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
