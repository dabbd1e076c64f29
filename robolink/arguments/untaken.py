"""Sections of parameter files that no node takes: most names are misspelt, and ROS 2 keeps silent about them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from robolink.arguments.overrides import Override
from robolink.exceptions import closest
from robolink.system.terminal import shown

ALIKE = 0.75
"""Least similarity of a section's name and a node's (difflib's ratio) by which one is misspelt for the other."""


def untaken(overrides: Iterable[Override], names: Collection[str]) -> Iterator[str]:
    """Yield what is wrong with each section of files that is for no node, as in "'batery' is no node's name ...".

    A file may be for more nodes than are here, so a section is told of only if its name is nearly that of a node, or if
    nothing of all files is for any node.

    Args:
        overrides: What the files hold.
        names: Full names of the nodes that the files were given to.
    """
    patterns = {each.pattern: each for each in overrides if not each.is_typed}
    known = set(names)
    lost = [each for each in patterns if "*" not in each and each not in known]
    if not lost:
        return
    free = sorted(known - patterns.keys())
    has_taker = len(free) < len(known) or any(each.is_for(name) for each in patterns.values() for name in free)
    for pattern in lost:
        near = closest(pattern, free, ALIKE)
        if near or not has_taker:
            hint = f"did you mean '{near.lstrip('/')}'?" if near else _listed(names)
            yield f"'{shown(pattern.lstrip('/'))}' is not the name of a node that gets it ({hint})"


def _listed(names: Iterable[str]) -> str:
    return ", ".join(f"'{each.lstrip('/')}'" for each in sorted(names)[:3])
