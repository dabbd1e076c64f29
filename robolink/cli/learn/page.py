"""Work of `robolink learn view`: serves the page with the exercises of a student, and checks what is saved."""

from __future__ import annotations

from robolink.cli.learn.work import folder_here, say_all
from robolink.cli.shared.output import say
from robolink.cli.shared.page import announce, end_with_the_terminal
from robolink.cli.shared.session import node_of, opened
from robolink.extensions.optional import page
from robolink.grading.languages import Language
from robolink.learn.exercise import Exercise
from robolink.learn.lines import reported
from robolink.learn.page import PageExercises
from robolink.learn.report import Report
from robolink.learn.words import words

PANEL = "learn"
"""Name of the page's panel."""


def show(port: int | None, browser: bool, language: Language | None) -> None:
    """Serve the page until Ctrl-C; the terminal tells what is checked, too.

    Args:
        port: Port; None takes the default one, or the next that is free.
        browser: True opens the page.
        language: Language to speak from now on; None keeps it.
    """
    folder = folder_here(language)

    def tell(exercise: Exercise, report: Report) -> None:
        say_all(["", f"{exercise.file}: {exercise.title(folder.language)}"])
        say_all(reported(exercise, report, folder.language))

    exercises = PageExercises(folder, reported=tell)
    end_with_the_terminal()
    with opened() as context, page(node_of(context), port=port, exercises=exercises) as server:
        announce(server, browser, PANEL)
        say(words(folder.language, "watching"))
        context.graph.wait_for(lambda: not context.ok(), None)
