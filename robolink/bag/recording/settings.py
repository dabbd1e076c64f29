"""Settings of a recording: what the flags of `ros2 bag record` say, but for the choice of topics."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from robolink.qos import QoSProfile

CACHE_SIZE = 100 * 1024 * 1024
"""Default limit of the messages that wait to be written, in bytes: rosbag2's."""


class RecordSettings(NamedTuple):
    """Settings of one recording."""

    storage: str = "mcap"
    compression: str = ""
    """Compression: "", "zstd" or "lz4"."""
    compression_mode: str = ""
    """Unit of compression: "" the chunks of a file, as it is written; or "file" or "message", as in rosbag2."""
    max_bag_size: int = 0
    """Size in bytes from which a file is closed and the next one begun; 0 is never."""
    max_bag_duration: float = 0.0
    """Age in seconds at which a file is closed and the next one begun; 0 is never."""
    max_bag_files: int = 0
    """Number of files that are kept, the newest ones; 0 keeps all."""
    max_cache_size: int = CACHE_SIZE
    """Limit of the messages that wait to be written, or of a snapshot, in bytes; 0 is no limit."""
    max_cache_duration: float = 0.0
    """Limit of the time between the first and the last of them, in seconds; 0 is no limit."""
    snapshot_mode: bool = False
    """True to keep messages in memory, and to write them when a snapshot is asked for."""
    start_paused: bool = False
    use_sim_time: bool = False
    """True to note messages with the time of /clock, and to begin with its first message."""
    custom_data: Mapping[str, str] = {}
    qos_overrides: Mapping[str, QoSProfile] = {}
    """Profiles of subscriptions by topic; else what the publishers offer decides."""
    static_topics: Mapping[str, type[Any]] = {}
    """Message classes of topics that are listened to from the start, whoever will publish them."""
    repeat_latched: Mapping[str, int] = {}
    """Number of last messages, by latched topic, that each further file and each snapshot begins with."""
    repeat_all_latched: bool = False
    """True to repeat all that is latched, as many messages of a topic as its publishers keep."""
    no_discovery: bool = False
    """True to record only topics that are there at the start."""
    include_unpublished: bool = False
    """True to subscribe to topics that have only subscriptions so far."""
    ignore_leaf_topics: bool = False
    """True to record only topics to which another node subscribes."""
