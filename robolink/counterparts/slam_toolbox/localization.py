"""Node that finds a robot in a map that was made before, and leaves that as it is."""

from __future__ import annotations

from robolink.counterparts.program import spin_program
from robolink.counterparts.slam_toolbox.toolbox import FARTHEST, Match, SlamToolbox
from robolink.geometry.plane import Pose, is_finite, pose_of
from robolink.interfaces.geometry_msgs.msg import PoseWithCovarianceStamped
from robolink.interfaces.std_srvs.srv import Empty
from robolink.lifecycle import LifecycleState, TransitionCallbackReturn
from robolink.navigation.mapper import Fit
from robolink.navigation.occupancy import Beams


class LocalizationSlamToolbox(SlamToolbox):
    """A managed node that localizes a robot in a saved map. `options` are those of `Node`."""

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Offer the topics and services, and begin to localize."""
        result = super().on_activate(state)
        group = (
            self.create_subscription(PoseWithCovarianceStamped, "initialpose", self.on_initial_pose, 1),
            self.destroy_subscription,
        )
        self._made.append(group)
        self._service(Empty, "slam_toolbox/clear_localization_buffer", self.on_clear_buffer)
        if not self.mapper.keyframes:
            self._warn("there is no map to localize in: set map_file_name, or call slam_toolbox/deserialize_map")
        return result

    def _process(self, beams: Beams, odometry: Pose) -> Fit | None:
        if not self.mapper.keyframes:
            self._warn("there is no map to localize in: set map_file_name, or call slam_toolbox/deserialize_map")
            return None
        return self.mapper.localize(beams, odometry)

    def _refusal(self, name: str, match_type: int, start: Pose) -> str:
        if match_type != Match.LOCALIZE_AT_POSE:
            return "Requested a non-localization deserialization in localization mode."
        return super()._refusal(name, Match.START_AT_GIVEN_POSE, start)

    def _kind(self, match_type: int) -> int:
        if match_type == Match.START_AT_FIRST_NODE:
            self.get_logger().warning(
                "LocalizationSlamToolbox: Starting localization at first node (dock) is correctly not supported."
            )
        return int(Match.LOCALIZE_AT_POSE)

    def on_initial_pose(self, message: PoseWithCovarianceStamped) -> None:
        """Look for the robot near a pose."""
        pose, frame = pose_of(message.pose.pose), message.header.frame_id.removeprefix("/")
        if not is_finite(pose) or max(map(abs, pose)) > FARTHEST:
            self.get_logger().error(f"Ignoring initial pose: expected finite numbers, got {pose}")
            return
        if frame not in ("", self._map_frame):
            self.get_logger().warning(f"Ignoring initial pose in frame '{frame}': expected '{self._map_frame}'")
            return
        self.mapper.begin_at(pose)
        self._keyframe_stamp = None
        self.get_logger().info(
            f"LocalizePoseCallback: Localizing to: ({pose.x:.2f} {pose.y:.2f}), theta={pose.theta:.2f}"
        )

    def on_clear_buffer(self, request: Empty.Request, response: Empty.Response) -> Empty.Response:
        """Log that there is nothing to clear: scans of localization are not remembered."""
        self.get_logger().info("LocalizationSlamToolbox: Clearing localization buffer.")
        return response


def run_localization(args: list[str] | None = None) -> None:
    """Localize a robot until Ctrl-C."""
    spin_program(lambda words: LocalizationSlamToolbox(), args)
