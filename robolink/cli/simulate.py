"""robolink simulate: run a launch file in one process and in virtual time, with faults, once or with many seeds."""

from __future__ import annotations

import os
import sys
import time
from contextlib import nullcontext, redirect_stdout
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from robolink.cli import complete
from robolink.cli.options import seconds
from robolink.cli.output import say, tell

if TYPE_CHECKING:
    from pathlib import Path

    from robolink.faults import FaultsDescription
    from robolink.launch import Entry
    from robolink.simulating.repeat import SeedRun
    from robolink.simulating.run import Watching

MOST_SEED = 2**32 - 1
LONG = 2.0
"""Seconds of real time after which a person is shown how far a run is."""

INTERRUPTED = 130
"""The exit code of what Ctrl-C has ended."""

ALGEBRA = ["OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"]
"""What libraries that numpy computes with take their number of threads from."""

FAIL_ON = ["contact", "error", "real-time"]

app = typer.Typer()


def _checked(kinds: list[str] | None) -> list[str] | None:
    for each in kinds or []:
        if each not in FAIL_ON:
            from robolink.exceptions import nearest

            raise typer.BadParameter(f"'{each[:100]}' is none of {', '.join(FAIL_ON)}{nearest(each[:100], FAIL_ON)}")
    return kinds


class Asked(NamedTuple):
    """What is to be simulated."""

    words: list[str]
    duration: float
    settings: list[str]
    faults: str
    workspace: str
    fail_on: list[str]


@app.command()
def simulate(
    ctx: typer.Context,
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="NAME|FILE [ARG:=VALUE]...",
            help="A launch file, by name, by path, or by package and name; and its arguments.",
            autocompletion=complete.launch_words,
            show_default=False,
        ),
    ],
    duration: Annotated[float, seconds("--duration", "Simulated seconds.")] = 60.0,
    seed: Annotated[
        int | None,
        typer.Option(
            "--seed", metavar="N", help="Of faults, noise and random numbers.", min=0, max=MOST_SEED, show_default=False
        ),
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NODE.PARAMETER:=VALUE", help="Set a parameter; may be repeated."),
    ] = None,
    faults: Annotated[
        str,
        typer.Option(
            "--faults", metavar="NAME|FILE", help="What goes wrong, and when.", autocompletion=complete.faults_files
        ),
    ] = "",
    repeat: Annotated[
        int,
        typer.Option(
            "--repeat", metavar="N", help="Run N seeds, from --seed or 0 on, side by side.", min=0, show_default=False
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
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one object of JSON in place of the summary, as the last line.")
    ] = False,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Show all that nodes log, not only warnings.")
    ] = False,
    workspace: Annotated[str, typer.Option("--workspace", metavar="FOLDER", help="Where to look first.")] = "",
) -> None:
    """Run a system of nodes in virtual time, as fast as it goes; end with a summary and a hash of all it published.

    Ten minutes of a robot with a bad network: `simulate follow --duration 600 --faults radio`.

    The exit code is 1 when a node crashes or ends with an error, other than by a fault, and when a name of --set or
    --faults was nobody's. Ctrl-C ends with the summary so far, and exit code 130.
    """
    _compute_in_one_thread()
    asked = Asked(words, duration, settings or [], faults, workspace, fail_on or [])
    if repeat:
        first = seed or 0
        raise typer.Exit(_repeat(ctx, asked, range(first, first + repeat), as_json))
    raise typer.Exit(_once(ctx, asked, seed, as_json, verbose))


def _compute_in_one_thread() -> None:
    """Have what numpy computes with keep to one thread, here and in processes of seeds, unless somebody said more.

    Several may give other bits on a computer with another number of cores, and take longer to start. To be called
    before numpy is imported.
    """
    for name in ALGEBRA:
        os.environ.setdefault(name, "1")


def _once(ctx: typer.Context, asked: Asked, seed: int | None, as_json: bool, verbose: bool) -> int:
    path, entries, faults = _read(ctx, asked)
    from robolink.simulating import failed_by, simulate
    from robolink.simulating.settings import parse_settings

    apart = redirect_stdout(sys.stderr) if as_json else nullcontext()  # what nodes print
    with apart, Progress(asked.duration, "s") as progress:
        result = simulate(
            entries,
            duration=asked.duration,
            name=path.stem,
            seed=seed,
            faults=faults,
            given=parse_settings(asked.settings),
            watching=_watching(progress, verbose),
        )
    result = failed_by(result, asked.fail_on)
    if as_json:
        say(result.as_json())
    else:
        for line in result.lines():
            say(line)
    return INTERRUPTED if result.interrupted else 1 if result.failures else 0


def _read(ctx: typer.Context, asked: Asked) -> tuple[Path, list[Entry], FaultsDescription | None]:
    """Read all that can be wrong before anything is run."""
    from robolink.cli.launch_words import launch_file
    from robolink.launch import read_launch_file
    from robolink.simulating.settings import SettingError, parse_settings, with_parameters

    folder = asked.workspace or None
    try:
        settings = parse_settings(asked.settings)
    except SettingError as error:
        ctx.fail(str(error))
    path, given = launch_file(ctx, asked.words, folder)
    entries = with_parameters(read_launch_file(path, given, workspace=folder), settings)
    if not asked.faults:
        return path, entries, None
    from robolink.faults.file import check_nodes, read_faults
    from robolink.workspace import find_faults

    document = read_faults(find_faults(asked.faults, workspace=folder))
    check_nodes(document, [each.name for each in entries])
    return path, entries, document.value


def _watching(progress: Progress, verbose: bool) -> Watching:
    from robolink import logging
    from robolink.impl.log_output import output
    from robolink.simulating.run import Watching

    console = output.console
    least = logging.LoggingSeverity.DEBUG if verbose else logging.LoggingSeverity.WARN

    def show(record: logging.Record) -> None:
        if console is not None and record.severity >= least:
            console(record)

    return Watching(show, tell, progress.show)


def _repeat(ctx: typer.Context, asked: Asked, seeds: range, as_json: bool) -> int:
    _read(ctx, asked)  # what is wrong is told once
    from robolink.callback_threads import count_cores
    from robolink.simulating.repeat import run_seeds

    def done(run: SeedRun) -> None:
        progress.show(progress.shown + 1)
        if run.failures and not as_json:
            say(_told(run, asked))

    with Progress(len(seeds), "seeds") as progress:
        runs = run_seeds(lambda seed: [*_command(asked, seed), "--json"], seeds, workers=count_cores(), on_done=done)
    failed, interrupted = [each for each in runs if each.failures], len(runs) < len(seeds)
    if as_json:
        say(_summary(runs, asked))
    else:
        rest = f"; interrupted before the other {len(seeds) - len(runs)}" if interrupted else ""
        say(f"{len(runs) - len(failed)} of {len(runs)} seeds passed{rest}")
    return INTERRUPTED if interrupted else 1 if failed else 0


def _told(run: SeedRun, asked: Asked) -> str:
    import shlex

    return (
        f"seed {run.seed} failed: {'; '.join(run.failures)}\n  {shlex.join(['robolink', *_command(asked, run.seed)])}"
    )


def _summary(runs: list[SeedRun], asked: Asked) -> str:
    """Give all runs as one line of JSON, the hash over theirs."""
    import hashlib
    import shlex

    import msgspec

    hashes = "".join(each.result.hash if each.result is not None else "-" for each in runs)
    failed = [
        {
            "seed": each.seed,
            "failures": each.failures,
            "replay": shlex.join(["robolink", *_command(asked, each.seed)]),
        }
        for each in runs
        if each.failures
    ]
    results = [each.result for each in runs if each.result is not None]
    summary = {"seeds": len(runs), "failed": failed, "results": results}
    return msgspec.json.encode({**summary, "hash": hashlib.sha256(hashes.encode()).hexdigest()}).decode()


def _command(asked: Asked, seed: int) -> list[str]:
    """Give the words behind `robolink` that run this with a seed."""
    words = ["simulate", *asked.words, "--duration", repr(asked.duration).removesuffix(".0"), "--seed", str(seed)]
    for each in asked.settings:
        words += ["--set", each]
    for flag, value in (("--faults", asked.faults), ("--workspace", asked.workspace)):
        words += [flag, value] if value else []
    for each in asked.fail_on:
        words += ["--fail-on", each]
    return words


class Progress:
    """A bar on standard error that shows how far something is, to a person who has waited for a while already."""

    def __init__(self, total: float, unit: str) -> None:
        self.shown = 0.0
        self._total, self._unit = total, unit
        self._bar: Any = None
        self._begin = 0.0

    def show(self, done: float) -> None:
        """Say how far it is."""
        self.shown = done
        if self._bar is not None:
            self._bar.update(self._task, completed=done)
        elif sys.stderr is not None and sys.stderr.isatty() and time.monotonic() - self._begin > LONG:
            self._open()
            self.show(done)

    def _open(self) -> None:
        from rich import progress
        from rich.console import Console

        columns = (
            progress.BarColumn(),
            progress.TextColumn(f"{{task.completed:.0f}} of {{task.total:.0f}} {self._unit}"),
        )
        self._bar = progress.Progress(
            *columns, progress.TimeRemainingColumn(), console=Console(stderr=True), transient=True
        )
        self._task = self._bar.add_task("", total=self._total)
        self._bar.start()

    def __enter__(self) -> Progress:
        self._begin = time.monotonic()
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.stop()
