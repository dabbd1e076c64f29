"""The message of service_msgs: one step of a service call."""

from typing import Annotated, ClassVar

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.message import Message, Sequence, Size, char, int64, uint8


class ServiceEventInfo(Message):
    """Which step of which call an event tells of.

    `client_gid` and `sequence_number` together identify the call as long as the client lives; `stamp` is when
    the request or response was sent or received.
    """

    REQUEST_SENT: ClassVar[uint8] = 0
    REQUEST_RECEIVED: ClassVar[uint8] = 1
    RESPONSE_SENT: ClassVar[uint8] = 2
    RESPONSE_RECEIVED: ClassVar[uint8] = 3

    event_type: uint8
    stamp: Time
    client_gid: Annotated[Sequence[char], Size(16)]
    sequence_number: int64
