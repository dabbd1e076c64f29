"""Undeclared parameters: warnings of those that no node of a program declares, and of file sections that none takes.

Most are misspelt, and ROS 2 keeps silent about them. The section `/**` of a file is for any node: no warning.
"""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING, Protocol

from robolink.arguments.overrides import Override
from robolink.exceptions import ExternalShutdownException, closest, nearest
from robolink.logging import get_logger
from robolink.system.patterns import late
from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.arguments.command_line import Arguments
    from robolink.impl.rcutils_logger import RcutilsLogger

ALIKE = 0.75
"""Least similarity (difflib's ratio) by which a given name is a misspelt parameter, or a section's a misspelt node."""


class OverriddenNode(Protocol):
    """Node whose declared parameters are compared with the overrides given to it."""

    _arguments_: Arguments
    _declared_so_far_: set[str]

    def get_fully_qualified_name(self) -> str:
        """Return namespace and name."""

    def get_logger(self) -> RcutilsLogger:
        """Return the logger that carries the node's name."""


class GivenParameters:
    """Parameters of a context's command line that its nodes have not declared so far: ROS 2 is silent about a typo.

    When nodes begin to spin, it warns only of a name that is nearly that of a parameter which was declared and not
    given: another may still be declared, as by a lifecycle node when it is configured. The rest follows at the end.

    Nodes that share a process may each have a command line of its own: what one is given is none of the others'.
    """

    def __init__(self) -> None:
        self._open: dict[int, tuple[Override, str]] = {}
        self._seen: dict[int, Override] = {}
        self._declared: set[str] = set()
        self._names: dict[str, str] = {}
        """Loggers of the nodes that were given files, by full name."""
        self._files: dict[int, Override] = {}
        self._reported: set[str] = set()

    def expect(self, node: OverriddenNode, overrides: Iterable[Override]) -> None:
        """Note what is given to a new node."""
        full_name = node.get_fully_qualified_name()
        overrides = list(overrides)
        of_files = {id(each): each for each in overrides if not each.is_typed}
        if of_files:
            self._names[full_name] = node.get_logger().name
            self._files.update(of_files)
        for each in {(each.pattern, each.name): each for each in overrides}.values():
            if id(each) not in self._seen and each.is_meant_for(full_name):
                self._seen[id(each)] = each
                self._open[id(each)] = each, node.get_logger().name

    def look(self, node: OverriddenNode) -> None:
        """Note what a node has declared by now; at its end, at the latest."""
        if not self._open:
            return
        full_name, declared = node.get_fully_qualified_name(), node._declared_so_far_
        self._declared |= declared
        for each in node._arguments_.parameter_overrides:
            if each.name in declared and each.is_for(full_name):
                self._open.pop(id(each), None)

    def warn_of_typos(self, nodes: Iterable[OverriddenNode]) -> None:
        """Warn, once, of names that are nearly those of parameters that the nodes have, and of sections for no node."""
        self._warn_of_sections()
        if not self._open:
            return
        nodes = list(nodes)
        for node in nodes:
            self.look(node)
        given = {each.name for each in self._seen.values()}
        for key, (each, logger) in list(self._open.items()):
            own = (node._declared_so_far_ for node in nodes if each.is_for(node.get_fully_qualified_name()))
            near = closest(each.name, set().union(*own) - given, ALIKE)
            if near:
                del self._open[key]
                _warn(each, logger, f"no node has declared it so far (did you mean '{near}'?)")

    def _warn_of_sections(self) -> None:
        for text in untaken(self._files.values(), self._names) if self._files else ():
            if text not in self._reported:
                self._reported.add(text)
                get_logger(next(iter(self._names.values()))).warning(f"in a parameter file, {text}")

    def warn_of_rest(self) -> None:
        """Warn of all that no node has declared: this is the end. An error that ends the program says enough."""
        error = sys.exc_info()[1]
        if isinstance(error, Exception) and not isinstance(error, ExternalShutdownException):
            return
        for each, logger in self._open.values():  # a name may be declared by another node than the one it was given to
            _warn(each, logger, f"no node declared it{nearest(each.name, self._declared - {each.name})}")
        self._open.clear()


def _warn(override: Override, logger: str, what: str) -> None:
    get_logger(logger).warning(f"parameter '{override.name}' was given, but {what}")


_NUMBER = late(r"[0-9]+")

MOST = 3
"""Largest number of sections that are reported where nothing of all files is for any node."""


def untaken(overrides: Iterable[Override], names: Collection[str]) -> Iterator[str]:
    """Yield a line for each section of files that is for no node, as "'batery' is not the name of a node ...".

    A file may be for more nodes than are here, so a section is reported only if it is the one nearest to the name of a
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
    reported = [each for each in lost if each in meant or not has_taker]
    most = len(reported) if has_taker else MOST
    for pattern in reported[:most]:
        name = meant.get(pattern)
        hint = f"did you mean '{name.lstrip('/')}'?" if name else _listed(names)
        yield f"'{shown(pattern.lstrip('/'))}' is not the name of a node that gets it ({hint})"
    if reported[most:]:
        yield f"{len(reported) - most} other sections are for no node that gets it, either"


def _misspelt_for(name: str, lost: Iterable[str]) -> str:
    """Return the section nearest to a node's name; '' if none is. Of a fleet, names differ in their numbers alone."""
    plain = _NUMBER.sub("", name)
    return closest(name, [each for each in lost if _NUMBER.sub("", each) != plain], ALIKE)


def _listed(names: Iterable[str]) -> str:
    return ", ".join(f"'{each.lstrip('/')}'" for each in sorted(names)[:3])
