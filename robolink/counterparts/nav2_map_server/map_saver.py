"""Map saver: a node that saves maps on request, and a command that saves one and ends."""

from __future__ import annotations

import argparse
from typing import Any

import robolink
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.nav2_map_server.map_files import FORMATS, MODES, MapSaveError, Saving, checked, path_of, save
from robolink.counterparts.program import own_words, spin_program
from robolink.interfaces.nav2_msgs.srv import SaveMap
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from robolink.node import Node
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.system import clocks
from robolink.task import Future

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class MapSaver(LifecycleNode):
    """A managed node that saves maps. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("map_saver", **options)
        self.get_logger().info("Creating")
        declare_saving(self)
        self._served: list[Any] = []

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Offer the service."""
        self.get_logger().info("Configuring")
        group = ReentrantCallbackGroup()
        self._served = [self.create_service(SaveMap, "~/save_map", self.on_save_map, callback_group=group)]
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw the service."""
        self.get_logger().info("Cleaning up")
        while self._served:
            self.destroy_service(self._served.pop())
        return TransitionCallbackReturn.SUCCESS

    async def on_save_map(self, request: SaveMap.Request, response: SaveMap.Response) -> SaveMap.Response:
        """Wait for a map and save it."""
        defaults = saving_of(self, "")
        saving = Saving(
            str(path_of(request.map_url)),
            request.image_format,
            request.map_mode or defaults.mode,
            request.occupied_thresh or defaults.occupied,
            request.free_thresh or defaults.free,
        )
        response.result = await save_topic(self, request.map_topic or "map", saving)
        return response


def declare_saving(node: Node) -> None:
    """Declare the parameters of programs that save maps."""
    node.declare_parameter("save_map_timeout", 2.0, described("seconds to wait for a map", 0.0, 1e6))
    node.declare_parameter("free_thresh_default", 0.25, described("occupancy up to which a cell is free", 0.0, 1.0))
    words = "occupancy from which a cell is occupied"
    node.declare_parameter("occupied_thresh_default", 0.65, described(words, 0.0, 1.0))
    words = "take a map that was published before, too"
    node.declare_parameter("map_subscribe_transient_local", True, described(words))


def saving_of(node: Node, path: str) -> Saving:
    """Return how a node saves a map in a file, by its parameters."""
    free, occupied = (node.get_parameter(f"{each}_thresh_default").value for each in ("free", "occupied"))
    return Saving(path, occupied=occupied, free=free)


async def save_topic(node: Node, topic: str, saving: Saving) -> bool:
    """Wait for the map of a topic and save it; return True if that went well, and log what went wrong.

    Args:
        node: Node that subscribes and has the parameters of `declare_saving`.
        topic: Topic of the map.
        saving: Files and format of the map.
    """
    logger = node.get_logger()
    logger.info(f"Saving map from '{topic}' topic to '{saving.path}' file")
    try:
        how = checked(saving)
        grid = await _next_map(node, topic)
        if grid is None:
            logger.error(f"Failed to spin map subscription: nothing came on '{topic}' in time")
            return False
        size = f"{grid.info.width} X {grid.info.height} map @ {grid.info.resolution:g} m/pix"
        logger.info(f"Received a {size}")
        logger.info(f"Writing map occupancy data to {how.path}.{how.form}")
        logger.info(f"Writing map metadata to {how.path}.yaml")
        save(grid, how)
    except MapSaveError as error:
        logger.error(f"Failed to save the map: {error}")
        return False
    except OSError as error:
        logger.error(f"Failed to save the map: {error.filename}: {error.strerror}")
        return False
    logger.info("Map saved successfully")
    return True


async def _next_map(node: Node, topic: str) -> OccupancyGrid | None:
    """Return the next map of a topic, None if none comes in time."""
    came: Future[OccupancyGrid] = Future()
    group = ReentrantCallbackGroup()

    def take(grid: OccupancyGrid | None) -> None:
        if not came.done():
            came.set_result(grid)  # type: ignore[arg-type]

    qos = LATCHED if node.get_parameter("map_subscribe_transient_local").value else QoSProfile(depth=1)
    subscription = node.create_subscription(OccupancyGrid, topic, take, qos, callback_group=group)
    wait = max(node.get_parameter("save_map_timeout").value, 0.001)
    timer = node.create_timer(wait, lambda: take(None), callback_group=group)
    try:
        return await came
    finally:
        node.destroy_timer(timer)
        node.destroy_subscription(subscription)


def run_server(args: list[str] | None = None) -> None:
    """Save maps on request until Ctrl-C."""
    spin_program(lambda words: MapSaver(), args)


def run_command(args: list[str] | None = None) -> int:
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
