"""Folder of a student: the files of the exercises, the progress, and a watch that checks what is saved."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path

import msgspec
from msgspec import Struct

from robolink.exceptions import DocumentError, NotFoundError, RobolinkError, closest
from robolink.grading.languages import STUDENT_FILE, Language, default_language, student_file
from robolink.learn.exercise import Exercise, chosen, read_course
from robolink.learn.words import words
from robolink.supervisor.monitoring.file_watch import Changes
from robolink.system.files import expanded, is_file, write_new, write_whole

DEFAULT = "learn_robolink"
"""Name of the folder that `start` makes."""
LARGEST = 1_000_000
"""Most bytes of a file with a student's progress."""
EVERY = 0.2
"""Period of its looks at the files, in seconds."""


class NoFolderError(RobolinkError, LookupError):
    """The working directory is in no folder of exercises."""


class Progress(Struct):
    """Content of the file."""

    language: Language = "en"
    source: str = ""
    """Folder of a teacher's exercises; '' for those that come with robolink."""
    done: list[str] = []
    """Names of the exercises that are done."""
    hints: dict[str, int] = {}
    """Number of hints that were shown, by exercise."""

    def finish(self, name: str) -> None:
        """Note that an exercise is done."""
        if name not in self.done:
            self.done.append(name)

    def forget(self, name: str) -> None:
        """Note that an exercise is as it was at the beginning."""
        self.done = [each for each in self.done if each != name]
        self.hints.pop(name, None)

    def next_hint(self, name: str, most: int) -> int:
        """Count a hint, and return its number, from 1 on; `most` again after the last, and 0 if there are none."""
        self.hints[name] = min(max(self.hints.get(name, 0), 0) + 1, most)
        return self.hints[name]


class StudentFolder:
    """The exercises of a student, in a folder of theirs.

    Args:
        path: The folder.
        progress: Its progress.
    """

    def __init__(self, path: Path, progress: Progress) -> None:
        self.path, self.progress = path, progress
        self.course = read_course(Path(progress.source) if progress.source else None)

    @property
    def language(self) -> Language:
        """Language in which the student is spoken to."""
        return self.progress.language

    @property
    def next(self) -> Exercise | None:
        """First exercise that is not done; None if all are."""
        return next((each for each in self.course if each.name not in self.progress.done), None)

    @property
    def done(self) -> int:
        """Number of exercises that are done."""
        return sum(each.name in self.progress.done for each in self.course)

    def file_of(self, exercise: Exercise) -> Path:
        """Return the path of a student's file."""
        return self.path / exercise.file

    def chosen(self, name: str = "") -> Exercise:
        """Return the exercise of a name, number or file; the next one for '', and the last one if all are done.

        Raises NotFoundError with the nearest name, in the folder's language.
        """
        if not name:
            return self.next or self.course[-1]
        try:
            return chosen(self.course, name)
        except NotFoundError as error:
            near = closest(name, [each.name for each in self.course])
            nearest = words(self.language, "nearest", name=near) if near else ""
            error.args = (words(self.language, "no exercise", name=name[:100], nearest=nearest),)
            raise

    def write(self) -> list[str]:
        """Write the given files that are not there yet; return their names."""
        self.path.mkdir(parents=True, exist_ok=True)
        missing = [each for each in self.course if not os.path.lexists(self.file_of(each))]
        for each in missing:
            write_new(self.file_of(each), each.given_text(self.language).encode())
        save_progress(self.path, self.progress)
        return [each.file for each in missing]

    def reset(self, exercise: Exercise) -> Path | None:
        """Write the given file of an exercise again; return where the student's own is kept, None if there was none."""
        path, given = self.file_of(exercise), exercise.given_text(self.language).encode()
        saved = _free(path) if os.path.lexists(path) else None
        if saved is not None:
            path.rename(saved)
        try:
            write_new(path, given)
        except OSError:
            if saved is not None:
                saved.rename(path)
            raise
        with self._changed() as progress:
            progress.forget(exercise.name)
        return saved

    def next_hint(self, exercise: Exercise) -> int:
        """Return the number of the next hint, from 1 on; the last one again after the last, and 0 if there are none."""
        with self._changed() as progress:
            return progress.next_hint(exercise.name, len(exercise.settings.hints))

    def finish(self, exercise: Exercise) -> None:
        """Note that an exercise is done."""
        with self._changed() as progress:
            progress.finish(exercise.name)

    def speak(self, language: Language) -> None:
        """Set the language, and keep it."""
        if language != self.progress.language:
            with self._changed() as progress:
                progress.language = language

    def reload(self) -> None:
        """Read the progress again, which another command may have changed. Raises DocumentError if it cannot be."""
        self.progress = load_progress(self.path)

    @contextlib.contextmanager
    def _changed(self) -> Iterator[Progress]:
        """Provide the progress as the file has it by now, to be changed, and write it: `watch` runs beside others."""
        with contextlib.suppress(DocumentError):  # somebody has removed or broken the file: ours is as good
            self.reload()
        yield self.progress
        save_progress(self.path, self.progress)


def find_folder() -> StudentFolder | None:
    """Return the student's folder at or above the working directory; None if there is none."""
    file = student_file()
    return None if file is None else StudentFolder(file.parent, load_progress(file.parent))


def the_folder() -> StudentFolder:
    """Return the student's folder at or above the working directory. Raises NoFolderError if there is none."""
    found = find_folder()
    if found is None:
        raise NoFolderError(_where_to_go())
    return found


def _where_to_go() -> str:
    below = folder_below()
    language = default_language()
    return words(language, "go below", folder=below) if below else words(language, "no exercises", folder=DEFAULT)


def folder_below() -> str:
    """Return the name of a student's folder in the working directory, preferably the usual one; '' for none."""
    names = sorted(each.parent.name for each in Path.cwd().glob(f"*/{STUDENT_FILE}"))
    return DEFAULT if DEFAULT in names else next(iter(names), "")


def start_folder(path: str = "", *, language: Language | None = None, source: str = "") -> StudentFolder:
    """Return the student's folder at a path, with the progress that it has or a new one; nothing is written yet.

    Args:
        path: The folder; '' is the one in which the student is, or else `DEFAULT` in the working directory.
        language: Language to speak; None keeps that of the folder, or takes that of the locale.
        source: Folder of a teacher's exercises; '' for those that come with robolink.
    """
    if not path:
        found = find_folder()
        folder = Path.cwd() / DEFAULT if found is None else found.path
    else:
        folder = expanded(path).absolute()
    is_old = is_file(folder / STUDENT_FILE)
    progress = load_progress(folder) if is_old else Progress(language or default_language())
    progress.language = language or progress.language
    if source:
        progress.source = str(expanded(source).resolve())
    return StudentFolder(folder, progress)


def _free(path: Path) -> Path:
    """Return a name for a file that is put aside, which no other has: 02_stop.mine.py, 02_stop.mine2.py ..."""
    number = 1
    free = path.with_name(f"{path.stem}.mine{path.suffix}")
    while os.path.lexists(free):
        number += 1
        free = path.with_name(f"{path.stem}.mine{number}{path.suffix}")
    return free


def load_progress(folder: Path) -> Progress:
    """Read the progress of a folder. Raises DocumentError if the file cannot be read."""
    path = folder / STUDENT_FILE
    try:
        with path.open("rb") as file:
            return msgspec.json.decode(file.read(LARGEST), type=Progress)
    except (OSError, msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise DocumentError(
            f"{reason}; delete this file and run `robolink learn start {folder}`: your programs stay", str(path)
        ) from None


def save_progress(folder: Path, progress: Progress) -> None:
    """Write the progress of a folder, as a whole or not at all. Raises OSError."""
    write_whole(folder / STUDENT_FILE, msgspec.json.format(msgspec.json.encode(progress)) + b"\n")


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
