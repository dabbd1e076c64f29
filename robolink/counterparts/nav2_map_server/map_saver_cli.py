"""Save the map of a topic in files, and end.

robolink run nav2_map_server map_saver_cli -f my_map
"""

from __future__ import annotations

import argparse
import sys

import robolink
from robolink.counterparts.nav2_map_server.map_files import FORMATS, MODES, Saving
from robolink.counterparts.nav2_map_server.map_saver_server import declare_saving, save_topic, saving_of
from robolink.counterparts.program import own_words
from robolink.node import Node
from robolink.system import clocks


def main(args: list[str] | None = None) -> int:
    """Save a map; return the exit code, 1 if there was none to save."""
    words = _parser().parse_args(own_words(args))
    with robolink.init(args=args):
        node = Node("map_saver")
        declare_saving(node)
        defaults = saving_of(node, words.f or f"map_{int(clocks.time_of_day())}")
        saving = Saving(
            defaults.path,
            words.fmt,
            words.mode,
            defaults.occupied if words.occ is None else words.occ,
            defaults.free if words.free is None else words.free,
        )
        executor = robolink.get_global_executor()
        executor.add_node(node)
        task = executor.create_task(save_topic(node, words.t, saving))
        executor.spin_until_future_complete(task)
        return 0 if task.done() and task.result() else 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("map_saver_cli")
    parser.add_argument("-f", metavar="MAP", default="", help="files, without their ending")
    parser.add_argument("-t", metavar="TOPIC", default="map", help="topic of the map")
    parser.add_argument("--occ", type=float, help="occupancy from which a cell is occupied, from 0 to 1")
    parser.add_argument("--free", type=float, help="occupancy up to which a cell is free, from 0 to 1")
    parser.add_argument("--fmt", choices=FORMATS, default="", help="format of the image")
    parser.add_argument("--mode", choices=MODES, default="trinary", help="what cells mean in the image")
    return parser


if __name__ == "__main__":
    sys.exit(main())
