"""robolink launch: run a system of nodes that a file describes, look at it without running it, ask a running one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated, Any, NamedTuple

import typer
import typer.core

from robolink.cli import complete
from robolink.cli.launch_words import ASSIGN, LaunchFile, launch_file
from robolink.cli.layout import aligned
from robolink.cli.options import choice, seconds
from robolink.cli.output import say, tell

FORMATS = ["mermaid", "dot"]

app = typer.Typer()


class LaunchCommand(typer.core.TyperCommand):
    """A command whose `--graph` may go without a value."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Give a bare `--graph` its value."""
        left: list[str] = super().parse_args(ctx, spelled_out(args))
        names = [each for each in ctx.params.get("words") or [] if ASSIGN not in each]
        behind = next((args[index + 1] for index, each in enumerate(args[:-1]) if each == "--graph"), "")
        if behind in names[1:]:  # the first is the launch file
            ctx.fail(f"--graph draws {' or '.join(FORMATS)}, not '{behind}'")
        return left


def spelled_out(args: Sequence[str]) -> list[str]:
    """Give the arguments with the format that `--graph` draws in if none is named behind it."""
    result: list[str] = []
    for index, each in enumerate(args):
        is_bare = each == "--graph" and "".join(args[index + 1 : index + 2]) not in FORMATS
        result.append(f"{each}={FORMATS[0]}" if is_bare else each)
    return result


class Options(NamedTuple):
    """What is asked for besides a launch file."""

    duration: float | None
    workspace: str | None
    json: bool
    in_process: bool
    top: bool
    watch: bool


@app.command(cls=LaunchCommand)
def launch(
    ctx: typer.Context,
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="FILE [ARG:=VALUE]...",
            help="A launch file, by name, by path, or by package and name; and its arguments.",
            autocompletion=complete.launch_words,
            show_default=False,
        ),
    ] = None,
    duration: Annotated[float | None, seconds("--duration", "End after so many seconds.")] = None,
    workspace: Annotated[str, typer.Option("--workspace", metavar="FOLDER", help="Where to look first.")] = "",
    show_list: Annotated[bool, typer.Option("--list", help="List the launch files that there are.")] = False,
    show_args: Annotated[
        bool, typer.Option("--show-args", "-s", help="List the arguments of a launch file, and start nothing.")
    ] = False,
    validate: Annotated[
        bool, typer.Option("--validate", help="Find mistakes: make each node, but start nothing.")
    ] = False,
    graph: Annotated[str, choice("--graph", FORMATS, "Draw nodes and topics as text, and start nothing")] = "",
    json: Annotated[
        bool, typer.Option("--json", help="Print objects of JSON, one a line: events, or what is asked.")
    ] = False,
    in_process: Annotated[
        bool, typer.Option("--in-process", help="Run all nodes in this process, on a network of their own.")
    ] = False,
    status: Annotated[bool, typer.Option("--status", help="Show what runs in other shells.")] = False,
    top: Annotated[
        bool, typer.Option("--top", help="Show CPU and memory of each node; without a file, of what runs elsewhere.")
    ] = False,
    watch: Annotated[bool, typer.Option("--watch", help="Start a node again when its file is saved.")] = False,
) -> None:
    """Run a system of nodes until the first of them ends, Ctrl-C, or for a while: `launch follow --duration 60`.

    `launch stop [NAME] [NODE]` and `launch restart [NAME] NODE` are for what runs in another shell; --status shows the
    names. A launch file that is called stop or restart is launched by its path.
    """
    given = words or []
    options = Options(duration, workspace or None, json, in_process, top, watch)
    if show_list:
        _list(options.workspace)
    elif status or given[:1] in (["stop"], ["restart"]) or (top and not given):
        _ask(ctx, given, options, status)
    elif not given:
        ctx.fail("launch what? --list shows what there is")
    else:
        asked = launch_file(ctx, given, options.workspace)
        if show_args:
            _show_arguments(asked, json)
        elif validate:
            raise typer.Exit(_validate(asked, options))
        elif graph:
            _draw(asked, options, graph)
        else:
            raise typer.Exit(_run(ctx, asked, options))


def _list(workspace: str | None) -> None:
    from robolink.workspace import list_launches, purpose_of

    for line in aligned([(each.stem, purpose_of(each)) for each in list_launches(workspace=workspace)]):
        say(line)


def _ask(ctx: typer.Context, words: Sequence[str], options: Options, status: bool) -> None:
    """Ask what runs in other shells."""
    from robolink.cli import running

    what, *rest = words or [""]
    if rest and (status or options.top):
        ctx.fail("--status and --top take one NAME, or none")
    if options.top:
        running.top(what, json=options.json)
    elif status:
        running.status(what, json=options.json)
    elif what == "restart" and 1 <= len(rest) <= 2:
        running.restart(rest[-1], *rest[:-1])
    elif what == "stop" and len(rest) <= 1:
        running.stop(*rest)
    elif what == "stop" and len(rest) == 2:
        running.stop_one(rest[1], rest[0])
    else:
        ctx.fail("ask what? stop [NAME] [NODE] or restart [NAME] NODE, with the names that --status shows")


def _show_arguments(asked: LaunchFile, as_json: bool) -> None:
    from robolink.launch.reading.arguments import arguments_of

    found = arguments_of(asked.path)
    if as_json:
        import msgspec

        say(msgspec.json.encode(found).decode())
        return
    if not found:
        say(f"{asked.path.stem} has no arguments")
    rows = []
    for each in found:
        must = "must be given" if each.default is None else f"default: {each.default}"
        choices = f"; one of {', '.join(each.choices)}" if each.choices else ""
        description = f"{each.description} " if each.description else ""
        rows.append((each.name, f"{description}({must}{choices})"))
    for line in aligned(rows):
        say(line)


def _validate(asked: LaunchFile, options: Options) -> int:
    from robolink.exceptions import few
    from robolink.launch.looking.validate import Report, found, validate
    from robolink.launch.reading.entries import read_with_mistakes

    entries, mistakes = read_with_mistakes(asked.path, asked.given, workspace=options.workspace)
    report = Report(mistakes, ["no node was looked into: that comes when its file is right"])
    if not mistakes:
        report = validate(entries)
        report = Report(few(report.mistakes), report.notes)
    if options.json:
        import msgspec

        told = {"mistakes": [found(each) for each in report.mistakes], "notes": report.notes}
        say(msgspec.json.encode(told).decode())
        return 1 if report.mistakes else 0
    for note in report.notes:
        tell(f"robolink: {note}")
    for mistake in report.mistakes:
        say(str(mistake))
    if not report.mistakes:
        say(f"no mistake found in {asked.path}")
    return 1 if report.mistakes else 0


def _draw(asked: LaunchFile, options: Options, format_: str) -> None:
    from robolink.launch.looking.graph import drawn
    from robolink.launch.looking.look import looks_of
    from robolink.launch.reading.entries import read_launch_file

    entries = read_launch_file(asked.path, asked.given, workspace=options.workspace)
    looks = looks_of(entries)
    for each in entries:
        look = looks.get(each.name)
        if look is not None and (look.error or look.unseen):
            tell(f"robolink: {each.name} is drawn as far as it was made: {look.error or look.unseen}")
    say(drawn(entries, looks, format_).removesuffix("\n"))


def _run(ctx: typer.Context, asked: LaunchFile, options: Options) -> int:
    from robolink.launch.reading.entries import read_launch_file
    from robolink.supervisor import watch_lifeline

    watch_lifeline()  # a launcher that another one launched ends with it
    if options.in_process and (options.top or options.watch or options.json):
        ctx.fail("--in-process goes without --top, --watch and --json: there are no processes to tell of")
    entries = read_launch_file(asked.path, asked.given, workspace=options.workspace)
    if not entries:
        tell(f"robolink: {asked.path}: `if` and `unless` leave nothing to start")
        return 0
    if options.in_process:
        from robolink import oneprocess

        return oneprocess.run(entries, duration=options.duration)
    from robolink.launch.command import launch

    return launch(
        entries,
        asked.path,
        duration=options.duration,
        on_event=_event_printer() if options.json else None,
        watches=options.watch,
        shows_figures=options.top,
    )


def _event_printer() -> Callable[[Any], None]:
    import sys

    import msgspec

    from robolink.supervisor.telling.writer import Writer
    from robolink.terminal import fit

    writer = Writer(sys.stdout)
    return lambda event: writer.write(fit(msgspec.json.encode(event).decode()).encode() + b"\n")
