"""Reader of ROS 2 launch files: loads one, visits its description, and returns what it starts at once."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.companions.launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from robolink.companions.launch.bases import LaunchContext, LaunchError
from robolink.companions.launch.described import FILES, Described, described
from robolink.companions.launch.launch_description_sources import AnyLaunchDescriptionSource, LaunchDescriptionSource
from robolink.companions.launch.utilities import perform_substitutions
from robolink.exceptions import DocumentError, nearest
from robolink.launch.entry import ArgumentHelp
from robolink.launch.lookup import home_of
from robolink.launch.ros.entries import EntryMaker
from robolink.launch.ros.surroundings import surroundings
from robolink.launch.ros.visit import Visit
from robolink.system.terminal import shown
from robolink.workspace import Folder

if TYPE_CHECKING:
    from robolink.companions.launch.bases import LaunchDescriptionEntity
    from robolink.companions.launch.launch_description import LaunchDescription


def visited(
    path: Path, given: Mapping[str, str], workspace: Folder, description: LaunchDescription | None = None
) -> Visit:
    """Return the visit of a launch file, up to the point at which only time and events go on.

    Args:
        path: The launch file.
        given: Launch arguments by name, as people type them.
        workspace: Folder in which the packages of a file outside of all workspaces are looked up.
        description: Description that the file has made already; None reads it from the file.

    Raises:
        DocumentError: for a mistake, with the file and line of the user's code.
        NotFoundError: for a `workspace` that is not a folder.
    """
    path = path.absolute()
    home = home_of(path, workspace)
    with surroundings(home) as absences:
        context = LaunchContext(argv=[f"{name}:={value}" for name, value in given.items()])
        absences.say = context.said.append
        context.launch_configurations.update(given)
        visit = Visit(context, EntryMaker(home, context.said.append), path)
        visit.first = _included(path, description)
        visit.run([visit.first])
    if description is None:  # else whoever made it may read them
        _note_unread(context, given)
    return visit


def foresee_all(visit: Visit) -> None:
    """Add to a visit what timers and event handlers will start, as far as that is known. Raises DocumentError."""
    with surroundings(visit.maker.home) as absences:
        absences.say = visit.context.said.append
        visit.foresee()


def arguments_of(path: Path, workspace: Folder = None) -> list[ArgumentHelp]:
    """Return the arguments that a launch file and those that it includes declare, in their order.

    Args:
        path: The launch file.
        workspace: As for `visited`.

    Raises:
        DocumentError: for a mistake, with the file and line of the user's code.
    """
    path = path.absolute()
    with surroundings(home_of(path, workspace)):
        context = LaunchContext()
        visit = Visit(context, EntryMaker(None, context.said.append), path)
        with visit.placing(None):
            description = AnyLaunchDescriptionSource(str(path)).get_launch_description(context)
            return [_help(each, context) for each in _declared(description, path, context)]


def _declared(description: LaunchDescription, path: Path, context: LaunchContext) -> list[DeclareLaunchArgument]:
    """Return the arguments that the description in the file at `path` declares, each name once.

    Raises DocumentError where files include each other in a circle, and none of them declares any.
    """
    found: dict[str, DeclareLaunchArgument] = {}
    circles = []
    for each in described(Described(description, (str(path),)), context):
        if isinstance(each.entity, DeclareLaunchArgument):
            found.setdefault(each.entity.name, each.entity)
        elif each.circle and each.is_certain:
            circles.append(DocumentError(each.circle, each.place.file, each.place.line))
    if circles and not found:
        raise circles[0]
    context.extend_locals({FILES[0]: str(path), FILES[1]: str(path.parent)})
    return list(found.values())


def _included(path: Path, description: LaunchDescription | None) -> LaunchDescriptionEntity:
    """Return the action that includes the launch file itself; it has no place of its own."""
    read = LaunchDescriptionSource(description, str(path)) if description is not None else None
    action = IncludeLaunchDescription(read or AnyLaunchDescriptionSource(str(path)))
    action.place = action.place._replace(file="", line=0)
    return action


def _help(declared: DeclareLaunchArgument, context: LaunchContext) -> ArgumentHelp:
    default = None
    if declared.default_value is not None:
        try:
            default = perform_substitutions(context, declared.default_value)
        except (LaunchError, DocumentError):
            default = "".join(getattr(each, "text", each.describe()) for each in declared.default_value)
        context.launch_configurations.setdefault(declared.name, default)
    description = "" if declared.description == DeclareLaunchArgument.NO_DESCRIPTION else declared.description
    return ArgumentHelp(declared.name, default, description, tuple(declared.choices or ()))


def _note_unread(context: LaunchContext, given: Mapping[str, str]) -> None:
    """Add a line for each given argument that nothing has declared or read: ROS 2 takes them in silence."""
    for name in given:
        if name not in context.asked:
            hint = nearest(name, context.asked) or f": there is {', '.join(sorted(context.asked)) or 'none'}"
            context.said.append(f"nothing reads the argument '{shown(name)}'{hint}")
