"""robolink bag record: its arguments, in ros2's spelling."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Any

import typer

from robolink.cli.bag import options as shared
from robolink.cli.bag.options import STORAGES, file, flag, names
from robolink.cli.shared import complete
from robolink.cli.shared.options import Enclave, choice, seconds

if TYPE_CHECKING:
    from robolink.bag.recording import RecordSettings
    from robolink.bag.selection import Selection


LARGEST = 2**63 - 1


def _number(*names: str, help: str, metavar: str = "N") -> Any:  # noqa: A002
    return typer.Option(*names, metavar=metavar, help=help, min=0, max=LARGEST)


_TOPICS = complete.topic_names

Words = Annotated[
    list[str] | None,
    typer.Argument(metavar="[TOPIC]...", help="Topics to record.", autocompletion=_TOPICS, show_default=False),
]
Output = Annotated[
    str, typer.Option("--output", "-o", metavar="FOLDER", help="Folder of the new bag; rosbag2_DATE by default.")
]
Storage = Annotated[str, choice("--storage", STORAGES, "Storage plugin", short="-s")]

Topics = Annotated[list[str] | None, names("--topics", help="Topics to record.", completion=_TOPICS)]
TopicTypes = Annotated[
    list[str] | None,
    names("--topic-types", help="Topic types to record.", completion=complete.message_types),
]
Services = Annotated[list[str] | None, names("--services", help="Services to record, by their events.")]
Actions = Annotated[list[str] | None, names("--actions", help="Actions to record.")]
All = Annotated[bool, flag("--all", "-a", help="Record all topics, services and actions.")]
AllTopics = Annotated[bool, flag("--all-topics", help="Record all topics.")]
AllServices = Annotated[bool, flag("--all-services", help="Record all services whose introspection is enabled.")]
AllActions = Annotated[bool, flag("--all-actions", help="Record all actions.")]
Regex = Annotated[
    str,
    typer.Option(
        "--regex",
        "-e",
        metavar="REGEX",
        help="Record topics, services and actions whose names match this regular expression.",
    ),
]
ExcludeRegex = Annotated[
    str, typer.Option("--exclude-regex", metavar="REGEX", help="Exclude names that match this regular expression.")
]
ExcludeTopics = Annotated[list[str] | None, names("--exclude-topics", help="Topics to exclude.", completion=_TOPICS)]
ExcludeTypes = Annotated[list[str] | None, names("--exclude-topic-types", help="Topic types to exclude.")]
ExcludeServices = Annotated[list[str] | None, names("--exclude-services", help="Services to exclude.")]
ExcludeActions = Annotated[list[str] | None, names("--exclude-actions", help="Actions to exclude.")]

Unpublished = Annotated[
    bool, flag("--include-unpublished-topics", help="Record topics that have no publisher yet, too.")
]
Hidden = Annotated[bool, flag("--include-hidden-topics", help="Include hidden names, which begin with _.")]
NoDiscovery = Annotated[bool, flag("--no-discovery", help="Do not discover topics after the start.")]
PollingInterval = Annotated[
    int,
    typer.Option(
        "--polling-interval", "-p", metavar="MS", help="Accepted for ros2's sake: discovery needs no polling."
    ),
]
IgnoreLeaf = Annotated[bool, flag("--ignore-leaf-topics", help="Ignore topics without subscriptions.")]
StaticTopics = Annotated[
    str,
    file("--static-topics-path", help="YAML file with topics and their types, which are subscribed to at the start."),
]

Format = Annotated[str, choice("--serialization-format", ["cdr"], "Serialization format, always", short="-f")]
MaxSize = Annotated[
    int,
    _number("--max-bag-size", "-b", metavar="BYTES", help="Size at which the bag is split, in bytes; 0 never splits."),
]
MaxDuration = Annotated[
    float,
    typer.Option(
        "--max-bag-duration",
        "-d",
        metavar="S",
        help="Time after which the bag is split, in seconds; 0 never splits.",
        min=0,
    ),
]
MaxFiles = Annotated[int, _number("--max-bag-files", help="Number of newest files to keep; older ones are deleted.")]
CacheSize = Annotated[
    int,
    _number(
        "--max-cache-size",
        metavar="BYTES",
        help="Largest size of the cache of messages to write, in bytes; 0 for no limit.",
    ),
]
CacheDuration = Annotated[
    float, seconds("--max-cache-duration", "Longest time in the cache or the snapshot, in seconds; 0 for no limit.")
]
StartPaused = Annotated[bool, flag("--start-paused", help="Start paused.")]
SimTime = Annotated[bool, flag("--use-sim-time", help="Use simulation time, from /clock, for the timestamps.")]
NodeName = Annotated[str, typer.Option("--node-name", metavar="NAME", help="Name of the recorder node.")]
CustomData = Annotated[
    list[str] | None, names("--custom-data", metavar="KEY=VALUE...", help="Custom data to store in metadata.yaml.")
]
Snapshot = Annotated[
    bool, flag("--snapshot-mode", help="Keep messages in memory until the service ~/snapshot or the key s writes them.")
]
Repeat = Annotated[
    list[str] | None,
    names(
        "--repeat-transient-local",
        "--repeat-latched",
        metavar="TOPIC[=N]...",
        help="Repeat the last N messages of these transient local topics in each new file and snapshot.",
    ),
]
RepeatAll = Annotated[
    bool,
    flag("--repeat-all-transient-local", help="Repeat those of all transient local topics, as many as their depth."),
]

CompressionMode = Annotated[
    str, choice("--compression-mode", ["none", "chunk", "file", "message"], "Unit of compression")
]
CompressionFormat = Annotated[
    str, choice("--compression-format", ["zstd", "lz4"], "Compression format; chunks by default")
]
PRESETS = ["none", "fastwrite", "resilient", "zstd_fast", "zstd_small"]
Preset = Annotated[str, choice("--storage-preset-profile", PRESETS, "Preset of the MCAP storage")]
StorageConfig = Annotated[
    str,
    file("--storage-config-file", help="YAML file with settings of the MCAP storage, of which compression is used."),
]
QueueSize = Annotated[int, typer.Option("--compression-queue-size", hidden=True)]
Threads = Annotated[int, typer.Option("--compression-threads", hidden=True)]
Priority = Annotated[int, typer.Option("--compression-threads-priority", hidden=True)]
AsJson = Annotated[bool, flag("--json", help="Print a JSON object with the statistics at the end.")]


def record(
    ctx: typer.Context,
    words: Words = None,
    output: Output = "",
    storage: Storage = "mcap",
    topics: Topics = None,
    topic_types: TopicTypes = None,
    services: Services = None,
    actions: Actions = None,
    everything: All = False,
    all_topics: AllTopics = False,
    all_services: AllServices = False,
    all_actions: AllActions = False,
    regex: Regex = "",
    exclude_regex: ExcludeRegex = "",
    exclude_topics: ExcludeTopics = None,
    exclude_topic_types: ExcludeTypes = None,
    exclude_services: ExcludeServices = None,
    exclude_actions: ExcludeActions = None,
    include_unpublished: Unpublished = False,
    include_hidden: Hidden = False,
    static_topics: StaticTopics = "",
    no_discovery: NoDiscovery = False,
    polling_interval: PollingInterval = 100,
    ignore_leaf_topics: IgnoreLeaf = False,
    qos_overrides: shared.Overrides = "",
    serialization_format: Format = "",
    max_bag_size: MaxSize = 0,
    max_bag_duration: MaxDuration = 0.0,
    max_bag_files: MaxFiles = 0,
    max_cache_size: CacheSize = 100 * 1024 * 1024,
    max_cache_duration: CacheDuration = 0.0,
    no_keys: shared.NoKeys = False,
    start_paused: StartPaused = False,
    use_sim_time: SimTime = False,
    node_name: NodeName = "rosbag2_recorder",
    custom_data: CustomData = None,
    snapshot_mode: Snapshot = False,
    repeat: Repeat = None,
    repeat_all_latched: RepeatAll = False,
    log_level: shared.LogLevel = "info",
    enclave: Enclave = "",
    compression_mode: CompressionMode = "none",
    compression_format: CompressionFormat = "",
    preset: Preset = "",
    storage_config: StorageConfig = "",
    as_json: AsJson = False,
    queue_size: QueueSize = 1,
    threads: Threads = 0,
    priority: Priority = 0,
) -> None:
    """Record topics into a bag until Ctrl-C: `bag record -a`, `bag record /scan /odom -o lap`.

    The bag is valid at every moment, even after a crash. Space pauses and resumes, s takes a snapshot.
    """
    from robolink.cli.bag.recorder import Request, run

    settings = _settings(ctx)
    selection = _selection(ctx.params, settings.static_topics)
    if selection.is_empty:
        ctx.fail(
            "record what? name topics, or give -a, --all-topics, --all-services, --all-actions, --services, --actions,"
            " --topic-types, --static-topics-path or --regex"
        )
    path = output or time.strftime("rosbag2_%Y_%m_%d-%H_%M_%S")
    code = run(path, selection, settings, Request(node_name, log_level, not no_keys, as_json, enclave))
    raise typer.Exit(code)


def _selection(params: Mapping[str, Any], static_topics: Iterable[str]) -> Selection:
    from robolink.bag.selection import Selection

    given = {name: params[name] for name in Selection._fields if name in params}
    given |= {name: tuple(params[name] or ()) for name, default in Selection._field_defaults.items() if default == ()}
    for name in ("all_topics", "all_services", "all_actions"):
        given[name] = params["everything"] or params[name]
    given["topics"] = (*(params["words"] or ()), *given["topics"], *static_topics)
    return Selection(**given)


def _settings(ctx: typer.Context) -> RecordSettings:
    """Return the settings of a recording; ends with a usage error for flags that do not go together."""
    from robolink.bag.recording import RecordSettings

    params = ctx.params
    if params["use_sim_time"] and params["no_discovery"]:
        ctx.fail("--use-sim-time and --no-discovery do not go together: /clock has to be discovered")
    if params["max_bag_files"] and not (params["max_bag_size"] or params["max_bag_duration"]):
        ctx.fail("--max-bag-files says something with --max-bag-size or --max-bag-duration only")
    if params["snapshot_mode"] and not (params["max_cache_size"] or params["max_cache_duration"]):
        ctx.fail("--snapshot-mode needs a limit: --max-cache-size or --max-cache-duration")
    given = {name: params[name] for name in RecordSettings._fields if name in params}
    given["compression"], given["compression_mode"] = _compression(ctx)
    given["custom_data"] = dict(each.partition("=")[::2] for each in params["custom_data"] or ())
    given["qos_overrides"] = shared.overrides(params["qos_overrides"])
    given["static_topics"] = _static_topics(params["static_topics"])
    given["repeat_latched"] = dict(_depth(ctx, each) for each in params["repeat"] or ())
    return RecordSettings(**given)


def _static_topics(path: str) -> Mapping[str, type[Any]]:
    if not path:
        return {}
    from robolink.bag.topic import read_static_topics

    return read_static_topics(path)


def _compression(ctx: typer.Context) -> tuple[str, str]:
    """Return the compression and its mode as a bag's writer takes them."""
    from robolink.bag.output_options import chunk_compression

    mode, found = ctx.params["compression_mode"], ctx.params["compression_format"]
    if not found:
        chunks = chunk_compression(ctx.params["preset"], ctx.params["storage_config"])
        found = "zstd" if mode != "none" else chunks if ctx.params["storage"] == "mcap" else ""
    if found and ctx.params["storage"] == "sqlite3" and mode in ("none", "chunk"):
        ctx.fail("sqlite3 has no chunks to compress: give --compression-mode file or message")
    return found, mode if mode in ("file", "message") else ""


def _depth(ctx: typer.Context, text: str) -> tuple[str, int]:
    """Parse TOPIC or TOPIC=N."""
    topic, equals, depth = text.partition("=")
    if not topic or (equals and not (depth.isascii() and depth.isdigit() and int(depth[:9]) > 0)):
        ctx.fail(f"--repeat-transient-local: expected TOPIC or TOPIC=N with N of 1 or more, got '{text[:100]}'")
    return topic, int(depth[:9]) if equals else 1
