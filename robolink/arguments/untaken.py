"""Sections of parameter files that no node takes: most names are misspelt, and ROS 2 keeps silent about them."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator

from robolink.arguments.overrides import Override
from robolink.exceptions import closest
from robolink.system.terminal import shown

_NUMBER = re.compile(r"[0-9]+")

ALIKE = 0.75
"""Least similarity of a section's name and a node's (difflib's ratio) by which one is misspelt for the other."""


MOST = 3
"""Largest number of sections that are told of where nothing of all files is for any node."""


def untaken(overrides: Iterable[Override], names: Collection[str]) -> Iterator[str]:
    """Yield a line for each section of files that is for no node, as "'batery' is not the name of a node ...".

    A file may be for more nodes than are here, so a section is told of only if it is the one nearest to the name of a
    node that has none, or if nothing of all files is for any node.

    Args:
        overrides: The parameters of the files.
        names: Full names of the nodes that the files were given to.
    """
    patterns = {each.pattern: each for each in overrides if not each.is_typed}
    known = set(names)
    lost = [each for each in patterns if "*" not in each and each not in known]
    if not lost:
        return
    free = sorted(known - patterns.keys())
    meant = {_misspelt_for(name, lost): name for name in reversed(free)}
    has_taker = len(free) < len(known) or any(each.is_for(name) for each in patterns.values() for name in free)
    told = [each for each in lost if each in meant or not has_taker]
    most = len(told) if has_taker else MOST
    for pattern in told[:most]:
        name = meant.get(pattern)
        hint = f"did you mean '{name.lstrip('/')}'?" if name else _listed(names)
        yield f"'{shown(pattern.lstrip('/'))}' is not the name of a node that gets it ({hint})"
    if told[most:]:
        yield f"{len(told) - most} other sections are for no node that gets it, either"


def _misspelt_for(name: str, lost: Iterable[str]) -> str:
    """Return the section nearest to a node's name; '' if none is. Of a fleet, names differ in their numbers alone."""
    plain = _NUMBER.sub("", name)
    return closest(name, [each for each in lost if _NUMBER.sub("", each) != plain], ALIKE)


def _listed(names: Iterable[str]) -> str:
    return ", ".join(f"'{each.lstrip('/')}'" for each in sorted(names)[:3])
