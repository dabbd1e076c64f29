# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["Dqn", "Goal", "Sound"]

class Dqn(robolink.message.Service):
    """Take one step of the learning robot.

    Number of the action to take; `init` begins anew.
    """
    class Request(robolink.message.Message):
        action: builtins.int
        init: builtins.bool
        def __init__(self, *, action: builtins.int = ..., init: builtins.bool = ...) -> None: ...
    class Response(robolink.message.Message):
        """State that the robot is in, the reward for the step, and whether the episode is over."""
        state: collections.abc.MutableSequence[builtins.float]
        reward: builtins.float
        done: builtins.bool
        def __init__(self, *, state: collections.abc.Iterable[builtins.float] = ..., reward: builtins.float = ..., done: builtins.bool = ...) -> None: ...
class Goal(robolink.message.Service):
    """Choose the next goal of the learning robot.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The goal's place in metres, and whether there is one."""
        pose_x: builtins.float
        pose_y: builtins.float
        success: builtins.bool
        def __init__(self, *, pose_x: builtins.float = ..., pose_y: builtins.float = ..., success: builtins.bool = ...) -> None: ...
class Sound(robolink.message.Service):
    """Make a sound.

    The number of the sound, as in the message Sound.
    """
    class Request(robolink.message.Message):
        value: builtins.int
        def __init__(self, *, value: builtins.int = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and words for people, above all after a failure."""
        success: builtins.bool
        message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., message: builtins.str = ...) -> None: ...
