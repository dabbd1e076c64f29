"""File watcher by polling: restarts a process when one of its source files is saved (`launch --watch`)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

from robolink.supervisor.monitoring.imports import Imports, parse
from robolink.supervisor.monitoring.periodic import PeriodicThread

Stamp: TypeAlias = "tuple[int, int, int] | None"
"""Fingerprint of a file: modification time, size and inode; None while the file does not exist."""


class Changes:
    """Change detection of files between polls, with debouncing.

    A change counts once the file is the same in two polls: an editor may be half way through writing it, or have
    moved it aside to put a new one in its place.
    """

    def __init__(self, stamp: Callable[[Path], Stamp] | None = None) -> None:
        self._stamp = stamp or stamp_of
        self._known: dict[Path, Stamp] = {}
        self._seen: dict[Path, Stamp] = {}

    def follow(self, paths: Iterable[Path]) -> None:
        """Add files; their present content is no change."""
        for path in paths:
            if path not in self._known:
                self._known[path] = self._seen[path] = self._stamp(path)

    def look(self) -> set[Path]:
        """Poll once; return the files that were saved and are stable now."""
        saved = set()
        for path, known in self._known.items():
            stamp = self._stamp(path)
            if stamp is not None and stamp != known and stamp == self._seen[path]:
                saved.add(path)
            self._seen[path] = stamp
        for path in saved:
            self._known[path] = self._seen[path]
        return saved


def stamp_of(path: Path) -> Stamp:
    """Return the fingerprint of a file."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


class Watch(PeriodicThread):
    """Periodic thread that calls `restart` with the name of each process one of whose files was saved.

    `files` are the Python files of each process; their imports, from their folder or from `roots`, are watched as well.
    A syntax error delays the restart until it is fixed, and is reported. A change of one of `settings`, which are
    read only when the whole system is started, is reported too.
    """

    def __init__(
        self,
        files: Mapping[str, Sequence[Path]],
        *,
        restart: Callable[[str], object],
        say: Callable[[str], object],
        roots: Iterable[Path] = (),
        settings: Iterable[Path] = (),
        every: float = 0.5,
        changes: Changes | None = None,
    ) -> None:
        self._files = files
        self._restart, self._say = restart, say
        self._imports = Imports(roots)
        self._settings = set(settings)
        self._broken: dict[Path, str] = {}
        self._changes = changes or Changes()
        self._made_of = self._gathered()
        super().__init__("watch", every)

    def look(self) -> None:
        """Poll once, and restart what has changed."""
        saved = self._changes.look()
        for path in sorted(saved & self._settings):
            self._say(f"{path} has changed: that counts when the system is started anew")
        concerned = {name: made_of for name, made_of in self._made_of.items() if made_of & saved}
        if not concerned:
            return
        for path in sorted(saved.intersection(set().union(*concerned.values()))):
            self._read(path)
        self._made_of = self._gathered()
        self._decide(list(concerned))

    def _read(self, path: Path) -> None:
        """Check the syntax of a Python file that was saved."""
        self._imports.forget(path)
        try:
            parse(path)
        except OSError as error:
            self._broken[path] = f"{path}: {error.strerror or error}"
        except SyntaxError as error:
            self._broken[path] = f"{path}:{error.lineno or 1}:{error.offset or 1}: {error.msg}"
        else:
            self._broken.pop(path, None)
            self._say(f"{path} was saved")

    def _decide(self, names: list[str]) -> None:
        """Restart the processes without syntax errors; report once for each broken file which ones wait for it."""
        waiting: dict[Path, list[str]] = {}
        for name in names:
            broken = sorted(self._made_of[name] & self._broken.keys())
            if broken:
                waiting.setdefault(broken[0], []).append(name)
            else:
                self._restart(name)
        for path, held in waiting.items():
            self._say(f"{self._broken[path]}: not restarted until that is mended: {', '.join(held)}")

    def _gathered(self) -> dict[str, set[Path]]:
        """Return all source files of each process, also those that do not exist yet, and follow them."""
        imports = self._imports
        made_of = {
            name: {file for path in paths for file in imports.of(path) | imports.absent_of(path)}
            for name, paths in self._files.items()
        }
        self._changes.follow(self._settings.union(*made_of.values()))
        return made_of
