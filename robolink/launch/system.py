"""System of a launch file of any kind: robolink's own YAML, or ROS 2's Python, XML and YAML."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeVar

from robolink.arguments.parameter_file import read_parameter_file
from robolink.arguments.undeclared import untaken
from robolink.exceptions import DocumentError
from robolink.launch.entry import ArgumentHelp, Entry, Stage, System
from robolink.launch.lookup import is_of_ros
from robolink.launch.reading.arguments import arguments_of as own_arguments_of
from robolink.launch.reading.arguments import record_of as own_record_of
from robolink.launch.reading.entries import read_launch_file, read_with_mistakes
from robolink.supervisor.director import Director
from robolink.workspace import Folder
from robolink.workspace.find import YAML

if TYPE_CHECKING:
    from robolink.launch.ros.launch import LaunchDescription
    from robolink.launch.ros.visit import Visit

T = TypeVar("T")
_NOTHING: Mapping[str, str] = MappingProxyType({})


def read_system(
    path: str | os.PathLike[str],
    given: Mapping[str, str] = _NOTHING,
    *,
    workspace: Folder = None,
    foresee: bool = False,
) -> System:
    """Read a launch file of any kind.

    Args:
        path: The launch file.
        given: Launch arguments by name, as people type them.
        workspace: Folder in which the nodes of a launch file that is in no workspace are looked up.
        foresee: True adds the entries that timers and event handlers will start, as far as that is known; then it is
            for looking, not for running.

    Returns:
        What it starts.

    Raises:
        DocumentError: for a mistake in the file, with `file:line`.
        NotFoundError: for a `workspace` that is not a folder.
    """
    path = Path(path)
    if not is_of_ros(path):
        entries = read_launch_file(path, given, workspace=workspace)
        return System(entries, list(section_notes(entries)))
    from robolink.launch.ros.visit import foresee_all, visited

    visit = visited(path, given, workspace)
    if foresee:
        foresee_all(visit)
    return _system_of(visit, foresee)


def read_description(description: LaunchDescription, path: Path, given: Mapping[str, str] = _NOTHING) -> System:
    """Read what a Python file of ROS 2 has described already.

    Args:
        description: The description.
        path: The file, for relative paths and for errors.
        given: Launch arguments by name, as people type them.

    Raises:
        DocumentError: for a mistake in it, with `file:line`.
    """
    from robolink.launch.ros.visit import visited

    return _system_of(visited(path, given, None, description), foresee=False)


def _system_of(visit: Visit, foresee: bool) -> System:
    entries = [each.entry for each in visit.started]
    notes = [*visit.context.said, *section_notes(entries)]
    visit.context.said.clear()
    if foresee or not visit.goes_on:
        return System(entries, notes)
    from robolink.launch.ros.reactions import Reactions

    def direct(stage: Stage[T]) -> Director[T]:
        return Reactions(visit, stage)

    return System(entries, notes, direct)


def read_system_with_mistakes(
    path: str | os.PathLike[str], given: Mapping[str, str] = _NOTHING, *, workspace: Folder = None
) -> tuple[System, list[DocumentError]]:
    """Read a launch file as `read_system` does, with `foresee`, but return its mistakes in place of raising them.

    Args:
        path: The launch file.
        given: Launch arguments by name, as people type them.
        workspace: As for `read_system`.
    """
    if not is_of_ros(Path(path)):
        entries, mistakes = read_with_mistakes(path, given, workspace=workspace)
        return System(entries, list(section_notes(entries))), mistakes
    try:
        return read_system(path, given, workspace=workspace, foresee=True), []
    except DocumentError as error:  # a program stops at its first one
        return System([]), [error]


def arguments_of(path: str | os.PathLike[str], *, workspace: Folder = None) -> list[ArgumentHelp]:
    """Return the arguments of a launch file of any kind, in its order.

    Args:
        path: The launch file.
        workspace: As for `read_system`.

    Raises:
        DocumentError: for a mistake in the file, with `file:line`.
    """
    if not is_of_ros(Path(path)):
        return own_arguments_of(path)
    from robolink.launch.ros import visit as reading

    return reading.arguments_of(Path(path), workspace)


def record_of(path: str | os.PathLike[str], given: Mapping[str, str] = _NOTHING) -> str | None:
    """Return the folder of the bag that a launch file asks for: '' for one by date, None for none.

    Args:
        path: The launch file.
        given: Launch arguments by name, as people type them.

    Raises:
        DocumentError: for a mistake in the file, with `file:line`.
    """
    return None if is_of_ros(Path(path)) else own_record_of(path, given)


def section_notes(entries: Iterable[Entry]) -> Iterator[str]:
    """Yield a line about each section of a parameter file whose name is misspelt, as far as that shows.

    A file that a node without a name reads itself is left out: the node tells of it.
    """
    given = [each for each in entries if each.source is not None]
    for file in dict.fromkeys(path for each in given for path in sorted(each.files) if path.name.endswith(YAML)):
        takers = [each for each in given if file in each.files]
        if any(os.fspath(file) in each.node.args for each in takers):
            continue
        try:
            overrides = read_parameter_file(file)
        except (DocumentError, OSError):  # it is a launch file
            continue
        for text in untaken(overrides, [each.full_name for each in takers]):
            yield f"{file.name}: {text}"
