"""Action that starts nodes after a robot's driver (`webots_ros2_driver.wait_for_controller_connection`)."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch.actions import RegisterEventHandler
from robolink.companions.launch.bases import Action, SomeEntitiesType
from robolink.companions.launch.event_handlers import OnProcessStart


class WaitForControllerConnection(RegisterEventHandler):
    """Start nodes once a driver has started; the driver waits for its robot, and the nodes wait for its topics.

    Args:
        target_driver: The action that starts the driver.
        nodes_to_start: What follows; only the first start of a driver with `respawn` counts.
    """

    def __init__(self, target_driver: Action, nodes_to_start: SomeEntitiesType) -> None:
        handler: Any = OnProcessStart(target_action=target_driver, on_start=nodes_to_start, handle_once=True)
        super().__init__(event_handler=handler)
