"""robolink bag: record bags, look at them, convert and mend them, with the verbs and flags of `ros2 bag`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from robolink.cli.bag.convert import convert_bags
from robolink.cli.bag.options import KnownStorage as Storage
from robolink.cli.bag.play import PlayCommand, play
from robolink.cli.bag.record import record
from robolink.cli.shared.noun import ListedOptions
from robolink.cli.shared.options import choice
from robolink.cli.shared.output import say, say_json, tell

app = typer.Typer(no_args_is_help=True, help="Record, play, inspect, convert and repair bags.")

BagPath = Annotated[Path, typer.Argument(metavar="BAG", help="Folder of the bag, or one .mcap or .db3 file.")]


@app.callback()
def _noun() -> None:
    """Record, play, inspect, convert and repair bags."""


@app.command("info")
def show_info(
    bag: BagPath,
    storage: Storage = "",
    topic_name: Annotated[bool, typer.Option("--topic-name", "-t", help="Print only the topic names.")] = False,
    verbose: Annotated[
        bool,
        typer.Option(
            "--verbose", "-v", help="Print sizes of topics, and requests and responses of services; reads all messages."
        ),
    ] = False,
    sort: Annotated[str, choice("--sort", ["name", "type", "count"], "Sort topics and services by")] = "name",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Show the duration, size, topics and services of a bag."""
    from robolink.bag.information import details_of, info_data, info_text, topic_names
    from robolink.bag.reader import open_bag

    if topic_name and verbose:
        tell("Warning! You have set both the '-t' and '-v' parameters. The '-t' parameter will be ignored.")
    with open_bag(bag) as opened:
        details = details_of(opened) if verbose else None
        if as_json:
            say_json(info_data(opened, sort, details))
        elif topic_name and not verbose:
            for name in topic_names(opened.metadata, sort):
                say(name)
        else:
            say(info_text(opened.metadata, sort, details))
        for problem in opened.problems:
            tell(problem)


@app.command("list")
def list_plugins(
    plugin_type: Annotated[
        str,
        typer.Argument(
            metavar="storage|converter|compressor|decompressor",
            help="Type of the plugins.",
            autocompletion=lambda: ["storage", "converter", "compressor", "decompressor"],
        ),
    ],
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Print descriptions too.")] = False,
) -> None:
    """List the plugins for storage and compression."""
    from robolink.cli.bag.plugins import plugins

    found = plugins(plugin_type)
    if verbose:
        say(f"available {plugin_type} plugins are:")
    for name, description in found:
        say(f"name: {name}\n\t{description}" if verbose else name)


app.command("record", cls=ListedOptions)(record)
app.command("play", cls=PlayCommand)(play)
app.command("convert", cls=ListedOptions)(convert_bags)


@app.command("reindex")
def reindex_bag(bag: BagPath, storage: Storage = "") -> None:
    """Reconstruct the metadata of a bag, and repair files that were not closed."""
    from robolink.bag.converting import reindex

    say(f"Beginning reindexing bag in directory: {bag}" if bag.is_dir() else f"Beginning reindexing bag: {bag}")
    reindex(bag, say)
    say("Reindexing complete.")
