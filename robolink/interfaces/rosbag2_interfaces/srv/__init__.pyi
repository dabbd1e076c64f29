# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg

__all__ = ["Burst", "GetRate", "IsDiscoveryRunning", "IsPaused", "Pause", "Play", "PlayNext", "Record", "Resume", "Seek", "SetRate", "Snapshot", "SplitBagfile", "StartDiscovery", "Stop", "StopDiscovery", "TogglePaused"]

class Burst(robolink.message.Service):
    """Play messages as fast as possible, in a paused player.

    Number of messages; 0 is all.
    """
    class Request(robolink.message.Message):
        num_messages: builtins.int
        def __init__(self, *, num_messages: builtins.int = ...) -> None: ...
    class Response(robolink.message.Message):
        """Number of messages that were played."""
        actually_burst: builtins.int
        def __init__(self, *, actually_burst: builtins.int = ...) -> None: ...
class GetRate(robolink.message.Service):
    """Ask how fast a player plays.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """1.0 is as fast as it was recorded."""
        rate: builtins.float
        def __init__(self, *, rate: builtins.float = ...) -> None: ...
class IsDiscoveryRunning(robolink.message.Service):
    """Whether topics that appear are recorded, too.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """True if they are."""
        running: builtins.bool
        def __init__(self, *, running: builtins.bool = ...) -> None: ...
class IsPaused(robolink.message.Service):
    """Ask whether there is a pause.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """True while there is."""
        paused: builtins.bool
        def __init__(self, *, paused: builtins.bool = ...) -> None: ...
class Pause(robolink.message.Service):
    """Pause playing, or recording.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class Play(robolink.message.Service):
    """Start playing the bag of a player.

    From where, and how far.

    `start_offset` and `playback_duration` are spans of time, though their type is Time: seconds and nanoseconds
    from the start of the bag. The playing ends after the duration or at `playback_until_timestamp`, whichever
    comes first; a negative value of either sets no end.
    """
    class Request(robolink.message.Message):
        start_offset: robolink.interfaces.builtin_interfaces.msg.Time
        playback_duration: robolink.interfaces.builtin_interfaces.msg.Duration
        playback_until_timestamp: robolink.interfaces.builtin_interfaces.msg.Time
        def __init__(self, *, start_offset: robolink.interfaces.builtin_interfaces.msg.Time = ..., playback_duration: robolink.interfaces.builtin_interfaces.msg.Duration = ..., playback_until_timestamp: robolink.interfaces.builtin_interfaces.msg.Time = ...) -> None: ...
    class Response(robolink.message.Message):
        """False when the player is playing already."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class PlayNext(robolink.message.Service):
    """Play one message, in a paused player.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """False when the player is not paused."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class Record(robolink.message.Service):
    """Start a recording, in a recorder that has stopped.

    Folder of the bag; an empty one takes that of the recorder's options.
    """
    class Request(robolink.message.Message):
        uri: builtins.str
        def __init__(self, *, uri: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Outcome: 0, or 1 where it records already or cannot, and why, for people."""
        return_code: builtins.int
        error_string: builtins.str
        def __init__(self, *, return_code: builtins.int = ..., error_string: builtins.str = ...) -> None: ...
class Resume(robolink.message.Service):
    """Go on playing, or recording.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class Seek(robolink.message.Service):
    """Move a player to another point of its bag.

    The time, as the bag's messages have it.
    """
    class Request(robolink.message.Message):
        time: robolink.interfaces.builtin_interfaces.msg.Time
        def __init__(self, *, time: robolink.interfaces.builtin_interfaces.msg.Time = ...) -> None: ...
    class Response(robolink.message.Message):
        """False when the bag has no such time."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class SetRate(robolink.message.Service):
    """Set how fast a player plays.

    1.0 is as fast as it was recorded.
    """
    class Request(robolink.message.Message):
        rate: builtins.float
        def __init__(self, *, rate: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """False for a rate that is not above 0."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class Snapshot(robolink.message.Service):
    """Write down the messages that a recorder keeps in memory.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """True if that worked."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class SplitBagfile(robolink.message.Service):
    """Begin the next file of a recording.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class StartDiscovery(robolink.message.Service):
    """Record topics that appear from now on, too.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Outcome: 0, or 1 where nothing is recorded or it does so already, and why, for people."""
        return_code: builtins.int
        error_string: builtins.str
        def __init__(self, *, return_code: builtins.int = ..., error_string: builtins.str = ...) -> None: ...
class Stop(robolink.message.Service):
    """Stop playing.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class StopDiscovery(robolink.message.Service):
    """Record no topics but those that are there.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Outcome: 0, or 1 where it does so already, and why, for people."""
        return_code: builtins.int
        error_string: builtins.str
        def __init__(self, *, return_code: builtins.int = ..., error_string: builtins.str = ...) -> None: ...
class TogglePaused(robolink.message.Service):
    """Pause, or go on after a pause.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
