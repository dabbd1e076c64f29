"""Watch mode: an exercise is checked again each time its file is saved."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from robolink.learn.exercise import Exercise
from robolink.learn.folder import StudentFolder
from robolink.supervisor.monitoring.file_watch import Changes

EVERY = 0.2
"""Period of its looks at the files, in seconds."""


class Watch:
    """Watcher of a student's files.

    Args:
        folder: The student's folder.
        check: Called with each exercise whose file was saved.
        changes: Change detection; by default by the files' times and sizes.
    """

    def __init__(
        self, folder: StudentFolder, check: Callable[[Exercise], object], *, changes: Changes | None = None
    ) -> None:
        self._check, self._changes = check, changes or Changes()
        self._exercises: dict[Path, Exercise] = {folder.file_of(each): each for each in folder.course}
        self._changes.follow(self._exercises)

    def look(self) -> None:
        """Poll once, and check what was saved."""
        for path in sorted(self._changes.look()):
            self._check(self._exercises[path])
