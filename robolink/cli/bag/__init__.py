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

app = typer.Typer(no_args_is_help=True, help="Record bags, look at them, convert and mend them.")

BagPath = Annotated[Path, typer.Argument(metavar="BAG", help="A bag's folder, or one .mcap or .db3 file.")]


@app.callback()
def _noun() -> None:
    """Record bags, look at them, convert and mend them."""


@app.command("info")
def show_info(
    bag: BagPath,
    storage: Storage = "",
    topic_name: Annotated[bool, typer.Option("--topic-name", "-t", help="Only display topic names.")] = False,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Also sizes of topics, requests and responses: reads all messages.")
    ] = False,
    sort: Annotated[str, choice("--sort", ["name", "type", "count"], "Order of topics and services")] = "name",
    as_json: Annotated[bool, typer.Option("--json", help="JSON, for programs.")] = False,
) -> None:
    """Print information about a bag."""
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
            help="What to list.",
            autocompletion=lambda: ["storage", "converter", "compressor", "decompressor"],
        ),
    ],
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Also say what each is.")] = False,
) -> None:
    """List the storages and compressions that there are."""
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
    """Reconstruct the metadata of a bag, and make files whole whose recorder was killed."""
    from robolink.bag.reindexing import reindex

    say(f"Beginning reindexing bag in directory: {bag}" if bag.is_dir() else f"Beginning reindexing bag: {bag}")
    reindex(bag, say)
    say("Reindexing complete.")
