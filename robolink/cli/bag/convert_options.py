"""Arguments and flags of `robolink bag convert`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from robolink.cli.bag.options import STORAGES, names
from robolink.cli.shared.options import choice

Names = list[str] | None
"""Values of an option that takes several."""
_FORMATS = ["zstd", "lz4", "none"]

Words = Annotated[
    Names, typer.Argument(metavar="[IN...] OUT", help="Bags to read, and the folder of the bag to write.")
]
Inputs = Annotated[
    Names, typer.Option("--input", "-i", metavar="BAG [STORAGE]", help="A bag to read; as often as needed.")
]
OutputOptions = Annotated[
    Path | None,
    typer.Option("--output-options", "-o", metavar="YAML", help="File with rosbag2's options of the outputs."),
]
Storage = Annotated[str, choice("--storage", STORAGES, "Storage of the output", short="-s")]
Compression = Annotated[str, choice("--compression", _FORMATS, "Compression, in an MCAP of its chunks")]
CompressionMode = Annotated[
    str, choice("--compression-mode", ["none", "file", "message"], "rosbag2's other ways to compress, by zstd")
]
CompressionFormat = Annotated[str, choice("--compression-format", _FORMATS, "ros2's name of --compression")]
MaxSize = Annotated[
    int, typer.Option("--max-bag-size", "-b", metavar="BYTES", min=0, help="Size at which a new file begins.")
]
MaxDuration = Annotated[
    float, typer.Option("--max-bag-duration", "-d", metavar="S", min=0, help="Time after which a new file begins.")
]
Topics = Annotated[Names, names("--topics", help="Topics to keep; all by default.")]
TopicTypes = Annotated[Names, names("--topic-types", help="Types of topics to keep.")]
Services = Annotated[Names, names("--services", help="Services whose events to keep.")]
Actions = Annotated[Names, names("--actions", help="Actions whose topics to keep.")]
Regex = Annotated[str, typer.Option("--regex", "-e", help="Topics, services and actions to keep.")]
ExcludeRegex = Annotated[str, typer.Option("--exclude-regex", help="Topics, services and actions to leave out.")]
ExcludeTopics = Annotated[Names, names("--exclude-topics", help="Topics to leave out.")]
ExcludeTypes = Annotated[Names, names("--exclude-topic-types", help="Types of topics to leave out.")]
ExcludeServices = Annotated[Names, names("--exclude-services", help="Services to leave out.")]
ExcludeActions = Annotated[Names, names("--exclude-actions", help="Actions to leave out.")]
Offset = Annotated[
    float, typer.Option("--start-offset", metavar="S", min=0, help="Seconds at the beginning to leave out.")
]
Duration = Annotated[
    float, typer.Option("--duration", metavar="S", min=0, help="Seconds to keep from there; 0 is all.")
]
