"""The services of rosbag2_interfaces: remote control for players and recorders of bags."""

from robolink.interfaces.builtin_interfaces.msg import Duration, Time
from robolink.message import Message, Service, float64, uint64


class Play(Service):
    """Start playing the bag of a player."""

    class Request(Message):
        """From where, and how far.

        `start_offset` and `playback_duration` are spans of time, though their type is Time: seconds and nanoseconds
        from the start of the bag. The playing ends after the duration or at `playback_until_timestamp`, whichever
        comes first; a negative value of either sets no end.
        """

        start_offset: Time
        playback_duration: Duration
        playback_until_timestamp: Time

    class Response(Message):
        """False when the player is playing already."""

        success: bool


class PlayNext(Service):
    """Play one message, in a paused player."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """False when the player is not paused."""

        success: bool


class Burst(Service):
    """Play messages as fast as possible, in a paused player."""

    class Request(Message):
        """Number of messages; 0 is all."""

        num_messages: uint64

    class Response(Message):
        """Number of messages that were played."""

        actually_burst: uint64


class Pause(Service):
    """Pause playing, or recording."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""


class Resume(Service):
    """Go on playing, or recording."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""


class TogglePaused(Service):
    """Pause, or go on after a pause."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""


class IsPaused(Service):
    """Ask whether there is a pause."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """True while there is."""

        paused: bool


class Stop(Service):
    """Stop playing."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""


class Seek(Service):
    """Move a player to another point of its bag."""

    class Request(Message):
        """The time, as the bag's messages have it."""

        time: Time

    class Response(Message):
        """False when the bag has no such time."""

        success: bool


class GetRate(Service):
    """Ask how fast a player plays."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """1.0 is as fast as it was recorded."""

        rate: float64


class SetRate(Service):
    """Set how fast a player plays."""

    class Request(Message):
        """1.0 is as fast as it was recorded."""

        rate: float64

    class Response(Message):
        """False for a rate that is not above 0."""

        success: bool


class Snapshot(Service):
    """Write down the messages that a recorder keeps in memory."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """True if that worked."""

        success: bool


class SplitBagfile(Service):
    """Begin the next file of a recording."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""
