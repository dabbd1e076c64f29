# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.nav2_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["BehaviorTreeLog", "BehaviorTreeStatusChange", "CollisionDetectorState", "CollisionMonitorState", "Costmap", "CostmapFilterInfo", "CostmapMetaData", "CostmapUpdate", "CriticsStats", "EdgeCost", "MissedWaypoint", "Particle", "ParticleCloud", "Route", "RouteEdge", "RouteNode", "SpeedLimit", "Trajectory", "TrajectoryPoint", "VoxelGrid", "WaypointStatus"]

class BehaviorTreeLog(robolink.message.Message):
    """The states that changed in a tick of a behaviour tree."""
    timestamp: robolink.interfaces.builtin_interfaces.msg.Time
    event_log: collections.abc.MutableSequence[robolink.interfaces.nav2_msgs.msg.BehaviorTreeStatusChange]
    def __init__(self, *, timestamp: robolink.interfaces.builtin_interfaces.msg.Time = ..., event_log: collections.abc.Iterable[robolink.interfaces.nav2_msgs.msg.BehaviorTreeStatusChange] = ...) -> None: ...
class BehaviorTreeStatusChange(robolink.message.Message):
    """A node of a behaviour tree that changed its state, from IDLE, RUNNING, SUCCESS or FAILURE to another.

    The time is that of the machine's clock; `uid` numbers the node within its tree.
    """
    timestamp: robolink.interfaces.builtin_interfaces.msg.Time
    node_name: builtins.str
    uid: builtins.int
    previous_status: builtins.str
    current_status: builtins.str
    def __init__(self, *, timestamp: robolink.interfaces.builtin_interfaces.msg.Time = ..., node_name: builtins.str = ..., uid: builtins.int = ..., previous_status: builtins.str = ..., current_status: builtins.str = ...) -> None: ...
class CollisionDetectorState(robolink.message.Message):
    """Names of zones, and whether there is something in each."""
    polygons: collections.abc.MutableSequence[builtins.str]
    detections: collections.abc.MutableSequence[builtins.bool]
    def __init__(self, *, polygons: collections.abc.Iterable[builtins.str] = ..., detections: collections.abc.Iterable[builtins.bool] = ...) -> None: ...
class CollisionMonitorState(robolink.message.Message):
    """Action of the collision monitor on the robot's velocity, and the zone that is the reason."""
    DO_NOTHING: typing.ClassVar[builtins.int]
    STOP: typing.ClassVar[builtins.int]
    SLOWDOWN: typing.ClassVar[builtins.int]
    APPROACH: typing.ClassVar[builtins.int]
    LIMIT: typing.ClassVar[builtins.int]
    action_type: builtins.int
    polygon_name: builtins.str
    def __init__(self, *, action_type: builtins.int = ..., polygon_name: builtins.str = ...) -> None: ...
class Costmap(robolink.message.Message):
    """Costs of cells from 0 to 252, row by row; 253 is too near to an obstacle, 254 an obstacle, 255 unknown."""
    header: robolink.interfaces.std_msgs.msg.Header
    metadata: robolink.interfaces.nav2_msgs.msg.CostmapMetaData
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., metadata: robolink.interfaces.nav2_msgs.msg.CostmapMetaData = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class CostmapFilterInfo(robolink.message.Message):
    """Meaning of a filter's mask: of what kind it is, its topic, and value = base + multiplier * cell."""
    header: robolink.interfaces.std_msgs.msg.Header
    type: builtins.int
    filter_mask_topic: builtins.str
    base: builtins.float
    multiplier: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., type: builtins.int = ..., filter_mask_topic: builtins.str = ..., base: builtins.float = ..., multiplier: builtins.float = ...) -> None: ...
class CostmapMetaData(robolink.message.Message):
    """Size and place of a costmap: cells of `resolution` metres, and the pose of its first cell's corner.

    `layer` is the name of the layer that it shows.
    """
    map_load_time: robolink.interfaces.builtin_interfaces.msg.Time
    update_time: robolink.interfaces.builtin_interfaces.msg.Time
    layer: builtins.str
    resolution: builtins.float
    size_x: builtins.int
    size_y: builtins.int
    origin: robolink.interfaces.geometry_msgs.msg.Pose
    def __init__(self, *, map_load_time: robolink.interfaces.builtin_interfaces.msg.Time = ..., update_time: robolink.interfaces.builtin_interfaces.msg.Time = ..., layer: builtins.str = ..., resolution: builtins.float = ..., size_x: builtins.int = ..., size_y: builtins.int = ..., origin: robolink.interfaces.geometry_msgs.msg.Pose = ...) -> None: ...
class CostmapUpdate(robolink.message.Message):
    """A changed rectangle of a costmap; `x` and `y` are the cell of its first corner."""
    header: robolink.interfaces.std_msgs.msg.Header
    x: builtins.int
    y: builtins.int
    size_x: builtins.int
    size_y: builtins.int
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., x: builtins.int = ..., y: builtins.int = ..., size_x: builtins.int = ..., size_y: builtins.int = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class CriticsStats(robolink.message.Message):
    """Costs that the critics of the MPPI controller added up, and which of them changed any.

    Kilted's.
    """
    stamp: robolink.interfaces.builtin_interfaces.msg.Time
    critics: collections.abc.MutableSequence[builtins.str]
    changed: collections.abc.MutableSequence[builtins.bool]
    costs_sum: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, stamp: robolink.interfaces.builtin_interfaces.msg.Time = ..., critics: collections.abc.Iterable[builtins.str] = ..., changed: collections.abc.Iterable[builtins.bool] = ..., costs_sum: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class EdgeCost(robolink.message.Message):
    """New cost of an edge of the route graph."""
    edgeid: builtins.int
    cost: builtins.float
    def __init__(self, *, edgeid: builtins.int = ..., cost: builtins.float = ...) -> None: ...
class MissedWaypoint(robolink.message.Message):
    """A waypoint that was not reached: its place in the list, its pose, and the code that says why."""
    index: builtins.int
    goal: robolink.interfaces.geometry_msgs.msg.PoseStamped
    error_code: builtins.int
    def __init__(self, *, index: builtins.int = ..., goal: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., error_code: builtins.int = ...) -> None: ...
class Particle(robolink.message.Message):
    """A pose that the robot may have, and its weight."""
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    weight: builtins.float
    def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., weight: builtins.float = ...) -> None: ...
class ParticleCloud(robolink.message.Message):
    """The particles of a localization filter."""
    header: robolink.interfaces.std_msgs.msg.Header
    particles: collections.abc.MutableSequence[robolink.interfaces.nav2_msgs.msg.Particle]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., particles: collections.abc.Iterable[robolink.interfaces.nav2_msgs.msg.Particle] = ...) -> None: ...
class Route(robolink.message.Message):
    """A route through the graph: its cost, its nodes and the edges between them, in their order."""
    header: robolink.interfaces.std_msgs.msg.Header
    route_cost: builtins.float
    nodes: collections.abc.MutableSequence[robolink.interfaces.nav2_msgs.msg.RouteNode]
    edges: collections.abc.MutableSequence[robolink.interfaces.nav2_msgs.msg.RouteEdge]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., route_cost: builtins.float = ..., nodes: collections.abc.Iterable[robolink.interfaces.nav2_msgs.msg.RouteNode] = ..., edges: collections.abc.Iterable[robolink.interfaces.nav2_msgs.msg.RouteEdge] = ...) -> None: ...
class RouteEdge(robolink.message.Message):
    """An edge of a route, with its number in the graph and its ends."""
    edgeid: builtins.int
    start: robolink.interfaces.geometry_msgs.msg.Point
    end: robolink.interfaces.geometry_msgs.msg.Point
    def __init__(self, *, edgeid: builtins.int = ..., start: robolink.interfaces.geometry_msgs.msg.Point = ..., end: robolink.interfaces.geometry_msgs.msg.Point = ...) -> None: ...
class RouteNode(robolink.message.Message):
    """A node of a route, with its number in the graph."""
    nodeid: builtins.int
    position: robolink.interfaces.geometry_msgs.msg.Point
    def __init__(self, *, nodeid: builtins.int = ..., position: robolink.interfaces.geometry_msgs.msg.Point = ...) -> None: ...
class SpeedLimit(robolink.message.Message):
    """Speed limit in m/s, or in percent of the greatest speed; 0 is none."""
    header: robolink.interfaces.std_msgs.msg.Header
    percentage: builtins.bool
    speed_limit: builtins.float
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., percentage: builtins.bool = ..., speed_limit: builtins.float = ...) -> None: ...
class Trajectory(robolink.message.Message):
    """A trajectory to drive.

    Kilted's.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    points: collections.abc.MutableSequence[robolink.interfaces.nav2_msgs.msg.TrajectoryPoint]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., points: collections.abc.Iterable[robolink.interfaces.nav2_msgs.msg.TrajectoryPoint] = ...) -> None: ...
class TrajectoryPoint(robolink.message.Message):
    """A point of a trajectory: the time from its start, pose, velocity, acceleration and forces.

    Kilted's.
    """
    time_from_start: robolink.interfaces.builtin_interfaces.msg.Duration
    pose: robolink.interfaces.geometry_msgs.msg.Pose
    velocity: robolink.interfaces.geometry_msgs.msg.Twist
    acceleration: robolink.interfaces.geometry_msgs.msg.Accel
    effort: robolink.interfaces.geometry_msgs.msg.Wrench
    def __init__(self, *, time_from_start: robolink.interfaces.builtin_interfaces.msg.Duration = ..., pose: robolink.interfaces.geometry_msgs.msg.Pose = ..., velocity: robolink.interfaces.geometry_msgs.msg.Twist = ..., acceleration: robolink.interfaces.geometry_msgs.msg.Accel = ..., effort: robolink.interfaces.geometry_msgs.msg.Wrench = ...) -> None: ...
class VoxelGrid(robolink.message.Message):
    """Cells of a costmap in three dimensions.

    Each number has two bits for each of the 16 cells of a column: 00 free, 01 unknown, 11 occupied.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    data: collections.abc.MutableSequence[builtins.int]
    origin: robolink.interfaces.geometry_msgs.msg.Point32
    resolutions: robolink.interfaces.geometry_msgs.msg.Vector3
    size_x: builtins.int
    size_y: builtins.int
    size_z: builtins.int
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., data: collections.abc.Iterable[builtins.int] = ..., origin: robolink.interfaces.geometry_msgs.msg.Point32 = ..., resolutions: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., size_x: builtins.int = ..., size_y: builtins.int = ..., size_z: builtins.int = ...) -> None: ...
class WaypointStatus(robolink.message.Message):
    """State of a waypoint: its place in the list, its pose and, after a failure, code and words.

    Kilted's; Jazzy has MissedWaypoint.
    """
    PENDING: typing.ClassVar[builtins.int]
    COMPLETED: typing.ClassVar[builtins.int]
    SKIPPED: typing.ClassVar[builtins.int]
    FAILED: typing.ClassVar[builtins.int]
    waypoint_status: builtins.int
    waypoint_index: builtins.int
    waypoint_pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
    error_code: builtins.int
    error_msg: builtins.str
    def __init__(self, *, waypoint_status: builtins.int = ..., waypoint_index: builtins.int = ..., waypoint_pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
