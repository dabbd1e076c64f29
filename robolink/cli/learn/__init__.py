"""robolink learn: exercises that are checked in a simulated world."""

from __future__ import annotations

from typing import Annotated

import typer

app = typer.Typer(
    help="Learn by exercises that are checked in a simulated world, in English or Portuguese.",
    invoke_without_command=True,
)


def exercise_names() -> list[str]:
    """Return the names of the exercises of this folder."""
    from robolink.exceptions import RobolinkError
    from robolink.learn.exercise import read_course
    from robolink.learn.folder import find_folder

    try:
        found = find_folder()
        return [each.name for each in (read_course() if found is None else found.course)]
    except (RobolinkError, OSError):
        return []


Language = Annotated[
    str, typer.Option("--language", metavar="en|pt", help="English or Portuguese; saved for later commands.")
]
Name = Annotated[
    str, typer.Argument(metavar="NAME", help="Exercise, by name, number or file.", autocompletion=exercise_names)
]
MaybeName = Annotated[
    str,
    typer.Argument(
        metavar="[NAME]",
        help="Exercise, by name, number or file; the next one by default.",
        autocompletion=exercise_names,
    ),
]


@app.callback()
def list_exercises(
    context: typer.Context,
    in_page: Annotated[bool, typer.Option("--view", help="Show the exercises in the browser, as learn view.")] = False,
    language: Language = "",
) -> None:
    """Learn by exercises that are checked in a simulated world; without a verb, list them with your progress."""
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    if context.invoked_subcommand is None and in_page:
        view(context, language=language)
    elif context.invoked_subcommand is None:
        work.list_exercises(languages.language_of(language))
    else:
        context.obj = language


@app.command("list")
def list_them(context: typer.Context, language: Language = "") -> None:
    """List the exercises, with your progress."""
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    work.list_exercises(languages.language_of(language or context.obj))


@app.command("start")
def start(
    context: typer.Context,
    folder: Annotated[
        str, typer.Argument(metavar="[FOLDER]", help="Folder to write into; learn_robolink by default.")
    ] = "",
    source: Annotated[str, typer.Option("--from", metavar="FOLDER", help="Folder with a teacher's exercises.")] = "",
    language: Language = "",
) -> None:
    """Write the exercises' files into a folder; files that are there stay as they are."""
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    work.start(folder, source, languages.language_of(language or context.obj))


@app.command("check")
def check(
    context: typer.Context,
    name: MaybeName = "",
    all_of_them: Annotated[bool, typer.Option("--all", help="Check all exercises, and print a line for each.")] = False,
    language: Language = "",
) -> None:
    """Check an exercise; the exit code is 1 if it is not done."""
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    passed = (
        work.check_all(languages.language_of(language or context.obj))
        if all_of_them
        else work.check(name, languages.language_of(language or context.obj))
    )
    if not passed:
        raise typer.Exit(1)


@app.command("watch")
def watch(context: typer.Context, name: MaybeName = "", language: Language = "") -> None:
    """Check exercises each time their files are saved, until Ctrl-C."""
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    work.watch(name, languages.language_of(language or context.obj))


@app.command("view")
def view(
    context: typer.Context,
    port: Annotated[
        int | None,
        typer.Option("--port", metavar="PORT", min=0, max=65535, help="Port; by default 8765 or the next free one."),
    ] = None,
    browser: Annotated[bool, typer.Option(help="Open the page in the browser.")] = True,
    language: Language = "",
) -> None:
    """Show the exercises in the browser, and check them each time their files are saved, until Ctrl-C.

    The page has the tasks, hints, reports, and the path that the robot took in the check.
    """
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    work.show_page(port, browser, languages.language_of(language or context.obj))


@app.command("hint")
def hint(context: typer.Context, name: MaybeName = "", language: Language = "") -> None:
    """Show the next hint for an exercise."""
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    work.hint(name, languages.language_of(language or context.obj))


@app.command("show")
def show(context: typer.Context, name: MaybeName = "", language: Language = "") -> None:
    """Show the task of an exercise."""
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    work.show(name, languages.language_of(language or context.obj))


@app.command("reset")
def reset(context: typer.Context, name: Name, language: Language = "") -> None:
    """Restore the file of an exercise; yours is saved under another name."""
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    work.reset(name, languages.language_of(language or context.obj))


@app.command("new")
def new(
    context: typer.Context,
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the exercise, such as stop_early.")],
    folder: Annotated[
        str, typer.Option("--folder", metavar="FOLDER", help="Folder of the exercises; exercises by default.")
    ] = "",
    language: Language = "",
) -> None:
    """Make an exercise of your own, for your students: a text, a given file, a check and a solution."""
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    work.new(name, folder, languages.spoken(language or context.obj))


@app.command("prove")
def prove(
    context: typer.Context,
    folder: Annotated[
        str, typer.Argument(metavar="[FOLDER]", help="Folder of the exercises; exercises by default.")
    ] = "",
    language: Language = "",
) -> None:
    """Prove exercises: as given each has to fail, and its solution has to pass; the exit code is 1 if one does not."""
    from robolink.cli.learn import work
    from robolink.cli.shared import languages

    if not work.prove(folder, languages.spoken(language or context.obj)):
        raise typer.Exit(1)
