"""Work of the verbs of `robolink learn`: each finds the student's folder, acts, and writes lines."""

from __future__ import annotations

import time
from pathlib import Path

from robolink.cli.shared.layout import shown, typed
from robolink.cli.shared.marks import say_marked
from robolink.cli.shared.output import say
from robolink.exceptions import RobolinkError
from robolink.grading.languages import Language, default_language
from robolink.learn.checking import check_apart
from robolink.learn.exercise import SETTINGS, Exercise, read_course
from robolink.learn.folder import StudentFolder, find_folder, folder_below, start_folder, the_folder
from robolink.learn.lines import course_listed, listed, next_step, reported, task
from robolink.learn.report import Report
from robolink.learn.words import words
from robolink.system.files import expanded

PANEL = "learn"
"""Name of the page's panel."""


class NoFileError(RobolinkError, FileNotFoundError):
    """A student's file is not there."""


def list_exercises(language: Language | None) -> None:
    """List the exercises, with the progress of the folder in which the student is."""
    folder = find_folder()
    if folder is None:
        say_marked(course_listed(read_course(), language or default_language(), folder_below()))
        return
    _speak(folder, language)
    say_marked(listed(folder))


def start(path: str, source: str, language: Language | None) -> None:
    """Write the given files that are not there yet."""
    folder = start_folder(path, language=language, source=source)
    place = typed(folder.path)
    written = folder.write()
    key = "written" if written else "all here" if folder.path == Path.cwd() else "all there"
    say(words(folder.language, key, count=len(written), folder=place))
    if folder.path != Path.cwd():
        say(words(folder.language, "go", folder=place))
    else:
        say_marked(next_step(folder))


def check(name: str, language: Language | None) -> bool:
    """Check one exercise; return whether it is done."""
    folder = folder_here(language)
    exercise = folder.chosen(name)
    if not folder.file_of(exercise).exists():
        raise NoFileError(words(folder.language, "no file", file=exercise.file, name=exercise.name))
    return _check(folder, exercise)


def check_all(language: Language | None) -> bool:
    """Check all exercises, a line for each; return whether all are done."""
    folder = folder_here(language)
    passed = 0
    for each in folder.course:
        report = check_apart(each, folder.file_of(each), folder.language)
        if report.passed:
            folder.finish(each)
        passed += report.passed
        say_marked(
            [f"  {'✓' if report.passed else '✗'} {each.file}  {each.title(folder.language)} ({report.seconds:.1f} s)"]
        )
    say(words(folder.language, "heading", done=passed, all=len(folder.course)))
    return passed == len(folder.course)


def watch(name: str, language: Language | None) -> None:
    """Check the exercises whose files are saved, and the named one (default: the next) at once."""
    from robolink.learn.folder import EVERY, Watch

    folder = folder_here(language)
    say(words(folder.language, "watching"))
    watching = Watch(folder, lambda exercise: _check(folder, exercise))
    if name or folder.next is not None:
        _check(folder, folder.chosen(name))
    while True:
        watching.look()
        time.sleep(EVERY)


def hint(name: str, language: Language | None) -> None:
    """Show the next hint."""
    folder = folder_here(language)
    exercise = folder.chosen(name)
    hints = exercise.settings.hints
    was = folder.progress.hints.get(exercise.name, 0)
    number = folder.next_hint(exercise)
    if not number:
        say(words(folder.language, "no hints"))
        return
    text = hints[number - 1][folder.language].strip()
    say(words(folder.language, "hint", number=number, all=len(hints), text=text))
    if was == len(hints):
        say(words(folder.language, "last hint"))


def show(name: str, language: Language | None) -> None:
    """Show the task of an exercise."""
    folder = folder_here(language)
    say_marked(task(folder.chosen(name), folder.language))


def reset(name: str, language: Language | None) -> None:
    """Write the given file of an exercise again."""
    folder = folder_here(language)
    exercise = folder.chosen(name)
    saved = folder.reset(exercise)
    key = "reset new" if saved is None else "reset"
    say(words(folder.language, key, file=exercise.file, saved="" if saved is None else saved.name))


def folder_here(language: Language | None) -> StudentFolder:
    """Return the student's folder, which speaks a language from now on. Raises NoFolderError if there is none."""
    folder = the_folder()
    _speak(folder, language)
    return folder


def _speak(folder: StudentFolder, language: Language | None) -> None:
    if language is not None:
        folder.speak(language)


def _check(folder: StudentFolder, exercise: Exercise) -> bool:
    report = check_apart(exercise, folder.file_of(exercise), folder.language)
    say_marked(["", f"{exercise.file}: {exercise.title(folder.language)}"])
    say_marked(reported(exercise, report, folder.language))
    if report.passed:
        folder.finish(exercise)
        say_marked(["", *next_step(folder)])
    return report.passed


def show_page(port: int | None, browser: bool, language: Language | None) -> None:
    """Serve the page until Ctrl-C; the terminal tells what is checked, too.

    Args:
        port: Port; None takes the default one, or the next that is free.
        browser: True opens the page.
        language: Language to speak from now on; None keeps it.
    """
    from robolink.cli.shared.page import announce, end_with_the_terminal
    from robolink.cli.shared.session import node_of, opened
    from robolink.extensions.optional import page
    from robolink.learn.page import PageExercises

    folder = folder_here(language)

    def report_it(exercise: Exercise, report: Report) -> None:
        say_marked(["", f"{exercise.file}: {exercise.title(folder.language)}"])
        say_marked(reported(exercise, report, folder.language))

    exercises = PageExercises(folder, reported=report_it)
    end_with_the_terminal()
    with opened() as context, page(node_of(context), port=port, exercises=exercises) as server:
        announce(server, browser, PANEL)
        say(words(folder.language, "watching"))
        context.graph.wait_for(lambda: not context.ok(), None)


def new(name: str, folder: str, language: Language) -> None:
    """Make an exercise, and say what to do with it, in a language."""
    from robolink.learn.teaching import new_exercise

    made = new_exercise(name, folder, language)
    for each in sorted(made.iterdir()):
        say(words(language, "made", path=shown(each)))
    for key in ("next prove", "next start"):
        say(words(language, key, folder=typed(made.parent)))


def prove(folder: str, language: Language) -> bool:
    """Prove all exercises of a folder, and say it in a language; return whether all are as they should be."""
    from robolink.learn.teaching import FOLDER, proofs

    here = Path.cwd()
    place = expanded(folder) if folder else here if any(here.glob(f"*/{SETTINGS}")) else here / FOLDER
    good = True
    last = ""
    for each in proofs(read_course(place), check_apart, language):
        if each.exercise.name != last:
            last = each.exercise.name
            say(each.exercise.folder.name)
        good = good and each.good
        say_marked([f"  {'✓' if each.good else '✗'} {each.text}"])
    return good
