"""The services of nav_msgs: maps and plans."""

from typing import ClassVar

from robolink.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from robolink.interfaces.nav_msgs.msg import OccupancyGrid, Path
from robolink.message import Message, Service, float32, string, uint8


class GetMap(Service):
    """Ask a map server for its map."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """The map as it is now."""

        map: OccupancyGrid


class LoadMap(Service):
    """Load a map from a file into a map server, which serves it."""

    class Request(Message):
        """Place of the map's YAML file: ``file:///...``, or ``package://name/...`` in a package."""

        map_url: string

    class Response(Message):
        """The map, which only counts when `result` is RESULT_SUCCESS."""

        RESULT_SUCCESS: ClassVar[uint8] = 0
        RESULT_MAP_DOES_NOT_EXIST: ClassVar[uint8] = 1
        RESULT_INVALID_MAP_DATA: ClassVar[uint8] = 2
        RESULT_INVALID_MAP_METADATA: ClassVar[uint8] = 3
        RESULT_UNDEFINED_FAILURE: ClassVar[uint8] = 255

        map: OccupancyGrid
        result: uint8


class SetMap(Service):
    """Hand over a map, and where the robot is in it."""

    class Request(Message):
        """The map, and the pose from which localisation shall start."""

        map: OccupancyGrid
        initial_pose: PoseWithCovarianceStamped

    class Response(Message):
        """True if the map was taken."""

        success: bool


class GetPlan(Service):
    """Ask for a way from one pose to another."""

    class Request(Message):
        """Start and goal; when the goal is blocked the plan may end up to `tolerance` metres beside it."""

        start: PoseStamped
        goal: PoseStamped
        tolerance: float32

    class Response(Message):
        """The way, from start to goal; empty when there is none."""

        plan: Path
