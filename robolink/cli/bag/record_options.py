"""Arguments and flags of `robolink bag record`, with the spelling of `ros2 bag record`."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from robolink.cli.bag.options import STORAGES, file, flag, names
from robolink.cli.shared import complete
from robolink.cli.shared.options import choice, seconds

LARGEST = 2**63 - 1


def _number(*names: str, help: str, metavar: str = "N") -> Any:  # noqa: A002
    return typer.Option(*names, metavar=metavar, help=help, min=0, max=LARGEST)


_TOPICS = complete.topic_names

Words = Annotated[
    list[str] | None,
    typer.Argument(metavar="[TOPIC]...", help="Topics to record.", autocompletion=_TOPICS, show_default=False),
]
Output = Annotated[str, typer.Option("--output", "-o", metavar="FOLDER", help="The bag; rosbag2_DATE by default.")]
Storage = Annotated[str, choice("--storage", STORAGES, "Format of the files", short="-s")]

Topics = Annotated[list[str] | None, names("--topics", help="Topics to record.", completion=_TOPICS)]
TopicTypes = Annotated[
    list[str] | None,
    names("--topic-types", help="Record all topics of these types.", completion=complete.message_types),
]
Services = Annotated[list[str] | None, names("--services", help="Services whose events are recorded.")]
Actions = Annotated[list[str] | None, names("--actions", help="Actions to record.")]
All = Annotated[bool, flag("--all", "-a", help="Record all topics, services and actions.")]
AllTopics = Annotated[bool, flag("--all-topics", help="Record all topics.")]
AllServices = Annotated[bool, flag("--all-services", help="Record the events of all services that have them.")]
AllActions = Annotated[bool, flag("--all-actions", help="Record all actions.")]
Regex = Annotated[str, typer.Option("--regex", "-e", metavar="REGEX", help="Record what has this in its name.")]
ExcludeRegex = Annotated[str, typer.Option("--exclude-regex", metavar="REGEX", help="Leave out such names.")]
ExcludeTopics = Annotated[list[str] | None, names("--exclude-topics", help="Leave out topics.", completion=_TOPICS)]
ExcludeTypes = Annotated[list[str] | None, names("--exclude-topic-types", help="Leave out topics of these types.")]
ExcludeServices = Annotated[list[str] | None, names("--exclude-services", help="Leave out services.")]
ExcludeActions = Annotated[list[str] | None, names("--exclude-actions", help="Leave out actions.")]

Unpublished = Annotated[bool, flag("--include-unpublished-topics", help="Also topics with subscriptions only.")]
Hidden = Annotated[bool, flag("--include-hidden-topics", help="Also those that begin with _.")]
NoDiscovery = Annotated[bool, flag("--no-discovery", help="Only what is there at the start.")]
PollingInterval = Annotated[
    int, typer.Option("--polling-interval", "-p", metavar="MS", help="Accepted: nothing polls.")
]
IgnoreLeaf = Annotated[bool, flag("--ignore-leaf-topics", help="Leave out topics that nobody subscribes to.")]
StaticTopics = Annotated[str, file("--static-topics-path", help="YAML with topics and types to listen to at once.")]

Format = Annotated[str, choice("--serialization-format", ["cdr"], "Accepted, as this is what comes", short="-f")]
MaxSize = Annotated[int, _number("--max-bag-size", "-b", metavar="BYTES", help="Begin a new file at this size.")]
MaxDuration = Annotated[
    float,
    typer.Option("--max-bag-duration", "-d", metavar="S", help="Begin a new file after so many seconds.", min=0),
]
MaxFiles = Annotated[int, _number("--max-bag-files", help="Keep so many files, the newest.")]
CacheSize = Annotated[
    int, _number("--max-cache-size", metavar="BYTES", help="Of what waits to be written; 0: no limit.")
]
CacheDuration = Annotated[float, seconds("--max-cache-duration", "Of what waits, or of a snapshot; 0: no limit.")]
StartPaused = Annotated[bool, flag("--start-paused", help="Start in a pause.")]
SimTime = Annotated[bool, flag("--use-sim-time", help="Note messages with the time of /clock.")]
NodeName = Annotated[str, typer.Option("--node-name", metavar="NAME", help="Name of the recorder's node.")]
CustomData = Annotated[
    list[str] | None, names("--custom-data", metavar="KEY=VALUE...", help="Texts for metadata.yaml.")
]
Snapshot = Annotated[bool, flag("--snapshot-mode", help="Keep it in memory; ~/snapshot or the key s writes it.")]
Repeat = Annotated[
    list[str] | None,
    names(
        "--repeat-transient-local",
        "--repeat-latched",
        metavar="TOPIC[=N]...",
        help="Begin each further file and snapshot with the last N messages of latched topics.",
    ),
]
RepeatAll = Annotated[
    bool, flag("--repeat-all-transient-local", help="So for all latched topics, as many as publishers keep.")
]

CompressionMode = Annotated[
    str, choice("--compression-mode", ["none", "chunk", "file", "message"], "What is compressed")
]
CompressionFormat = Annotated[
    str, choice("--compression-format", ["zstd", "lz4"], "With what; alone, it is for chunks")
]
PRESETS = ["none", "fastwrite", "resilient", "zstd_fast", "zstd_small"]
Preset = Annotated[str, choice("--storage-preset-profile", PRESETS, "rosbag2's presets: zstd_ ones compress chunks")]
StorageConfig = Annotated[str, file("--storage-config-file", help="YAML of the MCAP storage: its compression counts.")]
QueueSize = Annotated[int, typer.Option("--compression-queue-size", hidden=True)]
Threads = Annotated[int, typer.Option("--compression-threads", hidden=True)]
Priority = Annotated[int, typer.Option("--compression-threads-priority", hidden=True)]
AsJson = Annotated[bool, flag("--json", help="In the end, one object of JSON with the figures.")]
