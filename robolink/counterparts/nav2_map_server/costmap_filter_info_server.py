"""Publish what the mask of a costmap's filter means, for late subscribers too, once the node is activated.

robolink run nav2_map_server costmap_filter_info_server --ros-args -p mask_topic:=filter_mask -p type:=1
"""

from __future__ import annotations

from typing import Any

from robolink.counterparts.program import spin_program
from robolink.interfaces.nav2_msgs.msg import CostmapFilterInfo
from robolink.lifecycle import LifecycleNode, LifecyclePublisher, LifecycleState, TransitionCallbackReturn
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class CostmapFilterInfoServer(LifecycleNode):
    """A managed node that publishes one message. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("costmap_filter_info_server", **options)
        self.declare_parameter("filter_info_topic", "costmap_filter_info", described("topic of the message"))
        self.declare_parameter(
            "type", 0, described("0 keepout or lanes, 1 limits in percent, 2 in m/s, 3 binary", 0, 255)
        )
        self.declare_parameter("mask_topic", "filter_mask", described("topic of the mask, a map"))
        self.declare_parameter("base", 0.0, described("value of a cell of 0"))
        self.declare_parameter("multiplier", 1.0, described("value of each unit of a cell"))
        self._information: LifecyclePublisher[CostmapFilterInfo] | None = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the publisher."""
        self.get_logger().info("Configuring")
        topic = self.get_parameter("filter_info_topic").value
        self._information = self.create_lifecycle_publisher(CostmapFilterInfo, topic, LATCHED)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish the message."""
        self.get_logger().info("Activating")
        result = super().on_activate(state)
        base, multiplier, kind = (self.get_parameter(each).value for each in ("base", "multiplier", "type"))
        message = CostmapFilterInfo(type=kind, base=base, multiplier=multiplier)
        message.filter_mask_topic = self.get_parameter("mask_topic").value
        message.header.frame_id, message.header.stamp = "map", self.get_clock().now().to_msg()
        if self._information is not None:
            self._information.publish(message)
        return result

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw the topic."""
        self.get_logger().info("Cleaning up")
        if self._information is not None:
            self.destroy_lifecycle_publisher(self._information)
            self._information = None
        return TransitionCallbackReturn.SUCCESS


def main(args: list[str] | None = None) -> None:
    """Publish until Ctrl-C."""
    spin_program(lambda words: CostmapFilterInfoServer(), args)


if __name__ == "__main__":
    main()
