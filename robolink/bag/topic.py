"""Topics and messages of a bag, and the error of everything that is wrong with one."""

from __future__ import annotations

from typing import NamedTuple

from robolink.bag.selection import SERVICE_EVENT
from robolink.exceptions import RobolinkError
from robolink.qos import QoSProfile


class BagError(RobolinkError, ValueError, RuntimeError):
    """A bag cannot be read or written; the text is one line that names the file. rosbag2_py has RuntimeErrors."""


class BagTopic(NamedTuple):
    """Topic of a bag.

    Args:
        name: Full name, such as `/scan`.
        type_name: Type, such as `std_msgs/msg/String`.
        serialization_format: Encoding of the messages.
        type_hash: Hash of the type (RIHS01_...), '' if unknown.
        offered_qos: Profiles that publishers offered while it was recorded.
        message_definition: Text of the type's definition with all that it uses, '' if unknown.
        definition_encoding: Language of that text: ros2msg or ros2idl.
    """

    name: str
    type_name: str
    serialization_format: str = "cdr"
    type_hash: str = ""
    offered_qos: tuple[QoSProfile, ...] = ()
    message_definition: str = ""
    definition_encoding: str = "ros2msg"

    @property
    def is_service_event(self) -> bool:
        """True for a topic of a service's events, which `bag info` counts apart."""
        return self.name.endswith(SERVICE_EVENT) and self.type_name.endswith("_Event")

    def difference(self, before: BagTopic) -> str:
        """Return how the type differs from that of a topic of the same name in a bag before, in words; '' if not."""
        if self.type_name != before.type_name:
            return f"topic '{self.name}' is a {self.type_name} there, and a {before.type_name} before"
        if self.type_hash and before.type_hash and self.type_hash != before.type_hash:
            return f"topic '{self.name}' is another {self.type_name} there than before"
        return ""


class BagMessage(NamedTuple):
    """Message of a bag: serialized, with the times at which it was received and sent, in nanoseconds since 1970.

    `sequence` is the sender's number of it, 0 where that is not known.
    """

    topic: str
    data: bytes | memoryview
    log_time: int
    publish_time: int
    sequence: int = 0
