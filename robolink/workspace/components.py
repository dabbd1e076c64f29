"""Table of the components of ROS packages that are classes of Node here, by the names of their C++ classes.

Launch files load components into containers. Here they are nodes that share a process.
"""

from __future__ import annotations

from robolink.workspace.counterparts import source_at
from robolink.workspace.source import NodeSource

COMPONENTS = {
    "composition::Listener": "robolink.counterparts.demo_nodes_cpp.listener:Listener",
    "composition::Talker": "robolink.counterparts.demo_nodes_cpp.talker:Talker",
    "demo_nodes_cpp::Listener": "robolink.counterparts.demo_nodes_cpp.listener:Listener",
    "demo_nodes_cpp::Talker": "robolink.counterparts.demo_nodes_cpp.talker:Talker",
    "image_tools::Cam2Image": "robolink.counterparts.image_tools.cam2image:Cam2Image",
    "image_tools::ShowImage": "robolink.counterparts.image_tools.showimage:ShowImage",
    "joy::GameController": "robolink.counterparts.joy.game_controller_node:GameControllerNode",
    "joy::Joy": "robolink.counterparts.joy.joy_node:JoyNode",
    "nav2_lifecycle_manager::LifecycleManager": (
        "robolink.counterparts.nav2_lifecycle_manager.lifecycle_manager:LifecycleManager"
    ),
    "nav2_map_server::CostmapFilterInfoServer": (
        "robolink.counterparts.nav2_map_server.costmap_filter_info_server:CostmapFilterInfoServer"
    ),
    "nav2_map_server::MapSaver": "robolink.counterparts.nav2_map_server.map_saver_server:MapSaver",
    "nav2_map_server::MapServer": "robolink.counterparts.nav2_map_server.map_server:MapServer",
    "robot_state_publisher::RobotStatePublisher": (
        "robolink.counterparts.robot_state_publisher.robot_state_publisher:RobotStatePublisher"
    ),
    "teleop_twist_joy::TeleopTwistJoy": "robolink.counterparts.teleop_twist_joy.teleop_node:TeleopTwistJoy",
    "tf2_ros::StaticTransformBroadcasterNode": "nodes/static_transform_publisher:StaticTransformPublisher",
    "topic_tools::DelayNode": "robolink.counterparts.topic_tools.delay:Delay",
    "topic_tools::DropNode": "robolink.counterparts.topic_tools.drop:Drop",
    "topic_tools::MuxNode": "robolink.counterparts.topic_tools.mux:Mux",
    "topic_tools::RelayNode": "robolink.counterparts.topic_tools.relay:Relay",
    "topic_tools::ThrottleNode": "robolink.counterparts.topic_tools.throttle:Throttle",
}
"""Targets, as those of `robolink.workspace.counterparts`, by plugin."""


def component(plugin: str) -> NodeSource | None:
    """Return the source of the class that does the same as the component `plugin`; None if there is none.

    >>> component("nav2_amcl::AmclNode") is None
    True
    """
    target = COMPONENTS.get(plugin)
    return None if target is None else source_at(target)
