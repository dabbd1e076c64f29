"""The names of `robolink.endpoint_info` that rclpy had in this module until Lyrical."""

from robolink.endpoint_info import EndpointTypeEnum as TopicEndpointTypeEnum
from robolink.endpoint_info import TopicEndpointInfo

__all__ = ["TopicEndpointInfo", "TopicEndpointTypeEnum"]
