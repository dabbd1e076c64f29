"""RTPS 2.x participant in pure Python, the protocol of DDS: it carries serialized samples and knows nothing of ROS."""

from robolink.rtps.ids import RtpsError
from robolink.rtps.participant import Participant, Reader, Writer
from robolink.rtps.reach import Range, Reach, ReachError
from robolink.rtps.types import Endpoint, Info, Peer, Qos

__all__ = [
    "Endpoint",
    "Info",
    "Participant",
    "Peer",
    "Qos",
    "Range",
    "Reach",
    "ReachError",
    "Reader",
    "RtpsError",
    "Writer",
]
