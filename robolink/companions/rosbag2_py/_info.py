"""Info: metadata of a bag, and the text of `ros2 bag info`."""

from __future__ import annotations

import sys
from pathlib import Path

from robolink.bag.information import SORTS, details_of, info_text, topic_names
from robolink.bag.reader import open_bag
from robolink.companions.rosbag2_py._storage import BagMetadata, metadata_from, metadata_to


class Info:
    """Reader and printer of a bag's metadata."""

    def read_metadata(self, uri: str, storage_id: str = "") -> BagMetadata:
        """Return the metadata of a bag; its files tell the storage. Raises BagError (a RuntimeError)."""
        with open_bag(Path(uri)) as bag:
            return metadata_to(bag.metadata)

    def print_output(self, metadata_info: BagMetadata, sorting_method: str = "name") -> None:
        """Print what `ros2 bag info` prints."""
        _print(info_text(metadata_from(metadata_info), sorting_method))

    def print_output_topic_name_only(self, metadata_info: BagMetadata, sorting_method: str = "name") -> None:
        """Print the names of the topics, a line each."""
        for name in topic_names(metadata_from(metadata_info), sorting_method):
            _print(name)

    def print_output_verbose(self, uri: str, metadata_info: BagMetadata, sorting_method: str = "name") -> None:
        """Print what `ros2 bag info -v` prints, which reads the whole bag."""
        with open_bag(Path(uri)) as bag:
            details = details_of(bag)
        _print(info_text(metadata_from(metadata_info), sorting_method, details))

    def get_sorting_methods(self) -> set[str]:
        """Return the names of the orders."""
        return set(SORTS)


def _print(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
