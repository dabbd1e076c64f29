"""Actions that start nodes, and that set what counts for the nodes behind them (`launch_ros.actions`)."""

from __future__ import annotations

from robolink.launch.ros.launch.actions import TimerAction
from robolink.launch.ros.launch.bases import EventHandler, LaunchContext
from robolink.launch.ros.launch.event_handlers import OnShutdown
from robolink.launch.ros.launch.events import TimerEvent
from robolink.launch.ros.launch.utilities import is_true
from robolink.launch.ros.launch_ros.components import ComposableNodeContainer, LoadComposableNodes
from robolink.launch.ros.launch_ros.lifecycle import LifecycleNode, LifecycleTransition
from robolink.launch.ros.launch_ros.node import Node
from robolink.launch.ros.launch_ros.settings import (
    PushROSNamespace,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetRosLogDir,
    SetUseSimTime,
)

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetRosLogDir",
    "SetUseSimTime",
]


class ROSTimer(TimerAction):
    """Actions for later, by the clock of the launcher's node in a LaunchService, which SetUseSimTime sets.

    `robolink launch` has no such node: there it is the launcher's own time.
    """

    def execute(self, context: LaunchContext) -> None:
        """Begin in `context`."""
        loop = context.asyncio_loop
        if loop is None:
            super().execute(context)
            return
        from robolink.launch.ros.launch_ros.ros_adapters import get_ros_node

        self._completed = loop.create_future()
        is_meant = lambda event: isinstance(event, TimerEvent) and event.timer_action is self  # noqa: E731
        context.register_event_handler(EventHandler(matcher=is_meant, entities=self.actions, handle_once=True))
        if is_true(context, self.cancel_on_shutdown):
            context.register_event_handler(OnShutdown(on_shutdown=lambda event, context: self.cancel()))

        def fire() -> None:
            timer.cancel()
            if not self.is_canceled:
                context.emit_event_sync(TimerEvent(timer_action=self))
                context.completed(self)
                self.complete()

        timer = get_ros_node(context).create_timer(self.seconds(context), lambda: loop.call_soon_threadsafe(fire))


RosTimer = ROSTimer
