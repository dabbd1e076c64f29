"""Traversal of a launch description and of the files that it includes, as far as it is known before it runs."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from robolink.companions.launch.bases import Action, LaunchContext, LaunchDescriptionEntity, Place

DEEPEST = 50
"""Deepest nesting of included files."""
FILES = ("current_launch_file_path", "current_launch_file_directory")
"""Locals of a launch file; those of the file around count again behind the included one."""
MOST_DESCRIBED = 10_000
"""Upper bound of the entities that are looked through."""


class Described(NamedTuple):
    """Entity of a launch description.

    Args:
        entity: The entity.
        files: Paths of the launch files around it, the outermost first.
        is_certain: True if no condition stands before it.
        circle: Sentence about the launch file that includes itself here; '' elsewhere.
        place: Place of that inclusion.
    """

    entity: LaunchDescriptionEntity
    files: tuple[str, ...] = ()
    is_certain: bool = True
    circle: str = ""
    place: Place = Place()


def described(top: Described, context: LaunchContext) -> Iterator[Described]:
    """Yield an entity, `top`, and what it holds and includes, in its order; `context` has the values for paths."""
    left, waiting = MOST_DESCRIBED, [top]
    while waiting and left:
        each = waiting.pop(0)
        left -= 1
        yield each
        if not each.circle:
            waiting[:0] = _inside(each, context)


def _inside(each: Described, context: LaunchContext) -> Iterator[Described]:
    if isinstance(each.entity, Action) and hasattr(each.entity, "launch_description_source"):
        yield from _included(each, each.entity, context)
        return
    certain = [(one, each.is_certain) for one in each.entity.describe_sub_entities()]
    uncertain = [(one, False) for _, some in each.entity.describe_conditional_sub_entities() for one in some]
    for one, is_certain in (*certain, *uncertain):
        if isinstance(one, LaunchDescriptionEntity):
            yield Described(one, each.files, is_certain)


def _included(each: Described, action: Action, context: LaunchContext) -> Iterator[Described]:
    """Yield the description that an action includes; nothing if its file cannot be read, or is not known yet."""
    source, files = getattr(action, "launch_description_source"), each.files  # noqa: B009 - only inclusions have it
    if files:
        context.extend_locals({FILES[0]: files[-1], FILES[1]: str(Path(files[-1]).parent)})
    try:
        description = source.get_launch_description(context)
    except Exception:  # noqa: BLE001 - the file is a program
        return
    path = os.path.abspath(source.location) if Path(source.location).is_file() else ""  # noqa: PTH100 - links stay
    is_certain = each.is_certain and action.condition is None
    if len(files) <= DEEPEST:
        own = (*files, path) if path else files
        yield Described(description, own, is_certain, circle(files, path), action.place)


def circle(files: Sequence[str], path: str) -> str:
    """Return the sentence that launch files include each other; '' if they do not.

    Args:
        files: Paths of the files around, the outermost first.
        path: Path of the file that is included.
    """
    if path not in files:
        return ""
    names = [Path(each).name for each in (*files[files.index(path) :], path)]
    return f"a launch file cannot include itself: {' -> '.join(names)}"
