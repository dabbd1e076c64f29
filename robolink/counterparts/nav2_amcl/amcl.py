"""Node that localizes a robot: it publishes where the robot is on a map, and the transform from map to odometry."""

from __future__ import annotations

from collections import deque
from typing import Any, NamedTuple

import numpy as np

from robolink.clock import JumpHandle, JumpThreshold, TimeJump
from robolink.counterparts.nav2_amcl import beams, messages, parameters
from robolink.counterparts.nav2_amcl.parameters import NUMBERS, OTHERS, Parameters
from robolink.counterparts.nav2_util.parameters import keep_unknown
from robolink.counterparts.program import spin_program
from robolink.duration import Duration
from robolink.geometry.plane import Pose, is_finite, placed_on, pose_of
from robolink.interfaces.geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
from robolink.interfaces.lifecycle_msgs.msg import State
from robolink.interfaces.nav2_msgs.msg import ParticleCloud
from robolink.interfaces.nav2_msgs.srv import SetInitialPose
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_srvs.srv import Empty
from robolink.lifecycle import LifecycleNode, LifecyclePublisher, LifecycleState, TransitionCallbackReturn
from robolink.navigation.localization import Localization
from robolink.parameter import Parameter
from robolink.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from robolink.task import Future
from robolink.tf2 import Buffer, TransformBroadcaster, TransformException, TransformListener
from robolink.time import Time

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE

MOST_WAITING = 10
"""Most scans that wait for the transform of their time."""
SILENCE, LONG_SILENCE = 2.0, 10.0
"""Shortest times between two warnings of one kind, in seconds."""
NO_SCAN = 15.0
"""Time without a scan after which there is a warning, in seconds."""
BACK = 1.0
"""Seconds by which stamps must go back for odometry to count as begun anew."""


class Waiting(NamedTuple):
    """A scan that waits for odometry's transform of its time since `since`, by the node's clock."""

    scan: LaserScan
    future: Future[TransformStamped]
    since: Time


class AmclNode(LifecycleNode):
    """A managed node that localizes a robot on a map. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("amcl", **options)
        self.get_logger().info("Creating")
        parameters.declare(self)
        self.values = Parameters(self)
        self.localization: Localization | None = None
        self.last_pose: PoseWithCovarianceStamped | None = None
        """Pose that was published last, or set last."""
        self.is_known = False
        """True once it is known where to begin: a pose was set, or global localization requested."""
        self._is_set_late = False
        self._made: list[Any] = []
        self._poses: LifecyclePublisher[PoseWithCovarianceStamped] | None = None
        self._clouds: LifecyclePublisher[ParticleCloud] | None = None
        self._jumps: JumpHandle | None = None
        self._waiting: deque[Waiting] = deque()
        self._scan_at = self._heard_at = self.get_clock().now()
        self._searches = 0
        self._is_broadcast = False
        """True once the transform was published."""
        self.add_on_set_parameters_callback(self.on_set_parameters)
        self.add_post_set_parameters_callback(self.on_parameters)

    # Transitions

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the filter, and everything that it hears and publishes."""
        self.get_logger().info("Configuring")
        values = self.values
        name = "robot_model_type"
        if reason := parameters.fault(name, self.get_parameter(name).value):
            self.get_logger().error(reason)
            return FAILURE
        if values["always_reset_initial_pose"]:
            self.is_known, self.last_pose = False, None
        seed = values["random_seed"]
        own = self.context.time.random_ids(self.get_fully_qualified_name().encode()).getrandbits(63)
        self._searches = 0
        self.localization = Localization(values.options(), np.random.default_rng(own if seed < 0 else seed))
        self._map_frame, self._odom_frame = values.frame("global_frame_id"), values.frame("odom_frame_id")
        self._base_frame = values.frame("base_frame_id")
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._broadcaster = TransformBroadcaster(self)
        back = JumpThreshold(min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=False)
        self._jumps = self.get_clock().create_jump_callback(back, post_callback=self.on_time_jump)
        self._poses = self.create_lifecycle_publisher(PoseWithCovarianceStamped, "amcl_pose", LATCHED)
        self._clouds = self.create_lifecycle_publisher(ParticleCloud, "particle_cloud", qos_profile_sensor_data)
        self._offer()
        keep_unknown(self)
        return SUCCESS

    def _offer(self) -> None:
        values = self.values
        self._made = [
            self.create_subscription(OccupancyGrid, values["map_topic"], self.on_map, LATCHED),
            self.create_subscription(LaserScan, values["scan_topic"], self.on_scan, qos_profile_sensor_data),
            self.create_subscription(PoseWithCovarianceStamped, "initialpose", self.on_initial_pose, 10),
            self.create_service(Empty, "reinitialize_global_localization", self.on_global_localization),
            self.create_service(SetInitialPose, "set_initial_pose", self.on_set_initial_pose),
            self.create_service(Empty, "request_nomotion_update", self.on_nomotion_update),
            self.create_timer(NO_SCAN, self.on_look),
        ]

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to localize; the first time from where the parameters say, else from where it was."""
        self.get_logger().info("Activating")
        result = super().on_activate(state)
        self._heard_at, self._is_broadcast = self.get_clock().now(), False
        begins = self.localization is not None and self.localization.estimate is None
        if self._is_set_late and self.last_pose is not None:
            self._start(self.last_pose)
        elif begins and self.values["set_initial_pose"]:
            x, y, theta = (self.values[f"initial_pose.{each}"] for each in ("x", "y", "yaw"))
            self._start(messages.pose_message(Pose(x, y, theta), self._map_frame, self.get_clock().now().to_msg()))
        elif begins and self.is_known and self.last_pose is not None:
            self._start(self.last_pose)
        return result

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Use and publish nothing; the particles stay."""
        self.get_logger().info("Deactivating")
        self._forget_waiting()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw everything; the pose is the initial one of the next time."""
        self.get_logger().info("Cleaning up")
        self._withdraw()
        if self.values["set_initial_pose"] and self.last_pose is not None:
            x, y, theta = pose_of(self.last_pose.pose.pose)
            named = {"initial_pose.x": x, "initial_pose.y": y, "initial_pose.yaw": theta}
            self.set_parameters([Parameter(each, value=value) for each, value in named.items()])
        return SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw what is left."""
        self.get_logger().info("Shutting down")
        self._withdraw()
        return SUCCESS

    def _withdraw(self) -> None:
        self._forget_waiting()
        if self.localization is None:
            return
        self.localization = None
        subscriptions, services = self._made[:3], self._made[3:6]
        for each in subscriptions:
            self.destroy_subscription(each)
        for service in services:
            self.destroy_service(service)
        self.destroy_timer(self._made[6])
        self._listener.unregister()
        self.destroy_publisher(self._broadcaster.pub_tf)
        for publisher in (self._poses, self._clouds):
            if publisher is not None:
                self.destroy_lifecycle_publisher(publisher)
        if self._jumps is not None:
            self._jumps.unregister()
        self._made, self._poses, self._clouds, self._jumps = [], None, None, None

    def _is_active(self) -> bool:
        return self._state_machine.current_state[0] == State.PRIMARY_STATE_ACTIVE

    # Parameters

    def on_set_parameters(self, changed: list[Parameter[Any]]) -> SetParametersResult:
        """Refuse values that make no sense."""
        if self.localization is None:
            return SetParametersResult(successful=True)  # they are looked at when the node is configured
        values = {each.name: each.value for each in changed}
        for name, value in values.items():
            if (name in NUMBERS or name in OTHERS) and (reason := parameters.fault(name, value)):
                return SetParametersResult(successful=False, reason=reason)
        least, most = (values.get(each, self.values[each]) for each in ("min_particles", "max_particles"))
        if least > most:
            reason = f"min_particles: {least} is more than max_particles, {most}"
            return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def on_parameters(self, changed: list[Parameter[Any]]) -> None:
        """Use new values from the next scan on; topics, frames and the seed from the next configuration on."""
        if self.localization is not None and any(each.name in NUMBERS or each.name in OTHERS for each in changed):
            self.localization.options = self.values.options()

    # Map

    def on_map(self, grid: OccupancyGrid) -> None:
        """Take a map."""
        if self.localization is None or (self.values["first_map_only"] and self.localization.has_map):
            return
        if reason := messages.map_fault(grid):
            self.get_logger().error(f"Received map message is malformed. Rejecting. {reason}")
            return
        info = grid.info
        self.get_logger().info(f"Received a {info.width} X {info.height} map @ {info.resolution:.3f} m/pix")
        if grid.header.frame_id.removeprefix("/") != self._map_frame:
            self.get_logger().warning(
                f"the map is in the frame '{grid.header.frame_id}', and global_frame_id is '{self._map_frame}':"
                " it is taken as if it were in that"
            )
        self.localization.set_map(messages.grid_of(grid))

    # Where to begin

    def on_initial_pose(self, pose: PoseWithCovarianceStamped) -> None:
        """Begin at a pose."""
        if reason := messages.pose_fault(pose):
            self.get_logger().error(f"Received initialpose message is malformed. Rejecting. {reason}")
            return
        frame = pose.header.frame_id.removeprefix("/")
        if frame != self._map_frame:
            self.get_logger().warning(
                f"Ignoring initial pose in frame '{frame}': it must be in the global frame, '{self._map_frame}'"
            )
            return
        self.last_pose = pose
        if not self._is_active():
            self._is_set_late = True
            self.get_logger().warning("Received an initial pose, but AMCL is not active yet: it is used once it is")
            return
        self._start(pose)

    def on_set_initial_pose(
        self, request: SetInitialPose.Request, response: SetInitialPose.Response
    ) -> SetInitialPose.Response:
        """Begin at a pose."""
        self.on_initial_pose(request.pose)
        return response

    def _start(self, message: PoseWithCovarianceStamped) -> None:
        """Begin at a pose of some time, and the way that the robot has driven since."""
        if self.localization is None:
            return
        pose = placed_on(pose_of(message.pose.pose), self._driven_since(message))
        self.get_logger().info(f"Setting pose: {pose.x:.3f} {pose.y:.3f} {pose.theta:.3f}")
        self.localization.start_at(pose, messages.covariance_of(message))
        self.is_known, self._is_set_late, self.last_pose = True, False, message

    def _driven_since(self, message: PoseWithCovarianceStamped) -> Pose:
        """Return how far the robot has come by odometry since the time of a pose."""
        base, stamp = self._base_frame, message.header.stamp
        try:
            found = self._buffer.lookup_transform_full(base, stamp, base, Time(), self._odom_frame)
        except TransformException:
            return Pose()  # too long ago, or odometry has not come yet: it is taken as the present pose
        return messages.plane_pose(found)

    def on_global_localization(self, request: Empty.Request, response: Empty.Response) -> Empty.Response:
        """Begin anywhere on the map."""
        self.get_logger().info("Initializing with uniform distribution")
        if self.localization is None or not self.localization.start_anywhere():
            has_map = self.localization is not None and self.localization.has_map
            reason = "no cell of the map is free" if has_map else "no map has come yet"
            self.get_logger().error(f"Global localization is refused: {reason}")
            return response
        self.get_logger().info("Global initialisation done!")
        self.is_known = True
        return response

    def on_nomotion_update(self, request: Empty.Request, response: Empty.Response) -> Empty.Response:
        """Use the next scan, though the robot has not moved."""
        self.get_logger().info("Requesting no-motion update")
        if self.localization is not None:
            self.localization.is_forced = True
        return response

    # Scans

    def on_scan(self, scan: LaserScan) -> None:
        """Use a scan as soon as odometry's transform of its time is there."""
        if not self._is_active() or self.localization is None:
            return
        self._heard_at = self.get_clock().now()
        if not self.localization.has_map:
            self._warn(f"Waiting for map on {self.resolve_topic_name(self.values['map_topic'])}")
            return
        if reason := beams.fault(scan):
            self._warn(f"refused a scan: {reason}")
            return
        future = self._buffer.wait_for_transform_async(self._odom_frame, self._base_frame, scan.header.stamp)
        self._drop_late()
        self._waiting.append(Waiting(scan, future, self._heard_at))
        if future.done():
            self._take()
        else:
            future.add_done_callback(lambda _: self._take())

    def _drop_late(self) -> None:
        """Drop scans that have waited too long, or that are too many."""
        patience = self.values["transform_tolerance"] * 1e9
        for each in list(self._waiting):
            if (self._heard_at - each.since).nanoseconds > patience or len(self._waiting) >= MOST_WAITING:
                self._waiting.remove(each)
                each.future.cancel()
                self._warn(f"dropped a scan: {self._reason(each.scan)}")

    def _reason(self, scan: LaserScan) -> str:
        """Return why odometry's transform of a scan's time is not there."""
        base, odom = self._base_frame, self._odom_frame
        _, words = self._buffer.can_transform(odom, base, scan.header.stamp, return_debug_tuple=True)
        return f"no transform from base_frame_id '{base}' to odom_frame_id '{odom}' at its time: {words}"

    def _forget_waiting(self) -> None:
        while self._waiting:
            self._waiting.popleft().future.cancel()

    def _take(self) -> None:
        """Use the scans whose transforms have come."""
        for each in list(self._waiting):
            if each.future.done():
                self._waiting.remove(each)
                if each.future.exception() is not None:
                    self._warn(f"dropped a scan: {self._reason(each.scan)}")
                elif (found := each.future.result()) is not None and self._is_active():
                    self._use(each.scan, messages.plane_pose(found))

    def _use(self, scan: LaserScan, odometry: Pose) -> None:
        """Use a scan that was taken at a pose of odometry."""
        localization = self.localization
        if localization is None or not is_finite(odometry):
            return
        if not self.is_known:
            self._warn("AMCL cannot publish a pose or update the transform. Please set the initial pose...")
            return
        try:
            mount = self._buffer.lookup_transform(self._base_frame, scan.header.frame_id.removeprefix("/"), Time())
        except TransformException as error:
            self._warn(f"dropped a scan: where is its frame '{scan.header.frame_id}' on the robot? {error}")
            return
        seconds = self._since(scan)
        limits = beams.Limits(*(self.values[each] for each in ("max_beams", "laser_min_range", "laser_max_range")))
        if seconds < -BACK:
            self._restart_odometry(f"stamps of scans go back by {-seconds:.1f} s")
        if localization.update(odometry, beams.beams_of(scan, mount, limits), max(seconds, 0.0)):
            self._tell(scan)
        self._broadcast(scan)

    def _since(self, scan: LaserScan) -> float:
        """Return the time since the scan before, in seconds; it is below 0 if stamps go back."""
        stamp = Time.from_msg(scan.header.stamp, self._scan_at.clock_type)
        seconds, self._scan_at = (stamp - self._scan_at).nanoseconds / 1e9, stamp
        return seconds

    def on_time_jump(self, jump: TimeJump) -> None:
        """Take odometry as begun anew when time goes back."""
        self._forget_waiting()
        self._scan_at = self.get_clock().now()
        self._restart_odometry(f"time has jumped back by {-jump.delta.nanoseconds / 1e9:.1f} s")

    def _restart_odometry(self, reason: str) -> None:
        if self.localization is not None:
            self.localization.restart_odometry()
            self.get_logger().warning(f"{reason}: odometry may have begun anew; set the pose if the robot was moved")

    # Results

    def _tell(self, scan: LaserScan) -> None:
        """Publish a new estimate."""
        localization = self.localization
        assert localization is not None
        assert localization.estimate is not None
        pose, covariance, _ = localization.estimate
        if not (is_finite(pose) and np.isfinite(covariance).all()):
            self._warn("the pose is not finite: are the parameters of odometry's errors sound?")
            return
        self.last_pose = messages.pose_message(pose, self._map_frame, scan.header.stamp, covariance)
        if self._poses is not None:
            self._poses.publish(self.last_pose)
        if self._clouds is not None and self._clouds.get_subscription_count():
            now = self.get_clock().now().to_msg()
            self._clouds.publish(messages.cloud_of(localization.particles, self._map_frame, now))
        self._tell_fit(pose, localization)

    def _tell_fit(self, pose: Pose, localization: Localization) -> None:
        """Warn if scans fit badly: the robot may have been carried away."""
        searches, self._searches = localization.searches - self._searches, localization.searches
        if not searches and not localization.seems_lost:
            return
        act = (
            "it is searched everywhere"
            if searches
            else "set the pose, call reinitialize_global_localization, or set recovery_alpha_fast (0.1)"
        )
        self.get_logger().warning(
            f"only {100 * localization.fit:.0f} % of the scan fits to the map from ({pose.x:.2f}, {pose.y:.2f}),"
            f" usually {100 * localization.watch.usual:.0f} %: the robot may be elsewhere; {act}",
            throttle_duration_sec=LONG_SILENCE,
        )

    def _broadcast(self, scan: LaserScan) -> None:
        """Publish the transform from map to odometry, which holds for a while beyond the scan."""
        origin = self.localization.origin_of_odometry() if self.localization is not None else None
        if origin is None or not is_finite(origin) or not self.values["tf_broadcast"]:
            return
        later = Time.from_msg(scan.header.stamp) + Duration(seconds=self.values["transform_tolerance"])
        # The first time for the scan itself, too: else nobody knows the pose until then.
        stamps = [later.to_msg()] if self._is_broadcast else [scan.header.stamp, later.to_msg()]
        self._broadcaster.sendTransform(
            [messages.transform_of(origin, self._map_frame, self._odom_frame, each) for each in stamps]
        )
        self._is_broadcast = True

    def on_look(self) -> None:
        """Warn if no scan comes."""
        silent = (self.get_clock().now() - self._heard_at).nanoseconds / 1e9
        if self._is_active() and silent >= NO_SCAN:
            topic = self.resolve_topic_name(self.values["scan_topic"])
            self.get_logger().warning(f"No laser scan received on {topic} for {silent:.0f} seconds: is it published?")

    def _warn(self, words: str) -> None:
        self.get_logger().warning(words, throttle_duration_sec=SILENCE)


def main(args: list[str] | None = None) -> None:
    """Localize a robot until Ctrl-C."""
    spin_program(lambda words: AmclNode(), args)
