"""robolink launch: run a system of nodes that a file describes, look at it without running it, ask a running one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext, redirect_stdout
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer
import typer.core

from robolink.cli.launching.launch_arguments import ASSIGN, LaunchFile, launch_file, launch_words, show_launch_schema
from robolink.cli.shared.layout import aligned
from robolink.cli.shared.marks import BAD, GOOD, say_styled
from robolink.cli.shared.options import GRAPH_FORMATS, choice, seconds
from robolink.cli.shared.options import enclave as enclave_option
from robolink.cli.shared.output import say, tell

if TYPE_CHECKING:
    from robolink.launch.entry import Entry

BY_DATE = "rosbag2_DATE"
"""Value of a `--record` without a folder."""

VALUED = ("--duration", "--workspace", "--graph", "--enclave")
"""Options whose next word is their value."""

app = typer.Typer()


class LaunchCommand(typer.core.TyperCommand):
    """A command whose `--graph` and `--record` may go without a value."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the arguments, a bare `--graph` or `--record` with its default value."""
        left: list[str] = super().parse_args(ctx, with_folder(spelled_out(args)))
        names = [each for each in ctx.params.get("words") or [] if ASSIGN not in each]
        behind = next((args[index + 1] for index, each in enumerate(args[:-1]) if each == "--graph"), "")
        if behind in names[1:]:  # the first is the launch file
            ctx.fail(f"--graph draws {' or '.join(GRAPH_FORMATS)}, not '{behind}'")
        return left


def spelled_out(args: Sequence[str]) -> list[str]:
    """Return the arguments with the default format behind each `--graph` that has none."""
    result: list[str] = []
    for index, each in enumerate(args):
        is_bare = each == "--graph" and "".join(args[index + 1 : index + 2]) not in GRAPH_FORMATS
        result.append(f"{each}={GRAPH_FORMATS[0]}" if is_bare else each)
    return result


def with_folder(args: Sequence[str]) -> list[str]:
    """Return the arguments with the default folder for a `--record` that has none.

    The word behind it is its folder if a launch file was named before, and that word is not an option and no argument.
    """
    result: list[str] = []
    is_value = has_file = False
    for index, each in enumerate(args):
        if each == "--record":
            behind = "".join(args[index + 1 : index + 2])
            is_value = has_file and bool(behind) and not behind.startswith("-") and ASSIGN not in behind
            result.append(each if is_value else f"{each}={BY_DATE}")
            continue
        has_file |= not (is_value or each.startswith("-") or ASSIGN in each)
        is_value = each in VALUED
        result.append(each)
    return result


class Options(NamedTuple):
    """Options of `launch`, besides the launch file."""

    duration: float | None
    workspace: str | None
    json: bool
    top: bool
    watch: bool
    view: bool
    record: str | None
    enclave: str


@app.command(cls=LaunchCommand)
def launch(
    ctx: typer.Context,
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="FILE [ARG:=VALUE]...",
            help="Launch file, by name, by path, or by package and name; then its arguments.",
            autocompletion=launch_words,
            show_default=False,
        ),
    ] = None,
    duration: Annotated[float | None, seconds("--duration", "Exit after this number of seconds.")] = None,
    workspace: Annotated[str, typer.Option("--workspace", metavar="FOLDER", help="Workspace to search first.")] = "",
    show_list: Annotated[bool, typer.Option("--list", help="List the available launch files.")] = False,
    show_args: Annotated[
        bool, typer.Option("--show-args", "-s", help="Print the arguments of a launch file, and start nothing.")
    ] = False,
    validate: Annotated[
        bool, typer.Option("--validate", help="Check the launch file: create each node, but start nothing.")
    ] = False,
    graph: Annotated[
        str, choice("--graph", GRAPH_FORMATS, "Print a graph of nodes and topics, and start nothing")
    ] = "",
    json: Annotated[
        bool, typer.Option("--json", help="Print JSON: events, one object a line, or what another option prints.")
    ] = False,
    status: Annotated[bool, typer.Option("--status", help="Show the systems that run in other shells.")] = False,
    top: Annotated[
        bool, typer.Option("--top", help="Show CPU and memory of each node; without a launch file, of running systems.")
    ] = False,
    watch: Annotated[bool, typer.Option("--watch", help="Restart a node when its file is saved.")] = False,
    view: Annotated[bool, typer.Option("--view", help="Show the system in the browser (robolink view).")] = False,
    record: Annotated[
        str | None, typer.Option("--record", metavar="[FOLDER]", help="Record all topics into a bag.")
    ] = None,
    schema: Annotated[
        bool,
        typer.Option(
            "--schema", callback=show_launch_schema, is_eager=True, help="Print the JSON schema of launch files."
        ),
    ] = False,
    enclave: Annotated[
        str, enclave_option("Security enclave of --record, --view and the launcher; / by default.")
    ] = "",
) -> None:
    """Start the nodes of a launch file, until the first one ends or Ctrl-C: `launch follow --duration 60`.

    `launch stop [NAME] [NODE]` and `launch restart [NAME] NODE` are for what runs in another shell; --status shows the
    names. A launch file that is called stop or restart is launched by its path.
    """
    given = words or []
    options = Options(duration, workspace or None, json, top, watch, view, record, enclave)
    if show_list:
        _list(options.workspace)
    elif status or given[:1] in (["stop"], ["restart"]) or (top and not given):
        _ask(ctx, given, options, status)
    elif not given:
        ctx.fail("launch what? --list shows what there is")
    else:
        file = launch_file(ctx, given, options.workspace)
        if show_args:
            _show_arguments(file, json, options.workspace)
        elif validate:
            raise typer.Exit(_validate(file, options))
        elif graph:
            _draw(file, options, graph)
        else:
            raise typer.Exit(_run(ctx, file, options))


def _list(workspace: str | None) -> None:
    from robolink.workspace import list_launches, purpose_of

    for line in aligned([(each.stem, purpose_of(each)) for each in list_launches(workspace=workspace)]):
        say(line)


def _ask(ctx: typer.Context, words: Sequence[str], options: Options, status: bool) -> None:
    """Query or control the launchers that run in other shells."""
    from robolink.cli.launching import launchers

    what, *rest = words or [""]
    if rest and (status or options.top):
        ctx.fail("--status and --top take one NAME, or none")
    if options.top:
        launchers.top(what, json=options.json)
    elif status:
        launchers.status(what, json=options.json)
    elif what == "restart" and 1 <= len(rest) <= 2:
        launchers.restart(rest[-1], *rest[:-1])
    elif what == "stop" and len(rest) <= 1:
        launchers.stop(*rest)
    elif what == "stop" and len(rest) == 2:
        launchers.stop_one(rest[1], rest[0])
    else:
        ctx.fail("ask what? stop [NAME] [NODE] or restart [NAME] NODE, with the names that --status shows")


def _prints_apart(is_apart: bool) -> AbstractContextManager[object]:
    """Return a context in which what a launch file prints goes to standard error, where the output is for machines."""
    import sys

    return redirect_stdout(sys.stderr) if is_apart else nullcontext()


def _show_arguments(file: LaunchFile, as_json: bool, workspace: str | None) -> None:
    from robolink.launch.system import arguments_of

    with _prints_apart(as_json):
        found = arguments_of(file.path, workspace=workspace)
    if as_json:
        import msgspec

        say(msgspec.json.encode(found).decode())
        return
    if not found:
        say(f"{file.path.stem} has no arguments")
    rows = []
    for each in found:
        must = "must be given" if each.default is None else f"default: {each.default}"
        choices = f"; one of {', '.join(each.choices)}" if each.choices else ""
        description = f"{each.description} " if each.description else ""
        rows.append((each.name, f"{description}({must}{choices})"))
    for line in aligned(rows):
        say(line)


def _validate(file: LaunchFile, options: Options) -> int:
    from robolink.documents.mistakes import first_mistakes
    from robolink.launch.looking.validate import Report, found, validate
    from robolink.launch.system import read_system_with_mistakes

    with _prints_apart(options.json):
        system, mistakes = read_system_with_mistakes(file.path, file.given, workspace=options.workspace)
    report = Report(mistakes, ["no node was looked into: that comes when its file is right"])
    if not mistakes:
        report = validate(system.entries)
        report = Report(first_mistakes(report.mistakes), [*system.notes, *report.notes])
    if options.json:
        import msgspec

        result = {"mistakes": [found(each) for each in report.mistakes], "notes": report.notes}
        say(msgspec.json.encode(result).decode())
        return 1 if report.mistakes else 0
    for note in report.notes:
        tell(f"robolink: {note}")
    for mistake in report.mistakes:
        place, mark, text = str(mistake).partition(": ")
        say_styled(place, BAD, mark + text)
    if not report.mistakes:
        say_styled("no mistake found", GOOD, f" in {file.path}")
    return 1 if report.mistakes else 0


def _draw(file: LaunchFile, options: Options, format_: str) -> None:
    from robolink.launch.looking.graph import drawn
    from robolink.launch.looking.look import looks_of
    from robolink.launch.system import read_system

    with _prints_apart(True):
        entries, notes, _ = read_system(file.path, file.given, workspace=options.workspace, foresee=True)
    for note in notes:
        tell(f"robolink: {note}")
    looks = looks_of(entries)
    for each in entries:
        look = looks.get(each.name)
        if look is not None and (look.error or look.unseen):
            tell(f"robolink: {each.name} is drawn as far as it was made: {look.error or look.unseen}")
    say(drawn(entries, looks, format_).removesuffix("\n"))


def _run(ctx: typer.Context, file: LaunchFile, options: Options) -> int:
    from robolink.launch.system import read_system, record_of
    from robolink.supervisor import watch_lifeline

    watch_lifeline()  # a launcher that another one launched ends with it
    with _prints_apart(options.json):
        entries, notes, direct = read_system(file.path, file.given, workspace=options.workspace)
    if not entries and direct is None:
        return _nothing(file, notes)
    from robolink.launch.command import launch

    record = record_of(file.path, file.given) if options.record is None else options.record
    _join_network(entries)
    return launch(
        entries,
        file.path,
        duration=options.duration,
        on_event=_event_printer() if options.json else None,
        watches=options.watch,
        shows_figures=options.top,
        shows_view=options.view,
        record="" if record == BY_DATE else record,
        enclave=options.enclave,
        notes=notes if options.view or options.json else [*_where_to_look(), *notes],
        direct=direct,
    )


def _where_to_look() -> list[str]:
    """Return a line about where the system is seen, for who sits at a terminal without a browser; none for others."""
    import sys

    from robolink.cli.shared.page import where_to_look

    line = where_to_look() if sys.stdout is not None and sys.stdout.isatty() else ""
    return [line] if line else []


def _nothing(file: LaunchFile, notes: Sequence[str]) -> int:
    """Report that a launch file starts nothing, which is a failure if something of it cannot run here."""
    from robolink.launch.lookup import is_of_ros

    for note in notes:
        tell(f"robolink: {note}")
    is_lacking = any("left out: " in note for note in notes)
    why = "it starts nothing" if is_of_ros(file.path) else "`if` and `unless` leave nothing to start"
    tell(f"robolink: {file.path}: {'nothing of it can be started' if is_lacking else why}")
    return 1 if is_lacking else 0


def _join_network(entries: Sequence[Entry]) -> None:
    """Put this process and all that it starts on the system's network; raises TransportError if there is none."""
    import os

    from robolink.launch.planning import network_of
    from robolink.networks.kinds import requested_kind
    from robolink.networks.request import ALIASES, NAMES, NETWORK, ask, domain_id

    given = network_of(entries, os.environ)
    os.environ.update(given)  # not in each node's `env`, with which none can be forked
    if NETWORK in given:
        ask(os.environ, given[NETWORK], "network, in the launch file")
    if (kind := requested_kind(None, os.environ)) is not None:
        kind.meets(os.environ)
    elif os.environ.get(NETWORK, "localhost") not in (*NAMES, *ALIASES):
        from robolink.transport import network

        network.plan(None, domain_id(os.environ), os.environ)  # one line here, and not one of each node


def _event_printer() -> Callable[[Any], None]:
    import sys

    import msgspec

    from robolink.supervisor.reporting.printer import Writer
    from robolink.system.terminal import fit

    writer = Writer(sys.stdout)
    return lambda event: writer.write(fit(msgspec.json.encode(event).decode()).encode() + b"\n")
