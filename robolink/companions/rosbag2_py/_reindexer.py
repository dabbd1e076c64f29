"""Reindexer: metadata.yaml made anew from the files of a bag."""

from __future__ import annotations

from pathlib import Path

from robolink.bag.reindexing import reindex
from robolink.companions.rosbag2_py._storage import StorageOptions


class Reindexer:
    """Maker of metadata.yaml from the files of a bag; files of killed recorders are made whole."""

    def reindex(self, storage_options: StorageOptions) -> None:
        """Reindex the bag of these options. Raises BagError (a RuntimeError) if there is none."""
        reindex(Path(storage_options.uri))
