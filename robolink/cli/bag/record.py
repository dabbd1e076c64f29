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

    The bag is valid at every moment, whatever ends the recording. Space pauses it, s writes a snapshot.
    """
    from robolink.cli.bag.recorder import Wish, run

    settings = _settings(ctx)
    selection = _selection(ctx.params, settings.static_topics)
    if selection.is_empty:
        ctx.fail(
            "record what? name topics, or give -a, --all-topics, --all-services, --all-actions, --services, --actions,"
            " --topic-types, --static-topics-path or --regex"
        )
    path = output or time.strftime("rosbag2_%Y_%m_%d-%H_%M_%S")
    code = run(path, selection, settings, Wish(node_name, log_level, not no_keys, as_json, enclave))
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
    from robolink.bag.static_topics import read_static_topics

    return read_static_topics(path)


def _compression(ctx: typer.Context) -> tuple[str, str]:
    """Return the compression and its mode as a bag's writer takes them."""
    from robolink.bag.storage_options import chunk_compression

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
