"""robolink bag convert: its arguments, and the conversion."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robolink.cli.bag.options import STORAGES, names, selection_of
from robolink.cli.shared.options import choice
from robolink.cli.shared.output import say, tell

if TYPE_CHECKING:
    from robolink.bag.converting import Output
    from robolink.bag.reader import Bag


Names = list[str] | None
"""Values of an option that takes several."""
_FORMATS = ["zstd", "lz4", "none"]

Words = Annotated[Names, typer.Argument(metavar="[IN...] OUT", help="Bags to read, and the folder of the new bag.")]
Inputs = Annotated[Names, typer.Option("--input", "-i", metavar="BAG [STORAGE]", help="Bag to read; may be repeated.")]
OutputOptions = Annotated[
    Path | None,
    typer.Option(
        "--output-options", "-o", metavar="YAML", help="YAML file with options of the output bags, as rosbag2 takes it."
    ),
]
Storage = Annotated[str, choice("--storage", STORAGES, "Storage plugin of the new bag", short="-s")]
Compression = Annotated[str, choice("--compression", _FORMATS, "Compression format, of chunks in MCAP files")]
CompressionMode = Annotated[
    str, choice("--compression-mode", ["none", "file", "message"], "Unit of compression by rosbag2, with zstd")
]
CompressionFormat = Annotated[str, choice("--compression-format", _FORMATS, "Same as --compression")]
MaxSize = Annotated[
    int, typer.Option("--max-bag-size", "-b", metavar="BYTES", min=0, help="Size at which the bag is split, in bytes.")
]
MaxDuration = Annotated[
    float,
    typer.Option("--max-bag-duration", "-d", metavar="S", min=0, help="Time after which the bag is split, in seconds."),
]
Topics = Annotated[Names, names("--topics", help="Topics to convert; all by default.")]
TopicTypes = Annotated[Names, names("--topic-types", help="Topic types to convert.")]
Services = Annotated[Names, names("--services", help="Services to convert, by their events.")]
Actions = Annotated[Names, names("--actions", help="Actions to convert.")]
Regex = Annotated[
    str,
    typer.Option(
        "--regex", "-e", help="Convert topics, services and actions whose names match this regular expression."
    ),
]
ExcludeRegex = Annotated[str, typer.Option("--exclude-regex", help="Exclude names that match this regular expression.")]
ExcludeTopics = Annotated[Names, names("--exclude-topics", help="Topics to exclude.")]
ExcludeTypes = Annotated[Names, names("--exclude-topic-types", help="Topic types to exclude.")]
ExcludeServices = Annotated[Names, names("--exclude-services", help="Services to exclude.")]
ExcludeActions = Annotated[Names, names("--exclude-actions", help="Actions to exclude.")]
Offset = Annotated[
    float, typer.Option("--start-offset", metavar="S", min=0, help="Offset from the start of the bags, in seconds.")
]
Duration = Annotated[
    float, typer.Option("--duration", metavar="S", min=0, help="Duration to convert, in seconds; 0 for all.")
]


def convert_bags(
    ctx: typer.Context,
    words: Words = None,
    inputs: Inputs = None,
    output_options: OutputOptions = None,
    storage: Storage = "mcap",
    compression: Compression = "",
    compression_mode: CompressionMode = "",
    compression_format: CompressionFormat = "",
    max_bag_size: MaxSize = 0,
    max_bag_duration: MaxDuration = 0.0,
    topics: Topics = None,
    topic_types: TopicTypes = None,
    services: Services = None,
    actions: Actions = None,
    regex: Regex = "",
    exclude_regex: ExcludeRegex = "",
    exclude_topics: ExcludeTopics = None,
    exclude_topic_types: ExcludeTypes = None,
    exclude_services: ExcludeServices = None,
    exclude_actions: ExcludeActions = None,
    start_offset: Offset = 0.0,
    duration: Duration = 0.0,
) -> None:
    """Convert bags to a new one: compression, storage, split files, selected topics, several bags merged.

    robolink bag convert IN OUT --compression zstd --topics /scan /odom

    robolink bag convert -i IN -i ANOTHER -o options.yaml
    """
    from robolink.bag.converting import Output

    paths, target = _paths(list(words or []), list(inputs or []), output_options)
    requested = Output(
        target,
        storage,
        selection_of(ctx.params).checked(),
        _word(compression or compression_format),
        _word(compression_mode),
        max_bag_size,
        max_bag_duration,
    )
    _convert(paths, output_options, requested, (start_offset, duration))


def _word(name: str) -> str:
    return "" if name == "none" else name


def _paths(words: list[str], inputs: list[str], options: Path | None) -> tuple[list[str], Path]:
    """Return the bags to read, and the folder to write; the folder is nothing where a file of options names it.

    A storage behind a bag, as in `-i BAG mcap`, is left out: the files tell it.
    """
    found = [each for each in [*inputs, *words] if each not in STORAGES or Path(each).exists()]
    target = "" if options is not None or not found else (words or inputs)[-1]
    if target:
        found.remove(target)
    if not found or (options is None and not target):
        raise typer.BadParameter(
            "convert what into what? 'robolink bag convert IN OUT', or rosbag2's way: '-i IN -o OPTIONS.yaml'"
        )
    return found, Path(target)


def _convert(paths: Sequence[str], options: Path | None, requested: Output, span: tuple[float, float]) -> None:
    """Convert with a bar of progress, and print a line for each bag that was written."""
    import contextlib

    from robolink.bag.converting import convert
    from robolink.bag.output_options import read_outputs
    from robolink.bag.reader import open_bag
    from robolink.cli.shared.terminal import Progress

    outputs = read_outputs(options) if options is not None else []
    with contextlib.ExitStack() as stack:
        bags = [stack.enter_context(open_bag(each)) for each in paths]
        outputs = outputs or [_between(requested, bags, *span)]
        total = sum(each.metadata.message_count for each in bags)
        with Progress(total, "messages") as progress:
            counts = convert(bags, outputs, progress.show)
        for problem in (line for each in bags for line in each.problems):
            tell(problem)
    for output, count in zip(outputs, counts, strict=True):
        say(_written(output, count))


def _between(requested: Output, bags: Sequence[Bag], offset: float, duration: float) -> Output:
    """Return the output with its limits of time, which are counted from the first message of all bags."""
    begin = min((each.start_time for each in bags if each.metadata.message_count), default=0) + round(offset * 1e9)
    return requested._replace(
        start=begin if offset else None,
        end=begin + round(duration * 1e9) if duration else None,
    )


def _written(output: Output, count: int) -> str:
    from robolink.bag.information import size_text
    from robolink.bag.reader import open_bag

    with open_bag(output.path) as bag:
        files = len(bag.metadata.files)
        size = size_text(bag.metadata.bag_size)
        return (
            f"{output.path}: {count} messages of {len(bag.topics)} topics, {size} in {files} file{'s' * (files != 1)}"
        )
