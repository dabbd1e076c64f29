"""Nodes that make a map: one uses the newest scan, the other one every scan, however late."""

from __future__ import annotations

from robolink.counterparts.program import spin_program
from robolink.counterparts.slam_toolbox.toolbox import SlamToolbox
from robolink.interfaces.slam_toolbox.srv import ClearQueue
from robolink.lifecycle import LifecycleState, TransitionCallbackReturn
from robolink.qos import QoSProfile, ReliabilityPolicy


class AsynchronousSlamToolbox(SlamToolbox):
    """A managed node that makes a map of the newest scans; scans that it is too slow for are left out."""


class SynchronousSlamToolbox(SlamToolbox):
    """A managed node that makes a map of every scan, however late it comes to it."""

    SCANS = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT)
    EVERY = True

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Offer the topics and services, and begin to map."""
        result = super().on_activate(state)
        self._service(ClearQueue, "slam_toolbox/clear_queue", self.on_clear_queue)
        return result

    def on_clear_queue(self, request: ClearQueue.Request, response: ClearQueue.Response) -> ClearQueue.Response:
        """Forget the scans that wait for their transforms."""
        self.get_logger().info("SynchronousSlamToolbox: Clearing all queued scans to add to map.")
        self._forget_waiting()
        response.status = True
        return response


def run_asynchronous(args: list[str] | None = None) -> None:
    """Make a map until Ctrl-C."""
    spin_program(lambda words: AsynchronousSlamToolbox(), args)


def run_synchronous(args: list[str] | None = None) -> None:
    """Make a map of every scan until Ctrl-C."""
    spin_program(lambda words: SynchronousSlamToolbox(), args)
