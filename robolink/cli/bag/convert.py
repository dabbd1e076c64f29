"""robolink bag convert: bags written anew, by rosbag2's YAML of output options or by flags."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from robolink.cli.bag import convert_options as opt
from robolink.cli.bag.options import STORAGES, selection_of
from robolink.cli.shared.output import say, tell

if TYPE_CHECKING:
    from robolink.bag.converting import Output
    from robolink.bag.reader import Bag


def convert_bags(
    ctx: typer.Context,
    words: opt.Words = None,
    inputs: opt.Inputs = None,
    output_options: opt.OutputOptions = None,
    storage: opt.Storage = "mcap",
    compression: opt.Compression = "",
    compression_mode: opt.CompressionMode = "",
    compression_format: opt.CompressionFormat = "",
    max_bag_size: opt.MaxSize = 0,
    max_bag_duration: opt.MaxDuration = 0.0,
    topics: opt.Topics = None,
    topic_types: opt.TopicTypes = None,
    services: opt.Services = None,
    actions: opt.Actions = None,
    regex: opt.Regex = "",
    exclude_regex: opt.ExcludeRegex = "",
    exclude_topics: opt.ExcludeTopics = None,
    exclude_topic_types: opt.ExcludeTypes = None,
    exclude_services: opt.ExcludeServices = None,
    exclude_actions: opt.ExcludeActions = None,
    start_offset: opt.Offset = 0.0,
    duration: opt.Duration = 0.0,
) -> None:
    """Write bags anew: other compression, storage, files or topics; several become one.

    robolink bag convert IN OUT --compression zstd --topics /scan /odom

    robolink bag convert -i IN -i ANOTHER -o options.yaml
    """
    from robolink.bag.converting import Output

    paths, target = _paths(list(words or []), list(inputs or []), output_options)
    wished = Output(
        target,
        storage,
        selection_of(ctx.params).checked(),
        _word(compression or compression_format),
        _word(compression_mode),
        max_bag_size,
        max_bag_duration,
    )
    _convert(paths, output_options, wished, (start_offset, duration))


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


def _convert(paths: Sequence[str], options: Path | None, wished: Output, span: tuple[float, float]) -> None:
    """Convert with a bar of progress, and print a line for each bag that was written."""
    import contextlib

    from robolink.bag.converting import convert
    from robolink.bag.output_options import read_outputs
    from robolink.bag.reader import open_bag
    from robolink.cli.shared.terminal import Progress

    outputs = read_outputs(options) if options is not None else []
    with contextlib.ExitStack() as stack:
        bags = [stack.enter_context(open_bag(each)) for each in paths]
        outputs = outputs or [_between(wished, bags, *span)]
        total = sum(each.metadata.message_count for each in bags)
        with Progress(total, "messages") as progress:
            counts = convert(bags, outputs, progress.show)
        for problem in (line for each in bags for line in each.problems):
            tell(problem)
    for output, count in zip(outputs, counts, strict=True):
        say(_written(output, count))


def _between(wished: Output, bags: Sequence[Bag], offset: float, duration: float) -> Output:
    """Return the output with its limits of time, which are counted from the first message of all bags."""
    begin = min((each.start_time for each in bags if each.metadata.message_count), default=0) + round(offset * 1e9)
    return wished._replace(
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
