"""Options of rosbag2's storages: preset profiles and configuration files, as far as they mean something here."""

from __future__ import annotations

import msgspec

from robolink.bag.topic import BagError
from robolink.documents.foreign import warn_of_unknown_keys
from robolink.documents.yamlfile import read
from robolink.exceptions import nearest
from robolink.system.terminal import shown

PROFILES = {"": "", "none": "", "fastwrite": "", "resilient": "", "zstd_fast": "zstd", "zstd_small": "zstd"}
"""Presets of rosbag2's storages, each with the compression that it means."""


KNOWN = (
    *("noChunkCRC", "noAttachmentCRC", "enableDataCRC", "noChunking", "noMessageIndex", "noSummary", "chunkSize"),
    *("compression", "compressionLevel", "forceCompression", "noRepeatedSchemas", "noRepeatedChannels"),
    *("noAttachmentIndex", "noMetadataIndex", "noChunkIndex", "noStatistics", "noSummaryOffsets"),
)
"""Keys of a configuration of rosbag2's MCAP storage."""


class _Configuration(msgspec.Struct):
    """Keys of a configuration of rosbag2's MCAP storage that have an effect here."""

    compression: str = "none"


def chunk_compression(profile: str | None, config: str | None) -> str:
    """Return the compression of chunks that a preset profile, or a configuration of the MCAP storage, means.

    Args:
        profile: Name of a preset, such as zstd_fast.
        config: Path of a YAML file, which has precedence; '' or None for none.

    Raises:
        BagError: for an unknown preset.
        DocumentError: for a file that is not as it should be.
    """
    name = profile or ""
    if name not in PROFILES:
        known = [each for each in PROFILES if each]
        raise BagError(
            f"no storage_preset_profile named '{shown(name, 60)}'{nearest(name, known)}: there are {', '.join(known)}"
        )
    if not config:
        return PROFILES[name]
    document = read(config, _Configuration)
    warn_of_unknown_keys(document, document.data, KNOWN)
    return compression_word(document.value.compression)


def compression_word(text: str | None) -> str:
    """Return the name of a compression, or of its mode, as a writer takes it: '' for none."""
    word = (text or "").lower()
    return "" if word == "none" else word
