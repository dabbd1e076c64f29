"""robolink bag record: its arguments and their checks."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import typer

from robolink.cli.bag import options as shared
from robolink.cli.bag import record_options as opt
from robolink.cli.shared.options import Enclave

if TYPE_CHECKING:
    from robolink.bag.recording import RecordSettings
    from robolink.bag.selection import Selection


def record(
    ctx: typer.Context,
    words: opt.Words = None,
    output: opt.Output = "",
    storage: opt.Storage = "mcap",
    topics: opt.Topics = None,
    topic_types: opt.TopicTypes = None,
    services: opt.Services = None,
    actions: opt.Actions = None,
    everything: opt.All = False,
    all_topics: opt.AllTopics = False,
    all_services: opt.AllServices = False,
    all_actions: opt.AllActions = False,
    regex: opt.Regex = "",
    exclude_regex: opt.ExcludeRegex = "",
    exclude_topics: opt.ExcludeTopics = None,
    exclude_topic_types: opt.ExcludeTypes = None,
    exclude_services: opt.ExcludeServices = None,
    exclude_actions: opt.ExcludeActions = None,
    include_unpublished: opt.Unpublished = False,
    include_hidden: opt.Hidden = False,
    static_topics: opt.StaticTopics = "",
    no_discovery: opt.NoDiscovery = False,
    polling_interval: opt.PollingInterval = 100,
    ignore_leaf_topics: opt.IgnoreLeaf = False,
    qos_overrides: shared.Overrides = "",
    serialization_format: opt.Format = "",
    max_bag_size: opt.MaxSize = 0,
    max_bag_duration: opt.MaxDuration = 0.0,
    max_bag_files: opt.MaxFiles = 0,
    max_cache_size: opt.CacheSize = 100 * 1024 * 1024,
    max_cache_duration: opt.CacheDuration = 0.0,
    no_keys: shared.NoKeys = False,
    start_paused: opt.StartPaused = False,
    use_sim_time: opt.SimTime = False,
    node_name: opt.NodeName = "rosbag2_recorder",
    custom_data: opt.CustomData = None,
    snapshot_mode: opt.Snapshot = False,
    repeat: opt.Repeat = None,
    repeat_all_latched: opt.RepeatAll = False,
    log_level: shared.LogLevel = "info",
    enclave: Enclave = "",
    compression_mode: opt.CompressionMode = "none",
    compression_format: opt.CompressionFormat = "",
    preset: opt.Preset = "",
    storage_config: opt.StorageConfig = "",
    as_json: opt.AsJson = False,
    queue_size: opt.QueueSize = 1,
    threads: opt.Threads = 0,
    priority: opt.Priority = 0,
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
