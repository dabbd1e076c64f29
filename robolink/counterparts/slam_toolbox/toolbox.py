"""Base of slam_toolbox's nodes: scans come in, a map and the transform from map to odometry go out."""

from __future__ import annotations

from collections import deque
from pathlib import Path
from typing import Any

from robolink.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.clock import JumpHandle, JumpThreshold, TimeJump
from robolink.counterparts.nav2_map_server.map_files import MapSaveError, Saving, save
from robolink.counterparts.nav2_util.parameters import keep_unknown
from robolink.counterparts.program import pause
from robolink.counterparts.slam_toolbox import messages, parameters
from robolink.counterparts.slam_toolbox.parameters import Parameters
from robolink.duration import Duration
from robolink.geometry.plane import Pose, is_finite, placed_on, seen_from
from robolink.interfaces.geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
from robolink.interfaces.lifecycle_msgs.msg import State
from robolink.interfaces.nav_msgs.msg import MapMetaData, OccupancyGrid
from robolink.interfaces.nav_msgs.srv import GetMap
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.slam_toolbox.srv import (
    Clear,
    DeserializePoseGraph,
    Pause,
    Reset,
    SaveMap,
    SerializePoseGraph,
)
from robolink.interfaces.std_msgs.msg import Header
from robolink.interfaces.visualization_msgs.msg import MarkerArray
from robolink.lifecycle import LifecycleNode, LifecyclePublisher, LifecycleState, TransitionCallbackReturn
from robolink.navigation import saved_graph
from robolink.navigation.mapper import Fit, Mapper
from robolink.navigation.occupancy import Beams
from robolink.parameter import Parameter
from robolink.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from robolink.task import Future
from robolink.tf2 import Buffer, TransformBroadcaster, TransformException, TransformListener
from robolink.time import Time

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE
Match = DeserializePoseGraph.Request

SILENCE = 5.0
"""Shortest time between two warnings of one kind, in seconds."""
BACK = 1.0
"""Seconds by which stamps must go back for odometry to count as begun anew."""
FARTHEST = 1e8
"""Metres from the origin beyond which odometry is not believed."""
AT_ONCE = 40
"""Keyframes that are drawn before others get their turn: some 20 ms."""


class SlamToolbox(LifecycleNode):
    """A managed node that makes a map, or uses one. `options` are those of `Node`."""

    SCANS = qos_profile_sensor_data
    """QoS of the subscription to scans."""
    EVERY = False
    """True if each scan waits for its transform, False if only the last `scan_queue_size` do."""

    def __init__(self, **options: Any) -> None:
        super().__init__("slam_toolbox", **options)
        parameters.declare(self)
        self.values = Parameters(self)
        self.mapper = Mapper()
        self.map_to_odom: Pose | None = None
        """Pose of odometry's frame in the map; None before the first scan."""
        self._stamp: Time | None = None
        self._keyframe_stamp: Time | None = None
        self._sent: Time | None = None
        self._waiting: deque[tuple[LaserScan, Future[TransformStamped]]] = deque()
        self._made: list[tuple[Any, Any]] = []
        self._jumps: JumpHandle | None = None
        self._count = 0
        self._is_lost = self._is_new = False

    # Transitions

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Read the parameters, and the map to begin with if there is one."""
        self.get_logger().info("Configuring")
        values = self.values
        self.mapper = Mapper(values.options())
        self.map_to_odom = self._stamp = self._keyframe_stamp = self._sent = None
        self._map_frame, self._odom_frame = values.frame("map_frame"), values.frame("odom_frame")
        self._base_frame = values.frame("base_frame")
        self._buffer = Buffer(Duration(seconds=values["tf_buffer_duration"]))
        self._listener = TransformListener(self._buffer, self)
        self._broadcaster = TransformBroadcaster(self)
        self.set_parameters([Parameter("paused_new_measurements", value=False)])
        keep_unknown(self)
        self._load_by_parameters()
        return SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Offer the topics and services, and begin to map."""
        self.get_logger().info("Activating")
        values, topic = self.values, self.values["map_name"]
        self._poses = self._publisher(PoseWithCovarianceStamped, "pose", QoSProfile(depth=10))
        self._maps = self._publisher(OccupancyGrid, topic, LATCHED)
        self._metadata = self._publisher(MapMetaData, f"{topic}_metadata", LATCHED)
        self._graphs = self._publisher(MarkerArray, "slam_toolbox/graph_visualization", QoSProfile(depth=1))
        self._offer()
        self._made.append(
            (
                self.create_subscription(LaserScan, values["scan_topic"], self.on_scan, self.SCANS),
                self.destroy_subscription,
            )
        )
        self._alone, group = ReentrantCallbackGroup(), MutuallyExclusiveCallbackGroup()
        self._timer(values["map_update_interval"], self.on_map_due, group)
        if values["transform_publish_period"] > 0:
            self._timer(values["transform_publish_period"], self.on_transform_due, self._alone)
        back = JumpThreshold(min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=False)
        self._jumps = self.get_clock().create_jump_callback(back, post_callback=self.on_time_jump)
        return super().on_activate(state)

    def _offer(self) -> None:
        """Offer the services."""
        offered: dict[str, tuple[type[Any], Any]] = {
            "clear_changes": (Clear, self.on_clear),
            "deserialize_map": (DeserializePoseGraph, self.on_deserialize),
            "dynamic_map": (GetMap, self.on_get_map),
            "pause_new_measurements": (Pause, self.on_pause),
            "reset": (Reset, self.on_reset),
            "serialize_map": (SerializePoseGraph, self.on_serialize),
        }
        if self.values["use_map_saver"]:
            offered["save_map"] = (SaveMap, self.on_save_map)
        for name, (kind, answer) in offered.items():
            self._service(kind, f"slam_toolbox/{name}", answer)

    def _publisher(self, kind: type[Any], topic: str, qos: QoSProfile) -> LifecyclePublisher[Any]:
        publisher: LifecyclePublisher[Any] = self.create_lifecycle_publisher(kind, topic, qos)
        self._made.append((publisher, self.destroy_lifecycle_publisher))
        return publisher

    def _service(self, kind: type[Any], name: str, answer: Any) -> None:
        self._made.append((self.create_service(kind, name, answer), self.destroy_service))

    def _timer(self, period: float, callback: Any, group: Any) -> None:
        self._made.append((self.create_timer(period, callback, callback_group=group), self.destroy_timer))

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw topics and services; the map stays."""
        self.get_logger().info("Deactivating")
        result = super().on_deactivate(state)
        self._withdraw()
        return result

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Forget the map."""
        self.get_logger().info("Cleaning up")
        self._forget()
        return SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw what is left."""
        self.get_logger().info("Shutting down")
        self._withdraw()
        if hasattr(self, "_listener"):
            self._forget()
        return SUCCESS

    def _withdraw(self) -> None:
        self._forget_waiting()
        while self._made:
            thing, destroy = self._made.pop()
            destroy(thing)
        if self._jumps is not None:
            self._jumps.unregister()
            self._jumps = None

    def _forget(self) -> None:
        self._listener.unregister()
        self.destroy_publisher(self._broadcaster.pub_tf)
        self.mapper, self.map_to_odom = Mapper(), None

    def _is_active(self) -> bool:
        return self._state_machine.current_state[0] == State.PRIMARY_STATE_ACTIVE

    # Scans

    def on_scan(self, scan: LaserScan) -> None:
        """Use a scan as soon as odometry's transform of its time is there."""
        if not self._is_active():
            return
        if reason := messages.scan_fault(scan):
            self._warn(f"refused a scan: {reason}")
            return
        future = self._buffer.wait_for_transform_async(self._odom_frame, self._base_frame, scan.header.stamp)
        self._waiting.append((scan, future))
        if future.done():
            self._take()
        else:
            future.add_done_callback(lambda _: self._take())
            most = 1000 if self.EVERY else self.values["scan_queue_size"]
            while len(self._waiting) > most:
                late, never = self._waiting.popleft()
                never.cancel()
                self._warn(f"dropped a scan: {self._reason(late)}")

    def _reason(self, scan: LaserScan) -> str:
        """Return why odometry's transform of a scan's time is not there."""
        base, odom = self._base_frame, self._odom_frame
        _, words = self._buffer.can_transform(odom, base, scan.header.stamp, return_debug_tuple=True)
        return f"no transform from base_frame '{base}' to odom_frame '{odom}' at its time: {words}"

    def _forget_waiting(self) -> None:
        while self._waiting:
            self._waiting.popleft()[1].cancel()

    def _take(self) -> None:
        """Use the scans whose transforms have come."""
        for each in list(self._waiting):
            scan, future = each
            if future.done() and each in self._waiting:
                self._waiting.remove(each)
                if future.exception() is not None:
                    self._warn(f"dropped a scan: {self._reason(scan)}")
                elif (found := future.result()) is not None and self._is_active():
                    self._use(scan, messages.plane_pose(found))

    def _use(self, scan: LaserScan, odometry: Pose) -> None:
        """Use a scan that was made at a pose of odometry."""
        if not is_finite(odometry) or max(abs(odometry.x), abs(odometry.y)) > FARTHEST:
            self._warn(f"dropped a scan: odometry says {odometry}, expected numbers within {FARTHEST:g} m")
            return
        stamp = Time.from_msg(scan.header.stamp)
        if self._stamp is not None and (self._stamp - stamp).nanoseconds > BACK * 1e9:
            self._restart(f"stamps of scans go back by {(self._stamp - stamp).nanoseconds / 1e9:.1f} s")
        self._stamp = stamp
        if not self._is_due(stamp):
            return
        try:
            mount = self._buffer.lookup_transform(self._base_frame, scan.header.frame_id.removeprefix("/"), Time())
        except TransformException as error:
            self._warn(f"dropped a scan: where is its frame '{scan.header.frame_id}' on the robot? {error}")
            return
        beams = messages.beams_of(scan, mount, self.values["max_laser_range"])
        fit = self._process(beams, odometry)
        if fit is not None:
            self._keyframe_stamp = stamp
            self._publish_fit(fit, odometry, scan.header)

    def _is_due(self, stamp: Time) -> bool:
        """Return True if a scan of this time is used: not while paused, and not too many."""
        self._count += 1
        if self._count % self.values["throttle_scans"] or self.values["paused_new_measurements"]:
            return False
        if self._keyframe_stamp is None:
            return True
        return bool((stamp - self._keyframe_stamp).nanoseconds >= self.values["minimum_time_interval"] * 1e9)

    def _process(self, beams: Beams, odometry: Pose) -> Fit | None:
        """Take a scan into the map; None if the robot has not moved enough."""
        return self.mapper.process(beams, odometry)

    def _publish_fit(self, fit: Fit, odometry: Pose, header: Header) -> None:
        """Publish the pose of a scan, and log what is remarkable about it."""
        is_first = self.map_to_odom is None
        self.map_to_odom = placed_on(fit.pose, seen_from(odometry, Pose()))
        scales = self.values["position_covariance_scale"], self.values["yaw_covariance_scale"]
        there = Header(stamp=header.stamp, frame_id=self._map_frame)
        self._poses.publish(messages.pose_message(fit.pose, fit.covariance, scales, there))
        if fit.closed is not None and fit.closed > self.mapper.options.resolution:
            self.get_logger().info(f"Closed a loop: the map moved by up to {fit.closed:.2f} m")
        if fit.is_lost and not self._is_lost:
            self.get_logger().warning(
                f"the scan does not fit the map at ({fit.pose.x:.2f}, {fit.pose.y:.2f}), where odometry says that the"
                " robot is: was it carried away? Scans are not used until one fits somewhere again"
            )
        if fit.is_found:
            self.get_logger().info(f"Scans fit the map again, at ({fit.pose.x:.2f}, {fit.pose.y:.2f})")
        self._is_lost = fit.is_lost
        if is_first:
            self._publish_map()

    def on_time_jump(self, jump: TimeJump) -> None:
        """Begin odometry anew when time goes back."""
        self._restart(f"time has jumped back by {-jump.delta.nanoseconds / 1e9:.1f} s")

    def _restart(self, reason: str) -> None:
        self._forget_waiting()
        self._stamp = self._keyframe_stamp = self._sent = None
        if self.mapper.keyframes:
            self.mapper.begin_at(self.mapper.pose)
            self.get_logger().warning(f"{reason}: odometry begins anew, and the robot is looked for where it was last")

    # Publishing

    def on_transform_due(self) -> None:
        """Publish the transform from the map to odometry, if a scan came since the last time."""
        if self.map_to_odom is None or self._stamp is None or self._stamp == self._sent:
            return
        self._sent = self._stamp
        later = self._stamp + Duration(seconds=self.values["transform_timeout"])
        header = Header(stamp=later.to_msg(), frame_id=self._map_frame)
        self._broadcaster.sendTransform(messages.transform_message(self.map_to_odom, header, self._odom_frame))

    async def on_map_due(self) -> None:
        """Publish the map, drawn in parts where a loop has moved much of it, and the graph if somebody listens."""
        mapper = self.mapper
        while mapper.draw(AT_ONCE) and self._is_active():
            await pause(self, 0.0, self._alone)
        if not self._is_active() or mapper is not self.mapper:
            return
        if mapper.too_far:
            self._warn(f"{mapper.too_far} scans are not in the map, which would be too large with them")
        self._publish_map()
        if mapper.keyframes and self._graphs.get_subscription_count():
            now = self.get_clock().now().to_msg()
            self._graphs.publish(messages.graph_message(mapper.graph, self._map_frame, now))

    def _map(self) -> OccupancyGrid | None:
        """Return the map as a message; None if there is none yet."""
        grid = self.mapper.grid()
        if not grid.cells.size:
            return None
        stamp = self._stamp.to_msg() if self._stamp is not None else self.get_clock().now().to_msg()
        return messages.map_message(grid, Header(stamp=stamp, frame_id=self._map_frame))

    def _publish_map(self) -> None:
        found = self._map()
        if found is not None:
            self._maps.publish(found)
            self._metadata.publish(found.info)

    # Services

    def on_get_map(self, request: GetMap.Request, response: GetMap.Response) -> GetMap.Response:
        """Answer with the map."""
        found = self._map()
        if found is not None:
            response.map = found
        return response

    def on_pause(self, request: Pause.Request, response: Pause.Response) -> Pause.Response:
        """Use no more scans, or use them again."""
        paused = not self.get_parameter("paused_new_measurements").value
        self.set_parameters([Parameter("paused_new_measurements", value=paused)])
        words = "pause taking new measurements." if paused else "actively taking new measurements."
        self.get_logger().info(f"SlamToolbox: Toggled to {words}")
        response.status = True
        return response

    def on_clear(self, request: Clear.Request, response: Clear.Response) -> Clear.Response:
        """Log that there is nothing to clear: poses are not moved by hand here."""
        self.get_logger().warning("Called Clear changes with interactive mode disabled. Ignoring.")
        return response

    def on_reset(self, request: Reset.Request, response: Reset.Response) -> Reset.Response:
        """Begin with an empty map."""
        self._forget_waiting()
        self.mapper, self.map_to_odom = Mapper(self.values.options()), None
        self._stamp = self._keyframe_stamp = self._sent = None
        self._is_lost = False
        if request.pause_new_measurements:
            self.set_parameters([Parameter("paused_new_measurements", value=True)])
            self.get_logger().info("SlamToolbox: Toggled to pause taking new measurements after reset.")
        response.result = Reset.Response.RESULT_SUCCESS
        return response

    def on_save_map(self, request: SaveMap.Request, response: SaveMap.Response) -> SaveMap.Response:
        """Save the map as an image with its YAML file."""
        found, name = self._map(), request.name.data
        if found is None:
            self.get_logger().warning("Map Saver: Cannot save map, no scan has become a part of it yet.")
            response.result = SaveMap.Response.RESULT_NO_MAP_RECEIEVD
            return response
        name = name or f"map_{self.get_clock().now().nanoseconds // 10**9}"
        self.get_logger().info(f"SlamToolbox: Saving map as {name}.")
        try:
            save(found, Saving(str(Path(name).expanduser())))
            response.result = SaveMap.Response.RESULT_SUCCESS
        except (MapSaveError, OSError) as error:
            self.get_logger().error(f"Failed to save the map: {_words(error)}")
            response.result = SaveMap.Response.RESULT_UNDEFINED_FAILURE
        return response

    def on_serialize(
        self, request: SerializePoseGraph.Request, response: SerializePoseGraph.Response
    ) -> SerializePoseGraph.Response:
        """Save the pose graph with its scans."""
        response.result = SerializePoseGraph.Response.RESULT_FAILED_TO_WRITE_FILE
        if not request.filename:
            self.get_logger().error("Failed to save the pose graph: the request's filename is empty")
            return response
        path = saved_graph.path_of(request.filename)
        try:
            saved_graph.save(path, self.mapper)
        except (saved_graph.SavedGraphError, OSError) as error:
            self.get_logger().error(f"Failed to save the pose graph {path}: {_words(error)}")
            return response
        self.get_logger().info(f"Saved {len(self.mapper.keyframes)} scans in {path}")
        response.result = SerializePoseGraph.Response.RESULT_SUCCESS
        return response

    def on_deserialize(
        self, request: DeserializePoseGraph.Request, response: DeserializePoseGraph.Response
    ) -> DeserializePoseGraph.Response:
        """Go on from a pose graph that was saved."""
        start = request.initial_pose
        self.load(request.filename, request.match_type, Pose(start.x, start.y, start.theta))
        return response

    def load(self, name: str, match_type: int, start: Pose) -> bool:
        """Go on from a file; return True if that worked, and log why if not.

        Args:
            name: Name of the file, without its ending.
            match_type: Where the robot is, as DeserializePoseGraph numbers it.
            start: Where it is in that map, unless it is where the map began.
        """
        reason = self._refusal(name, match_type, start)
        if reason:
            self.get_logger().error(f"DeserializePoseGraph: {reason}")
            return False
        try:
            mapper = saved_graph.load(saved_graph.path_of(name), self.values.options())
        except saved_graph.SavedGraphError as error:
            self.get_logger().error(f"DeserializePoseGraph: Failed to read file: {error}")
            return False
        if match_type != Match.START_AT_FIRST_NODE:
            mapper.begin_at(start)
        self._forget_waiting()
        self.mapper, self.map_to_odom, self._is_lost = mapper, None, False
        self._stamp = self._keyframe_stamp = self._sent = None
        self.get_logger().info(f"Loaded {len(mapper.keyframes)} scans from {saved_graph.path_of(name)}")
        return True

    def _refusal(self, name: str, match_type: int, start: Pose) -> str:
        """Return why a request to go on from a file cannot be fulfilled; '' if it can."""
        if not name:
            return "No map file given!"
        if match_type == Match.LOCALIZE_AT_POSE:
            return "Requested a localization deserialization in non-localization mode."
        if match_type not in (Match.START_AT_FIRST_NODE, Match.START_AT_GIVEN_POSE):
            return f"match_type: expected 1 (first node), 2 (given pose) or 3 (localize), got {match_type}"
        if not is_finite(start) or max(map(abs, start)) > FARTHEST:
            return f"initial_pose: expected finite numbers, got {start}"
        return ""

    def _load_by_parameters(self) -> None:
        """Begin with the map that the parameters name, if they do."""
        values, name = self.values, self.values["map_file_name"]
        if not name:
            return
        given = values["map_start_pose"] or []
        if given and not _is_pose(given):
            self.get_logger().error(f"map_start_pose: expected [x, y, theta], got {given}. Starting at the origin")
            given = [0.0, 0.0, 0.0]
        at_dock = values["map_start_at_dock"] and not given
        match_type = Match.START_AT_FIRST_NODE if at_dock else Match.START_AT_GIVEN_POSE
        self.load(name, self._kind(match_type), Pose(*map(float, given)))

    def _kind(self, match_type: int) -> int:
        """Return how a map that parameters name is used, as DeserializePoseGraph numbers it."""
        return match_type

    def _warn(self, words: str) -> None:
        self.get_logger().warning(words, throttle_duration_sec=SILENCE)


def _is_pose(given: Any) -> bool:
    """Return True for three numbers."""
    return isinstance(given, list) and len(given) == 3 and all(isinstance(each, int | float) for each in given)


def _words(error: Exception) -> str:
    """Return an error's words, without Python's for those of the system."""
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    return str(error)
