"""robolink simulate: run a launch file in one process and in virtual time, with faults, once or with many seeds."""

from __future__ import annotations

import gc
import os
import sys
from contextlib import nullcontext, redirect_stdout
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from robolink.cli.launching.launch_arguments import launch_words, show_faults_schema
from robolink.cli.shared import complete
from robolink.cli.shared.marks import BAD, GOOD, WARNING, say_styled
from robolink.cli.shared.options import seconds
from robolink.cli.shared.output import say, tell
from robolink.cli.shared.terminal import Progress
from robolink.constants import MOST_SEED

if TYPE_CHECKING:
    from pathlib import Path

    from robolink.faults import FaultsDescription
    from robolink.launch import Entry
    from robolink.launch.entry import Direct
    from robolink.simulate.repeat import SeedRun
    from robolink.simulate.run import Watching

INTERRUPTED = 130
"""Exit code after a Ctrl-C."""

ALGEBRA = ["OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"]
"""Environment variables for the number of threads of numpy's linear algebra libraries."""

FAIL_ON = ["contact", "error", "real-time"]

app = typer.Typer()


def _checked(kinds: list[str] | None) -> list[str] | None:
    for each in kinds or []:
        if each not in FAIL_ON:
            from robolink.exceptions import nearest

            raise typer.BadParameter(f"'{each[:100]}' is none of {', '.join(FAIL_ON)}{nearest(each[:100], FAIL_ON)}")
    return kinds


class Options(NamedTuple):
    """Words and options of `simulate`."""

    words: list[str]
    duration: float
    settings: list[str]
    faults: str
    workspace: str
    fail_on: list[str]
    record: str


@app.command()
def simulate(
    ctx: typer.Context,
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="NAME|FILE [ARG:=VALUE]...",
            help="Launch file, by name, by path, or by package and name; then its arguments.",
            autocompletion=launch_words,
            show_default=False,
        ),
    ],
    duration: Annotated[float, seconds("--duration", "Duration to simulate, in seconds.")] = 60.0,
    seed: Annotated[
        int | None,
        typer.Option(
            "--seed",
            metavar="N",
            help="Seed of faults, noise and random numbers.",
            min=0,
            max=MOST_SEED,
            show_default=False,
        ),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NODE.PARAMETER:=VALUE", help="Set a parameter; may be repeated."),
    ] = None,
    faults: Annotated[
        str,
        typer.Option(
            "--faults",
            metavar="NAME|FILE",
            help="File that says which faults happen, and when.",
            autocompletion=complete.faults_files,
        ),
    ] = "",
    repeat: Annotated[
        int,
        typer.Option(
            "--repeat",
            metavar="N",
            help="Run N times in parallel, with seeds from --seed or 0 on.",
            min=0,
            show_default=False,
        ),
    ] = 0,
    fail_on: Annotated[
        list[str] | None,
        typer.Option(
            "--fail-on",
            metavar="WHAT",
            help=f"What else counts as a failure: {', '.join(FAIL_ON)}; may be repeated.",
            callback=_checked,
            autocompletion=lambda: FAIL_ON,
        ),
    ] = None,
    record: Annotated[str, typer.Option("--record", metavar="FOLDER", help="Record all topics into a bag.")] = "",
    as_json: Annotated[
        bool, typer.Option("--json", help="Print a JSON object instead of the summary, as the last line.")
    ] = False,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Print all log messages, not only warnings.")
    ] = False,
    workspace: Annotated[str, typer.Option("--workspace", metavar="FOLDER", help="Workspace to search first.")] = "",
    schema: Annotated[
        bool,
        typer.Option(
            "--schema", callback=show_faults_schema, is_eager=True, help="Print the JSON schema of faults files."
        ),
    ] = False,
) -> None:
    """Run a launch file in virtual time, faster than real time; print a summary and a hash of all messages.

    Ten minutes of a robot with a bad network: `simulate follow --duration 600 --faults radio`.

    The exit code is 1 when a node crashes or ends with an error, other than by a fault, and when a name of --set or
    --faults was nobody's. Ctrl-C ends with the summary so far, and exit code 130.
    """
    _compute_in_one_thread()
    options = Options(words, duration, settings or [], faults, workspace, fail_on or [], record)
    if repeat and record:
        ctx.fail("--record and --repeat do not go together: record the seed that is of interest")
    if repeat:
        first = seed or 0
        raise typer.Exit(_repeat(ctx, options, range(first, first + repeat), as_json))
    raise typer.Exit(_once(ctx, options, seed, as_json, verbose))


def _compute_in_one_thread() -> None:
    """Limit numpy's linear algebra to one thread, here and in processes of seeds, unless the environment says more.

    Several threads may give other bits on a computer with another number of cores, and take longer to start. To be
    called before numpy is imported.
    """
    for name in ALGEBRA:
        os.environ.setdefault(name, "1")


def _once(ctx: typer.Context, options: Options, seed: int | None, as_json: bool, verbose: bool) -> int:
    path, entries, faults, direct = _read(ctx, options)
    from robolink.simulate import failed_by, simulate
    from robolink.simulate.settings import parse_settings

    _pass_over_imports()
    apart = redirect_stdout(sys.stderr) if as_json else nullcontext()  # what nodes print
    with apart, Progress(options.duration, "s") as progress:
        result = simulate(
            entries,
            duration=options.duration,
            name=path.stem,
            seed=seed,
            faults=faults,
            given=parse_settings(options.settings),
            watching=_watching(progress, verbose),
            record=options.record,
            direct=direct,
        )
    result = failed_by(result, options.fail_on)
    if as_json:
        say(result.as_json())
    else:
        for line in result.lines():
            say(line)
    return INTERRUPTED if result.interrupted else 1 if result.failures else 0


def _pass_over_imports() -> None:
    """Exclude what was imported so far from garbage collection, and begin with that: a sixth of the start is saved."""
    import numpy  # noqa: F401 - every run seeds its generator

    if not gc.isenabled():
        gc.freeze()
        gc.enable()


def _read(ctx: typer.Context, options: Options) -> tuple[Path, list[Entry], FaultsDescription | None, Direct | None]:
    """Read all files before anything is run, so that mistakes in them are found first."""
    from robolink.cli.launching.launch_arguments import launch_file
    from robolink.launch.system import read_system
    from robolink.simulate.settings import SettingError, parse_settings, with_settings

    folder = options.workspace or None
    try:
        settings = parse_settings(options.settings)
    except SettingError as error:
        ctx.fail(str(error))
    path, given = launch_file(ctx, options.words, folder)
    system = read_system(path, given, workspace=folder)
    for note in system.notes:
        tell(f"robolink: {note}")
    system = with_settings(system, settings, lambda: read_system(path, given, workspace=folder, foresee=True).entries)
    entries = system.entries
    if not options.faults:
        return path, entries, None, system.direct
    from robolink.faults.file import check_nodes, read_faults
    from robolink.workspace import find_faults

    document = read_faults(find_faults(options.faults, workspace=folder))
    check_nodes(document, [each.name for each in entries])
    return path, entries, document.value, system.direct


def _watching(progress: Progress, verbose: bool) -> Watching:
    from robolink import logging
    from robolink.impl.log_output import output
    from robolink.simulate.run import Watching

    console = output.console
    least = logging.LoggingSeverity.DEBUG if verbose else logging.LoggingSeverity.WARN

    def show(record: logging.Record) -> None:
        if console is not None and record.severity >= least:
            console(record)

    return Watching(show, tell, progress.show)


def _repeat(ctx: typer.Context, options: Options, seeds: range, as_json: bool) -> int:
    _read(ctx, options)  # what is wrong is reported once
    gc.enable()
    from robolink.running.threads import count_cores
    from robolink.simulate.repeat import run_seeds

    def done(run: SeedRun) -> None:
        progress.show(progress.shown + 1)
        if run.failures and not as_json:
            say_styled(f"seed {run.seed} failed", BAD, _outcome(run, options))

    with Progress(len(seeds), "seeds") as progress:
        runs = run_seeds(lambda seed: [*_command(options, seed), "--json"], seeds, workers=count_cores(), on_done=done)
    failed, interrupted = [each for each in runs if each.failures], len(runs) < len(seeds)
    if as_json:
        say(_summary(runs, options))
    else:
        rest = f"; interrupted before the other {len(seeds) - len(runs)}" if interrupted else ""
        style = BAD if failed else WARNING if interrupted else GOOD
        say_styled(f"{len(runs) - len(failed)} of {len(runs)} seeds passed", style, rest)
    return INTERRUPTED if interrupted else 1 if failed else 0


def _outcome(run: SeedRun, options: Options) -> str:
    """Return why a seed failed, and the command that runs it again."""
    import shlex

    return f": {'; '.join(run.failures)}\n  {shlex.join(['robolink', *_command(options, run.seed)])}"


def _summary(runs: list[SeedRun], options: Options) -> str:
    """Return all runs as one line of JSON, with a hash over their hashes."""
    import hashlib
    import shlex

    import msgspec

    hashes = "".join(each.result.hash if each.result is not None else "-" for each in runs)
    failed = [
        {
            "seed": each.seed,
            "failures": each.failures,
            "replay": shlex.join(["robolink", *_command(options, each.seed)]),
        }
        for each in runs
        if each.failures
    ]
    results = [each.result for each in runs if each.result is not None]
    summary = {"seeds": len(runs), "failed": failed, "results": results}
    return msgspec.json.encode({**summary, "hash": hashlib.sha256(hashes.encode()).hexdigest()}).decode()


def _command(options: Options, seed: int) -> list[str]:
    """Return the words behind `robolink` that run this with a seed."""
    words = ["simulate", *options.words, "--duration", repr(options.duration).removesuffix(".0"), "--seed", str(seed)]
    for each in options.settings:
        words += ["--set", each]
    for flag, value in (("--faults", options.faults), ("--workspace", options.workspace)):
        words += [flag, value] if value else []
    for each in options.fail_on:
        words += ["--fail-on", each]
    return words
