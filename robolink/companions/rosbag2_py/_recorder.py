"""Recorder of topics in a program, with its options, and the session that recorder and player have."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from robolink.bag.background_spin import BackgroundSpin
from robolink.bag.output_options import chunk_compression
from robolink.bag.recording import RecordSettings
from robolink.bag.recording.services import ServedRecording
from robolink.bag.selection import SERVICE_EVENT, Selection
from robolink.bag.topic import BagError, read_static_topics
from robolink.companions.rosbag2_py._storage import StorageOptions, get_default_storage_id
from robolink.context import Context
from robolink.exceptions import DocumentError, nearest
from robolink.logging import LoggingSeverity
from robolink.node import Node
from robolink.qos import QoSProfile

LOOK = 0.1
"""Seconds between two looks at what may have ended a recording or a playback."""


class Session:
    """Session with one node.

    Args:
        name: Name of the node.
        level: Level from which it logs.
        arguments: Arguments of ROS for the node, such as remappings.
    """

    def __init__(self, name: str, level: LoggingSeverity, arguments: Sequence[str] = ()) -> None:
        self._context = Context()
        self._context.init()
        self._spin: BackgroundSpin | None = None
        self.node = Node(name, context=self._context, cli_args=list(arguments) or None, start_parameter_services=False)
        self.node.get_logger().set_level(level)

    @property
    def is_over(self) -> bool:
        """True once the network has ended."""
        return not self._context.ok()

    def start_spin(self) -> None:
        """Spin the node on a thread, which answers its services; nothing if one does already."""
        if self._spin is None:
            self._spin = BackgroundSpin(self.node)

    def stop_spin(self) -> None:
        """End that thread, if there is one."""
        spin, self._spin = self._spin, None
        if spin is not None:
            spin.close()

    def close(self) -> None:
        """End the session. Safe to call twice."""
        self.stop_spin()
        self._context.try_shutdown()


def level_of(name: str) -> LoggingSeverity:
    """Return the level of a name. Raises BagError (a RuntimeError) for an unknown one."""
    levels = LoggingSeverity.__members__
    if name.upper() not in levels:
        raise BagError(f"no log level named '{name[:50]}'{nearest(name.upper(), levels)}")
    return levels[name.upper()]


@dataclass
class RecordOptions:
    """Options of a recorder, under rosbag2's names; services are named by the topics of their events.

    What compresses in the background, polls and reads keys in rosbag2 is accepted and has no effect.
    """

    all_topics: bool = False
    all: bool = False
    all_services: bool = False
    all_actions: bool = False
    is_discovery_disabled: bool = False
    topics: list[str] = field(default_factory=list)
    static_topics_uri: str = ""
    topic_types: list[str] = field(default_factory=list)
    services: list[str] = field(default_factory=list)
    actions: list[str] = field(default_factory=list)
    rmw_serialization_format: str = ""
    input_serialization_format: str = ""
    output_serialization_format: str = ""
    topic_polling_interval: object = None
    regex: str = ""
    exclude: str = ""
    exclude_regex: str = ""
    exclude_topics: list[str] = field(default_factory=list)
    exclude_topic_types: list[str] = field(default_factory=list)
    exclude_service_events: list[str] = field(default_factory=list)
    exclude_actions: list[str] = field(default_factory=list)
    node_prefix: str = ""
    compression_mode: str = ""
    compression_format: str = ""
    compression_queue_size: int = 1
    compression_threads: int = 0
    compression_threads_priority: int = 0
    topic_qos_profile_overrides: dict[str, QoSProfile] = field(default_factory=dict)
    include_hidden_topics: bool = False
    include_unpublished_topics: bool = False
    ignore_leaf_topics: bool = False
    start_paused: bool = False
    use_sim_time: bool = False
    disable_keyboard_controls: bool = False


class Recorder:
    """Recorder of topics into a bag.

        recorder = Recorder(StorageOptions("walk"), options)
        recorder.start_spin()
        recorder.record()
        ...
        recorder.stop()

    Older programs make it without options, and `record` then takes them and blocks.

    Args:
        storage_options: The bag to write; in older programs the log level stands here.
        record_options: Topics to record, and how.
        log_level: Level from which its node logs: debug, info, warn, error or fatal.
        node_name: Name of its node.

    Raises:
        RuntimeError: for an unknown level, or if nothing is selected.
    """

    _cancelled = threading.Event()

    def __init__(
        self,
        storage_options: StorageOptions | str | None = None,
        record_options: RecordOptions | None = None,
        log_level: str = "info",
        node_name: str = "rosbag2_recorder",
    ) -> None:
        if isinstance(storage_options, str):
            log_level, storage_options = storage_options, None
        self._level = level_of(log_level)
        self._made: _Recording | None = None
        Recorder._cancelled.clear()
        if storage_options is not None:
            self._made = _Recording(storage_options, record_options or RecordOptions(), self._level, node_name)
            weakref.finalize(self, self._made.close)

    def start_spin(self) -> None:
        """Answer the services of its node from now on, on a thread."""
        self._recording.session.start_spin()

    def stop_spin(self) -> None:
        """Answer them no longer."""
        self._recording.session.stop_spin()

    def record(
        self,
        storage_options: StorageOptions | None = None,
        record_options: RecordOptions | None = None,
        node_name: str = "rosbag2_recorder",
    ) -> None:
        """Start to record; with options here, record until `cancel`, Ctrl-C or a full disk.

        Args:
            storage_options: The bag to write, for a recorder that was made without it.
            record_options: Topics to record, and how.
            node_name: Name of its node.

        Raises:
            RuntimeError: if the bag cannot be made, or nothing is selected.
        """
        if storage_options is None:
            self._recording.start()
            return
        made = _Recording(storage_options, record_options or RecordOptions(), self._level, node_name)
        try:
            made.session.start_spin()
            made.served.start()
            while not (self._cancelled.wait(LOOK) or made.is_over):
                pass
        finally:
            Recorder._cancelled.clear()
            made.close()

    def stop(self) -> None:
        """End the recording, and close the bag."""
        self._recording.stop()

    def pause(self) -> None:
        """Let messages pass from now on."""
        self._recording.served.pause()

    def resume(self) -> None:
        """Record again."""
        self._recording.served.resume()

    def is_paused(self) -> bool:
        """Return whether messages are let pass."""
        return self._recording.served.is_paused

    @staticmethod
    def cancel() -> None:
        """End each `record` of this process that blocks."""
        Recorder._cancelled.set()

    @property
    def _recording(self) -> _Recording:
        if self._made is None:
            raise BagError("Recorder is not initialized. Please use constructor with storage and record options.")
        return self._made


class _Recording:
    """Recording with the session that it is made in."""

    def __init__(self, storage: StorageOptions, options: RecordOptions, level: LoggingSeverity, name: str) -> None:
        selection, settings = selection_of(options).checked(), settings_of(storage, options)
        self.session = Session(name, level)
        try:
            self.served = ServedRecording(self.session.node, Path(storage.uri), selection, settings)
        except BaseException:
            self.session.close()
            raise

    @property
    def is_over(self) -> bool:
        """True once it has ended by itself."""
        return self.served.is_over or self.session.is_over

    def start(self) -> None:
        """Record, also again after `stop`."""
        if self.served.recording.has_started:
            self.served.record()
        else:
            self.served.start()

    def stop(self) -> None:
        """Close the bag, if there is one."""
        if self.served.recording.is_running:
            self.served.stop()
        self.served.recording.stop()  # of one whose disk is full, the end

    def close(self) -> None:
        """End everything. Safe to call twice."""
        self.stop()
        self.session.close()


def selection_of(options: RecordOptions) -> Selection:
    """Return the selection of topics that options mean."""
    return Selection(
        all_topics=options.all_topics or options.all,
        all_services=options.all_services or options.all,
        all_actions=options.all_actions or options.all,
        topics=(*options.topics, *static_topics_of(options)),
        topic_types=tuple(options.topic_types),
        services=services_of(options.services),
        actions=tuple(options.actions),
        regex=options.regex,
        exclude_regex=options.exclude_regex or options.exclude,
        exclude_topics=tuple(options.exclude_topics),
        exclude_topic_types=tuple(options.exclude_topic_types),
        exclude_services=services_of(options.exclude_service_events),
        exclude_actions=tuple(options.exclude_actions),
        include_hidden=options.include_hidden_topics,
    )


def static_topics_of(options: RecordOptions) -> dict[str, type[Any]]:
    """Return the topics of the file `static_topics_uri`, with their types. Raises BagError (a RuntimeError)."""
    try:
        return read_static_topics(options.static_topics_uri) if options.static_topics_uri else {}
    except DocumentError as error:
        raise BagError(str(error)) from None


def services_of(topics: list[str]) -> tuple[str, ...]:
    """Return the services that are named by the topics of their events."""
    return tuple(each.removesuffix(SERVICE_EVENT) for each in topics)


def settings_of(storage: StorageOptions, options: RecordOptions) -> RecordSettings:
    """Return the settings of a recording that options mean."""
    mode = options.compression_mode.lower().replace("none", "")
    chunks = chunk_compression(storage.storage_preset_profile, storage.storage_config_uri)
    return RecordSettings(
        storage=storage.storage_id or get_default_storage_id(),
        compression=options.compression_format if mode else chunks,
        compression_mode=mode,
        max_bag_size=storage.max_bagfile_size,
        max_bag_duration=storage.max_bagfile_duration,
        max_cache_size=storage.max_cache_size or RecordSettings().max_cache_size,
        snapshot_mode=storage.snapshot_mode,
        start_paused=options.start_paused,
        use_sim_time=options.use_sim_time,
        custom_data=storage.custom_data,
        qos_overrides=options.topic_qos_profile_overrides,
        static_topics=static_topics_of(options),
        no_discovery=options.is_discovery_disabled,
        include_unpublished=options.include_unpublished_topics,
        ignore_leaf_topics=options.ignore_leaf_topics,
    )
