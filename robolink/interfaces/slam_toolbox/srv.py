"""The services of slam_toolbox: maps and pose graphs in files, and control of mapping."""

from typing import ClassVar

from robolink.interfaces.geometry_msgs.msg import Pose2D
from robolink.interfaces.std_msgs.msg import String
from robolink.message import Message, Service, int8, string, uint8


class SaveMap(Service):
    """Save the map in files."""

    class Request(Message):
        """The files' name without ending; an empty one takes the usual."""

        name: String

    class Response(Message):
        """Outcome: RESULT_SUCCESS or the kind of failure."""

        RESULT_SUCCESS: ClassVar[uint8] = 0
        RESULT_NO_MAP_RECEIEVD: ClassVar[uint8] = 1
        RESULT_UNDEFINED_FAILURE: ClassVar[uint8] = 255

        result: uint8


class SerializePoseGraph(Service):
    """Save the pose graph, so that mapping can go on from it later."""

    class Request(Message):
        """The file's name without ending."""

        filename: string

    class Response(Message):
        """Outcome: RESULT_SUCCESS or the kind of failure."""

        RESULT_SUCCESS: ClassVar[uint8] = 0
        RESULT_FAILED_TO_WRITE_FILE: ClassVar[uint8] = 255

        result: uint8


class DeserializePoseGraph(Service):
    """Go on from a pose graph that was saved."""

    class Request(Message):
        """The file's name without ending, and where the robot is.

        It is at the first node, at the pose, or near the pose and only localizes itself from there on.
        """

        UNSET: ClassVar[int8] = 0
        START_AT_FIRST_NODE: ClassVar[int8] = 1
        START_AT_GIVEN_POSE: ClassVar[int8] = 2
        LOCALIZE_AT_POSE: ClassVar[int8] = 3

        filename: string
        match_type: int8
        initial_pose: Pose2D

    class Response(Message):
        """Nothing."""


class AddSubmap(Service):
    """Add a saved map to those that are merged."""

    class Request(Message):
        """The file's name without ending."""

        filename: string

    class Response(Message):
        """Nothing."""


class MergeMaps(Service):
    """Merge the maps that were added."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""


class Pause(Service):
    """Pause new measurements, or go on."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """True if that worked."""

        status: bool


class Reset(Service):
    """Begin with an empty map."""

    class Request(Message):
        """True pauses new measurements after that."""

        pause_new_measurements: bool = False

    class Response(Message):
        """Outcome: RESULT_SUCCESS."""

        RESULT_SUCCESS: ClassVar[uint8] = 0

        result: uint8


class Clear(Service):
    """Forget the changes that were made by hand and are not saved."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""


class ClearQueue(Service):
    """Forget the scans that wait to be used."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """True if that worked."""

        status: bool


class LoopClosure(Service):
    """Accept the changes of the pose graph that were made by hand."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""


class ToggleInteractive(Service):
    """Switch changing the pose graph by hand on or off."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""
