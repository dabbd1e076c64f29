"""The messages of diagnostic_msgs: how well each part of a robot is, as published on /diagnostics."""

from typing import ClassVar

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, byte, string


class KeyValue(Message):
    """One thing measured of a part, both its name and its value as text: ``voltage``, ``24.1``."""

    key: string
    value: string


class DiagnosticStatus(Message):
    """State of one part of the robot, say its left motor.

    `level` is OK, WARN, ERROR, or STALE where the part has not been heard of for too long. `name` says which part or
    test it is, `message` what is the matter, in words for people; `hardware_id` tells one piece of hardware from
    others of its kind. `values` has whatever else was measured.
    """

    OK: ClassVar[byte] = b"\x00"
    WARN: ClassVar[byte] = b"\x01"
    ERROR: ClassVar[byte] = b"\x02"
    STALE: ClassVar[byte] = b"\x03"

    level: byte
    name: string
    message: string
    hardware_id: string
    values: Sequence[KeyValue]


class DiagnosticArray(Message):
    """The state of several parts, all seen at the time that the header has."""

    header: Header
    status: Sequence[DiagnosticStatus]
