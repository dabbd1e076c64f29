"""The services of nav2_msgs: costmaps, maps, lifecycles, docks and routes."""

from typing import ClassVar

from robolink.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from robolink.interfaces.nav2_msgs.msg import Costmap, CostmapMetaData, EdgeCost
from robolink.interfaces.nav_msgs.msg import OccupancyGrid, Path
from robolink.interfaces.std_msgs.msg import Empty
from robolink.message import Message, Sequence, Service, float32, float64, int32, string, uint8, uint16


class ClearEntireCostmap(Service):
    """Clear a costmap."""

    class Request(Message):
        """Nothing of meaning."""

        request: Empty

    class Response(Message):
        """Nothing of meaning."""

        response: Empty


class ClearCostmapAroundRobot(Service):
    """Clear a square of a costmap around the robot."""

    class Request(Message):
        """Half a side of the square, in metres."""

        reset_distance: float32

    class Response(Message):
        """Nothing of meaning."""

        response: Empty


class ClearCostmapExceptRegion(Service):
    """Clear a costmap but for a square around the robot."""

    class Request(Message):
        """Half a side of the square, in metres."""

        reset_distance: float32

    class Response(Message):
        """Nothing of meaning."""

        response: Empty


class ClearCostmapAroundPose(Service):
    """Clear a square of a costmap around a pose."""

    class Request(Message):
        """The pose, and half a side of the square, in metres."""

        pose: PoseStamped
        reset_distance: float64

    class Response(Message):
        """Nothing of meaning."""

        response: Empty


class GetCostmap(Service):
    """Return a costmap."""

    class Request(Message):
        """Ignored by Nav2's servers."""

        specs: CostmapMetaData

    class Response(Message):
        """The costmap."""

        map: Costmap


class GetCost(Service):
    """Return the cost at a point. Jazzy's; Kilted has GetCosts."""

    class Request(Message):
        """The point in metres; with `use_footprint` the greatest cost under the robot, turned by `theta` radians."""

        use_footprint: bool
        x: float32
        y: float32
        theta: float32

    class Response(Message):
        """The cost, -1 off the map."""

        cost: float32


class GetCosts(Service):
    """Return the costs at poses. Kilted's; Jazzy has GetCost."""

    class Request(Message):
        """The poses; with `use_footprint` the greatest cost under the robot there."""

        use_footprint: bool
        poses: Sequence[PoseStamped]

    class Response(Message):
        """The costs in the order of the poses, and success."""

        costs: Sequence[float32]
        success: bool


class IsPathValid(Service):
    """Return whether a path is free."""

    class Request(Message):
        """The path."""

        path: Path

    class Response(Message):
        """Outcome: `is_valid` if it is free, and the places in the list of the poses that are not."""

        is_valid: bool
        invalid_pose_indices: Sequence[int32]


class LoadMap(Service):
    """Load a map into the map server."""

    class Request(Message):
        """The map's YAML file, as a path or a URL."""

        map_url: string

    class Response(Message):
        """The map, or why there is none."""

        RESULT_SUCCESS: ClassVar[uint8] = 0
        RESULT_MAP_DOES_NOT_EXIST: ClassVar[uint8] = 1
        RESULT_INVALID_MAP_DATA: ClassVar[uint8] = 2
        RESULT_INVALID_MAP_METADATA: ClassVar[uint8] = 3
        RESULT_UNDEFINED_FAILURE: ClassVar[uint8] = 255

        map: OccupancyGrid
        result: uint8


class SaveMap(Service):
    """Save a map in files."""

    class Request(Message):
        """Topic of the map, files without their ending, format of the picture, and what cells mean.

        The mode is trinary, scale or raw; thresholds go from 0 to 1, and 0 takes the default.
        """

        map_topic: string
        map_url: string
        image_format: string
        map_mode: string
        free_thresh: float32
        occupied_thresh: float32

    class Response(Message):
        """Success."""

        result: bool


class ManageLifecycleNodes(Service):
    """Change the state of all nodes of a lifecycle manager."""

    class Request(Message):
        """The command."""

        STARTUP: ClassVar[uint8] = 0
        PAUSE: ClassVar[uint8] = 1
        RESUME: ClassVar[uint8] = 2
        RESET: ClassVar[uint8] = 3
        SHUTDOWN: ClassVar[uint8] = 4
        CONFIGURE: ClassVar[uint8] = 5
        CLEANUP: ClassVar[uint8] = 6

        command: uint8

    class Response(Message):
        """Success."""

        success: bool


class ReloadDockDatabase(Service):
    """Load the database of docks."""

    class Request(Message):
        """The YAML file."""

        filepath: string

    class Response(Message):
        """Success."""

        success: bool


class SetInitialPose(Service):
    """Set the pose from which localization begins."""

    class Request(Message):
        """The pose and its uncertainty."""

        pose: PoseWithCovarianceStamped

    class Response(Message):
        """Nothing."""


class SetRouteGraph(Service):
    """Load the graph of routes."""

    class Request(Message):
        """The graph's file."""

        graph_filepath: string

    class Response(Message):
        """Success."""

        success: bool


class DynamicEdges(Service):
    """Change edges of the route graph."""

    class Request(Message):
        """Edges to close, edges to open again, and edges with another cost."""

        closed_edges: Sequence[uint16]
        opened_edges: Sequence[uint16]
        adjust_edges: Sequence[EdgeCost]

    class Response(Message):
        """Success."""

        success: bool


class Toggle(Service):
    """Switch a server on or off."""

    class Request(Message):
        """True is on."""

        enable: bool

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        message: string
