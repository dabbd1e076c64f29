"""robolink race: a score for programs that drive a simulated robot, which anybody can compute again."""

from __future__ import annotations

import contextlib
import sys
from typing import Annotated

import typer

from robolink.cli.shared.marks import BAD, say_styled
from robolink.cli.shared.output import say, say_json, tell
from robolink.constants import MOST_SEED
from robolink.system.terminal import fit, styled

app = typer.Typer(no_args_is_help=True)

RACES = ("line", "maze", "follow")
"""Names of the races."""


@app.command()
def race(
    name: Annotated[
        str, typer.Argument(metavar="line|maze|follow", help="Name of the race.", autocompletion=lambda: list(RACES))
    ],
    files: Annotated[
        list[str],
        typer.Argument(metavar="FILE...", help="Programs, nodes by name, or folders of students."),
    ],
    seed: Annotated[
        int,
        typer.Option("--seed", metavar="N", help="Seed of the world and of all random numbers.", min=0, max=MOST_SEED),
    ] = 1,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON: a list with an object for each program.")
    ] = False,
    as_csv: Annotated[bool, typer.Option("--csv", help="Print CSV, for a spreadsheet.")] = False,
    language: Annotated[
        str,
        typer.Option("--language", metavar="en|pt", help="English or Portuguese; by default that of robolink learn."),
    ] = "",
) -> None:
    """Race programs in a simulated world, each alone, in virtual time; print a table with a hash of each run.

    line: one lap along a painted line. maze: to the far corner of a maze, another one for each seed. follow: along the
    walls of a room. The same program and seed have the same score and hash each time. A broken program gets a line that
    says why.
    """
    if name not in RACES:
        from robolink.exceptions import nearest

        raise typer.BadParameter(f"'{name[:100]}' is none of {', '.join(RACES)}{nearest(name[:100], RACES)}")
    if as_json and as_csv:
        raise typer.BadParameter("--json and --csv do not go together")
    from robolink.cli.shared.languages import spoken
    from robolink.grading.mistakes import Mistake
    from robolink.race.apart import programs_of, race_all, without_program
    from robolink.race.races import RACES as RULES
    from robolink.race.result import Result, noted, ranked, rows, table, words
    from robolink.race.result import as_csv as csv_of

    rules, tongue = RULES[name], spoken(language)
    programs = programs_of(name, files)
    others = without_program(name, files)
    for each in others if as_json or as_csv else ():
        _note(f"{each}: {words(tongue, 'no program', text=f'{name}.py')}")
    many = len(programs) > 1
    results = race_all(
        rules,
        programs,
        seed,
        on_done=lambda each: _note(noted(each, tongue), BAD if each.mistake else "") if many else None,
    )
    if as_json:
        say_json(rows(rules, results, seed))
    elif as_csv:
        say(csv_of(rules, results, seed).removesuffix("\n"))
    else:
        results += [Result(each, mistake=Mistake("no program", f"{name}.py")) for each in others]
        heading, *lines = table(rules, results, seed, tongue)
        say(heading)
        for line, (_, result) in zip(lines, ranked(rules, results), strict=True):
            say_styled(line, BAD if result.mistake is not None else "")


def _note(text: str, style: str = "") -> None:
    """Write a note; a race goes on if nobody can be told, as with `2>&1 | head`."""
    with contextlib.suppress(OSError):
        tell(styled(fit(text), style, sys.stderr), colours=True)
