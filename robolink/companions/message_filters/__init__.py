"""Message filters: a topic, a cache of its latest messages, or synchronized messages of several topics.

Names and rules are those of ROS 2's message_filters::

    image, info = Subscriber(node, Image, "image"), Subscriber(node, CameraInfo, "camera_info")
    both = ApproximateTimeSynchronizer([image, info], queue_size=10, slop=0.05)
    both.registerCallback(on_image)  # on_image(image, info)
"""

from robolink.companions.message_filters.delta_filter import (
    ComparisonFilter,
    ComparisonHandler,
    DeltaCompare,
    DeltaFilter,
    PathDeltaFilter,
)
from robolink.companions.message_filters.filters import Cache, Chain, Subscriber
from robolink.companions.message_filters.input_aligner import InputAligner
from robolink.companions.message_filters.message_traits import get_time_from_message_header
from robolink.companions.message_filters.simple_filter import SimpleFilter
from robolink.companions.message_filters.synchronizers import ApproximateTimeSynchronizer, TimeSynchronizer
from robolink.companions.message_filters.time_sequencer import TimeSequencer

__all__ = [
    "ApproximateTimeSynchronizer",
    "Cache",
    "Chain",
    "ComparisonFilter",
    "ComparisonHandler",
    "DeltaCompare",
    "DeltaFilter",
    "InputAligner",
    "PathDeltaFilter",
    "SimpleFilter",
    "Subscriber",
    "TimeSequencer",
    "TimeSynchronizer",
    "get_time_from_message_header",
]
