"""Exercises of a student's folder for the page of `robolink view`: each is checked when its file is saved."""

from __future__ import annotations

import contextlib
import itertools
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.grading.languages import LANGUAGES, STUDENT_FILE, Language
from robolink.learn.checking import check_apart
from robolink.learn.exercise import Exercise
from robolink.learn.folder import EVERY, StudentFolder, Watch
from robolink.learn.lines import findings, printed_lines
from robolink.learn.report import Report
from robolink.learn.words import words
from robolink.supervisor.monitoring.file_watch import Changes
from robolink.supervisor.monitoring.periodic import PeriodicThread
from robolink.system import waits
from robolink.system.files import read_plain
from robolink.system.terminal import fit, shown

Check = Callable[..., Report]
Operation = dict[str, Any]
"""Operation for the page, as `robolink.view.server.learning` describes it: its name under `op`, and its fields."""
LARGEST_CODE = 100_000
"""Largest file whose code the page shows, in bytes."""
WARNING, ERROR = 1, 2
"""Levels of a status that the page shows."""


class FolderError(RobolinkError, OSError):
    """A student's folder cannot be read or written; the text says why."""


class PageExercises:
    """Exercises as the page shows them, checked one after the other on a thread of their own.

    Args:
        folder: The student's folder.
        reported: Called on that thread with each exercise and its report, for the terminal.
        check: Runs a check; by default in a process of its own.
    """

    def __init__(
        self,
        folder: StudentFolder,
        *,
        reported: Callable[[Exercise, Report], object] = lambda exercise, report: None,
        check: Check = check_apart,
    ) -> None:
        self._folder, self._reported, self._check = folder, reported, check
        self._by_name = {each.name: each for each in folder.course}
        self._current = folder.chosen().name
        self._reports: dict[str, tuple[int, Report, str | None]] = {}
        """Last report of each exercise, with its number and the code that was checked."""
        self._numbers = itertools.count(1)
        self._waiting: dict[str, None] = {}
        self._checking: str | None = None
        self._stop = threading.Event()
        self._lock = threading.RLock()
        self._news = threading.Condition(self._lock)
        self._is_closed = False
        self._tell: Callable[[Operation], object] = lambda operation: None
        self._open = contextlib.ExitStack()
        self._saves = 0
        for each in folder.course:
            each.settings  # noqa: B018 - a mistake in one of them is message now, and by no page
        self._checker = threading.Thread(target=self._work, name="robolink learn's checks", daemon=True)

    # What the server asks for

    def begin(self, tell: Callable[[Operation], object]) -> None:
        """Begin to watch the files, and check the next exercise."""
        self._tell = tell
        self._checker.start()
        self._open.enter_context(_Watcher(self))
        self.ask(self._by_name[self._current])

    def state(self) -> Operation:
        """Return the list of the exercises."""
        with self._lock:
            folder = self._folder
            following, language, done = folder.next, folder.language, folder.progress.done
            return {
                "op": "learn",
                "language": language,
                "heading": words(language, "heading", done=folder.done, all=len(folder.course)),
                "current": self._current,
                "saves": self._saves,
                "checking": self._checking or next(iter(self._waiting), None),
                "exercises": [
                    {
                        "name": each.name,
                        "file": each.file,
                        "title": each.title(language),
                        "state": "next" if each is following else "done" if each.name in done else "open",
                    }
                    for each in folder.course
                ],
            }

    def obey(self, command: str, name: str) -> list[Operation]:
        """Do what a page asks for; return what it alone is told.

        Raises:
            NotFoundError: if there is no such exercise, or no such language.
            FolderError: (an OSError) if the folder is gone or cannot be written.
        """
        try:
            with self._lock:
                if command == "language":
                    self._speak(name)
                    return []
                if name not in self._by_name:
                    raise NotFoundError("exercise", shown(name, 100), self._by_name)
                return _COMMANDS[command](self, self._by_name[name])
        except OSError as error:
            if isinstance(error, RobolinkError):
                raise
            raise FolderError(f"{self._folder.path}: {error.strerror or error}") from None

    def close(self) -> None:
        """End the check that runs, and watch no more. Safe to call twice."""
        with self._news:
            self._is_closed = True
            self._stop.set()
            self._news.notify_all()
        if self._checker.is_alive():
            self._open.close()
            waits.join(self._checker, 2.0)

    # Commands

    def _show(self, exercise: Exercise) -> list[Operation]:
        return [self._detail(exercise)]

    def ask(self, exercise: Exercise) -> list[Operation]:
        """Schedule a check of an exercise; a check of it that still runs is of an older file, and is ended."""
        with self._news:
            self._waiting[exercise.name] = None
            if self._checking == exercise.name:
                self._stop.set()
            self._news.notify_all()
        return []

    def _hint(self, exercise: Exercise) -> list[Operation]:
        self._folder.reload()
        self._folder.next_hint(exercise)
        self._tell(self._detail(exercise))
        return []

    def _reset(self, exercise: Exercise) -> list[Operation]:
        self._folder.reload()
        saved = self._folder.reset(exercise)
        self._reports.pop(exercise.name, None)
        key = "reset new" if saved is None else "reset"
        message = words(self._folder.language, key, file=exercise.file, saved="" if saved is None else saved.name)
        self._tell(self.state())
        return [{"op": "status", "level": WARNING, "message": message}]

    def _speak(self, name: str) -> None:
        language: Language | None = next((each for each in LANGUAGES if each == name), None)
        if language is None:
            raise NotFoundError("language", shown(name, 100), LANGUAGES)
        self._folder.reload()
        if language == self._folder.language:
            return
        self._folder.speak(language)
        self._reports.clear()
        self._tell(self.state())
        self.ask(self._by_name[self._current])

    def progress_changed(self) -> None:
        """Show progress that another command has made."""
        with self._lock, self._telling():
            self._folder.reload()
            self._tell(self.state())

    @contextlib.contextmanager
    def _telling(self) -> Iterator[None]:
        """Send errors of the block to the pages: the folder is gone, for example, or the disk is full."""
        try:
            yield
        except (RobolinkError, OSError) as error:
            self._tell({"op": "status", "level": ERROR, "message": shown(str(error), 500)})

    # Checks

    def saved(self, exercise: Exercise) -> None:
        """Check an exercise whose file was saved, and let the pages show it."""
        with self._lock:
            self._current = exercise.name
            self._saves += 1
            self.ask(exercise)

    def _work(self) -> None:
        while True:
            with self._news:
                self._news.wait_for(lambda: self._is_closed or self._waiting)
                if self._is_closed:
                    return
                name = next(iter(self._waiting))
                del self._waiting[name]
                self._checking = name
                self._stop.clear()
                self._tell(self.state())
            with self._telling():
                self._check_one(self._by_name[name])
            with self._lock:
                if self._checking is not None:  # it was ended, or could not begin
                    self._checking = None
                    self._tell(self.state())

    def _check_one(self, exercise: Exercise) -> None:
        folder, file = self._folder, self._folder.file_of(exercise)
        code = code_of(file)
        report = self._check(exercise, file, folder.language, stop=self._stop)
        with self._lock:
            if self._stop.is_set():
                return
            self._reports[exercise.name] = next(self._numbers), report, code
            self._checking = None
            with self._telling():
                folder.reload()
                if report.passed:
                    folder.finish(exercise)
            self._tell(self._detail(exercise))
            self._tell(self.state())
        self._reported(exercise, report)

    def _detail(self, exercise: Exercise) -> Operation:
        """Return all that the page shows of one exercise."""
        language, hints = self._folder.language, exercise.settings.hints
        file = self._folder.file_of(exercise)
        code = code_of(file)
        count = self._folder.progress.hints.get(exercise.name, 0)
        found = self._reports.get(exercise.name)
        return {
            "op": "exercise",
            "name": exercise.name,
            "text": exercise.text(language),
            "hints": [each[language].strip() for each in hints[:count]],
            "allHints": len(hints),
            "path": fit(str(file), lines=False),
            "code": code,
            "line": found[1].mistake.line if found and found[1].mistake and found[2] == code else 0,
            "report": None if found is None else _shown_report(exercise, *found[:2], language),
        }


class _Watcher(PeriodicThread):
    """Thread that looks at the student's files, and at the progress."""

    def __init__(self, exercises: PageExercises) -> None:
        super().__init__("robolink learn's watch", EVERY)
        self._exercises = exercises
        self._watch = Watch(exercises._folder, exercises.saved)
        self._progress = Changes()
        self._progress.follow([exercises._folder.path / STUDENT_FILE])

    def look(self) -> None:
        """Poll once."""
        self._watch.look()
        if self._progress.look():
            self._exercises.progress_changed()


def code_of(file: Path) -> str | None:
    """Return the code of a file for the page, lines ended by a line feed; None if it cannot be read or is large."""
    try:
        raw = read_plain(file, LARGEST_CODE)
    except OSError:
        return None
    text = raw.decode("utf-8-sig", "replace")
    return fit(text.replace("\r\n", "\n").replace("\r", "\n"))  # as Python counts lines


def _shown_report(exercise: Exercise, number: int, report: Report, language: Language) -> dict[str, Any]:
    message = findings(exercise, report, language)
    return {
        "number": number,
        "passed": report.passed,
        "seconds": round(report.seconds, 1),
        "findings": [{"mark": mark, "text": fit(text), "below": [*map(fit, below)]} for mark, text, below in message],
        "printed": [*map(fit, printed_lines(report.printed, language))],
        "track": report.track,
    }


_COMMANDS: dict[str, Callable[[PageExercises, Exercise], list[Operation]]] = {
    "show": PageExercises._show,
    "check": PageExercises.ask,
    "hint": PageExercises._hint,
    "reset": PageExercises._reset,
}
