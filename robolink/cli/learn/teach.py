"""Work of the verbs of `robolink learn` for teachers."""

from __future__ import annotations

from pathlib import Path

from robolink.cli.learn.work import say_all, shown
from robolink.cli.shared.output import say
from robolink.learn.exercise import SETTINGS, read_course
from robolink.learn.isolated import check_apart
from robolink.learn.teaching import FOLDER, new_exercise, proofs
from robolink.system.paths import expanded


def new(name: str, folder: str) -> None:
    """Make an exercise, and say what to do with it."""
    made = new_exercise(name, folder)
    for each in sorted(made.iterdir()):
        say(f"made {shown(each)}")
    place = shown(made.parent)
    say(f"\nnext:\n  robolink learn prove {place}    # as given it fails, and the solution passes")
    say(f"  robolink learn start FOLDER --from {place}    # what a student types")


def prove(folder: str) -> bool:
    """Prove all exercises of a folder; return whether all are as they should be."""
    here = Path.cwd()
    place = expanded(folder) if folder else here if any(here.glob(f"*/{SETTINGS}")) else here / FOLDER
    good = True
    last = ""
    for each in proofs(read_course(place), check_apart):
        if each.exercise.name != last:
            last = each.exercise.name
            say(each.exercise.folder.name)
        good = good and each.good
        say_all([f"  {'✓' if each.good else '✗'} {each.text}"])
    return good
