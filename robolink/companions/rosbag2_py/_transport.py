"""Recorder and player in a program under the module name that rosbag2 has for them, and the conversion of bags."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path

from robolink.bag.converting import convert
from robolink.bag.output_options import read_outputs
from robolink.bag.reader import open_bag
from robolink.bag.topic import BagError
from robolink.companions.rosbag2_py._player import MessageOrder, Player, PlayOptions, ServiceRequestsSource
from robolink.companions.rosbag2_py._recorder import Recorder, RecordOptions
from robolink.companions.rosbag2_py._storage import StorageOptions
from robolink.exceptions import DocumentError

__all__ = [
    "MessageOrder",
    "PlayOptions",
    "Player",
    "RecordOptions",
    "Recorder",
    "ServiceRequestsSource",
    "bag_rewrite",
]


def bag_rewrite(input_options: Sequence[StorageOptions], output_config_file: str) -> None:
    """Write bags from bags, as `ros2 bag convert` does.

    Args:
        input_options: Bags to read.
        output_config_file: YAML file with `output_bags`.

    Raises:
        BagError: (a RuntimeError) for a bag that cannot be read or made, or a file that is not as it should be.
    """
    with contextlib.ExitStack() as stack:
        try:
            outputs = read_outputs(Path(output_config_file))
        except DocumentError as error:
            raise BagError(str(error)) from None
        convert([stack.enter_context(open_bag(Path(each.uri))) for each in input_options], outputs)
