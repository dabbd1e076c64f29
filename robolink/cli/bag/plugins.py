"""Storages, compressions and formats of bags, as `ros2 bag list` lists plugins."""

from __future__ import annotations

from robolink.bag.topic import BagError
from robolink.exceptions import nearest

_ZSTD = "Zstandard, of whole files or of each message (before Python 3.14: pip install backports.zstd)"
_PLUGINS = {
    "storage": [
        ("mcap", "MCAP files, valid at every moment, with chunks that may be compressed by zstd or lz4"),
        ("sqlite3", "sqlite3 databases (.db3), the default of ROS 2 until Humble"),
    ],
    "converter": [("cdr", "CDR, the serialization of every ROS 2 distribution")],
    "compressor": [("zstd", _ZSTD)],
    "decompressor": [("zstd", _ZSTD)],
}


def plugins(kind: str) -> list[tuple[str, str]]:
    """Return names and descriptions of what there is of a kind. Raises BagError for an unknown kind."""
    if kind not in _PLUGINS:
        raise BagError(f"no plugins of the type '{kind}'{nearest(kind, _PLUGINS)}: there are {', '.join(_PLUGINS)}")
    return _PLUGINS[kind]
