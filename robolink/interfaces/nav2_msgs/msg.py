"""The messages of nav2_msgs: costmaps, particles, routes and trajectories, and what Nav2's servers report."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration, Time
from robolink.interfaces.geometry_msgs.msg import Accel, Point, Point32, Pose, PoseStamped, Twist, Vector3, Wrench
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, boolean, float32, float64, string, uint8, uint16, uint32


class BehaviorTreeStatusChange(Message):
    """A node of a behaviour tree that changed its state, from IDLE, RUNNING, SUCCESS or FAILURE to another.

    The time is that of the machine's clock; `uid` numbers the node within its tree.
    """

    timestamp: Time
    node_name: string
    uid: uint16
    previous_status: string
    current_status: string


class BehaviorTreeLog(Message):
    """The states that changed in a tick of a behaviour tree."""

    timestamp: Time
    event_log: Sequence[BehaviorTreeStatusChange]


class CollisionDetectorState(Message):
    """Names of zones, and whether there is something in each."""

    polygons: Sequence[string]
    detections: Sequence[boolean]


class CollisionMonitorState(Message):
    """Action of the collision monitor on the robot's velocity, and the zone that is the reason."""

    DO_NOTHING: ClassVar[uint8] = 0
    STOP: ClassVar[uint8] = 1
    SLOWDOWN: ClassVar[uint8] = 2
    APPROACH: ClassVar[uint8] = 3
    LIMIT: ClassVar[uint8] = 4

    action_type: uint8
    polygon_name: string


class CostmapMetaData(Message):
    """Size and place of a costmap: cells of `resolution` metres, and the pose of its first cell's corner.

    `layer` is the name of the layer that it shows.
    """

    map_load_time: Time
    update_time: Time
    layer: string
    resolution: float32
    size_x: uint32
    size_y: uint32
    origin: Pose


class Costmap(Message):
    """Costs of cells from 0 to 252, row by row; 253 is too near to an obstacle, 254 an obstacle, 255 unknown."""

    header: Header
    metadata: CostmapMetaData
    data: Sequence[uint8]


class CostmapUpdate(Message):
    """A changed rectangle of a costmap; `x` and `y` are the cell of its first corner."""

    header: Header
    x: uint32
    y: uint32
    size_x: uint32
    size_y: uint32
    data: Sequence[uint8]


class CostmapFilterInfo(Message):
    """Meaning of a filter's mask: of what kind it is, its topic, and value = base + multiplier * cell."""

    header: Header
    type: uint8
    filter_mask_topic: string
    base: float32
    multiplier: float32


class EdgeCost(Message):
    """New cost of an edge of the route graph."""

    edgeid: uint16
    cost: float32


class MissedWaypoint(Message):
    """A waypoint that was not reached: its place in the list, its pose, and the code that says why."""

    index: uint32
    goal: PoseStamped
    error_code: uint16


class WaypointStatus(Message):
    """State of a waypoint: its place in the list, its pose and, after a failure, code and words.

    Kilted's; Jazzy has MissedWaypoint.
    """

    PENDING: ClassVar[uint8] = 0
    COMPLETED: ClassVar[uint8] = 1
    SKIPPED: ClassVar[uint8] = 2
    FAILED: ClassVar[uint8] = 3

    waypoint_status: uint8
    waypoint_index: uint32
    waypoint_pose: PoseStamped
    error_code: uint16
    error_msg: string


class Particle(Message):
    """A pose that the robot may have, and its weight."""

    pose: Pose
    weight: float64


class ParticleCloud(Message):
    """The particles of a localization filter."""

    header: Header
    particles: Sequence[Particle]


class RouteNode(Message):
    """A node of a route, with its number in the graph."""

    nodeid: uint16
    position: Point


class RouteEdge(Message):
    """An edge of a route, with its number in the graph and its ends."""

    edgeid: uint16
    start: Point
    end: Point


class Route(Message):
    """A route through the graph: its cost, its nodes and the edges between them, in their order."""

    header: Header
    route_cost: float32
    nodes: Sequence[RouteNode]
    edges: Sequence[RouteEdge]


class SpeedLimit(Message):
    """Speed limit in m/s, or in percent of the greatest speed; 0 is none."""

    header: Header
    percentage: bool
    speed_limit: float64


class TrajectoryPoint(Message):
    """A point of a trajectory: the time from its start, pose, velocity, acceleration and forces.

    Kilted's.
    """

    time_from_start: Duration
    pose: Pose
    velocity: Twist
    acceleration: Accel
    effort: Wrench


class Trajectory(Message):
    """A trajectory to drive.

    Kilted's.
    """

    header: Header
    points: Sequence[TrajectoryPoint]


class CriticsStats(Message):
    """Costs that the critics of the MPPI controller added up, and which of them changed any.

    Kilted's.
    """

    stamp: Time
    critics: Sequence[string]
    changed: Sequence[boolean]
    costs_sum: Sequence[float32]


class VoxelGrid(Message):
    """Cells of a costmap in three dimensions.

    Each number has two bits for each of the 16 cells of a column: 00 free, 01 unknown, 11 occupied.
    """

    header: Header
    data: Sequence[uint32]
    origin: Point32
    resolutions: Vector3
    size_x: uint32
    size_y: uint32
    size_z: uint32
