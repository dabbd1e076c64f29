"""Work of the verbs of `robolink learn` for teachers."""

from __future__ import annotations

from pathlib import Path

from robolink.cli.learn.work import say_all
from robolink.cli.shared.layout import shown, typed
from robolink.cli.shared.output import say
from robolink.grading.languages import Language
from robolink.learn.exercise import SETTINGS, read_course
from robolink.learn.isolated import check_apart
from robolink.learn.teaching import FOLDER, new_exercise, proofs
from robolink.learn.words import words
from robolink.system.files import expanded


def new(name: str, folder: str, language: Language) -> None:
    """Make an exercise, and say what to do with it, in a language."""
    made = new_exercise(name, folder, language)
    for each in sorted(made.iterdir()):
        say(words(language, "made", path=shown(each)))
    for key in ("next prove", "next start"):
        say(words(language, key, folder=typed(made.parent)))


def prove(folder: str, language: Language) -> bool:
    """Prove all exercises of a folder, and say it in a language; return whether all are as they should be."""
    here = Path.cwd()
    place = expanded(folder) if folder else here if any(here.glob(f"*/{SETTINGS}")) else here / FOLDER
    good = True
    last = ""
    for each in proofs(read_course(place), check_apart, language):
        if each.exercise.name != last:
            last = each.exercise.name
            say(each.exercise.folder.name)
        good = good and each.good
        say_all([f"  {'✓' if each.good else '✗'} {each.text}"])
    return good
