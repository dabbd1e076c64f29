"""The message of can_msgs."""

from typing import Annotated

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, Size, uint8, uint32


class Frame(Message):
    """A frame on a CAN bus; of `data` the first `dlc` bytes count.

    `is_rtr` marks a request for data, `is_extended` an identifier of 29 bits, `is_error` an error frame.
    """

    header: Header
    id: uint32
    is_rtr: bool
    is_extended: bool
    is_error: bool
    dlc: uint8
    data: Annotated[Sequence[uint8], Size(8)]
