# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["Kill", "SetPen", "Spawn", "TeleportAbsolute", "TeleportRelative"]

class Kill(robolink.message.Service):
    """Take a turtle away.

    The turtle's name.
    """
    class Request(robolink.message.Message):
        name: builtins.str
        def __init__(self, *, name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class SetPen(robolink.message.Service):
    """Change the line that a turtle draws.

    Colour from 0 to 255, width in pixels; a turtle with `off` above 0 draws nothing.
    """
    class Request(robolink.message.Message):
        r: builtins.int
        g: builtins.int
        b: builtins.int
        width: builtins.int
        off: builtins.int
        def __init__(self, *, r: builtins.int = ..., g: builtins.int = ..., b: builtins.int = ..., width: builtins.int = ..., off: builtins.int = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class Spawn(robolink.message.Service):
    """Make a new turtle.

    Where, in metres and radians, and its name; an empty name lets the simulator choose one.
    """
    class Request(robolink.message.Message):
        x: builtins.float
        y: builtins.float
        theta: builtins.float
        name: builtins.str
        def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., theta: builtins.float = ..., name: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The turtle's name."""
        name: builtins.str
        def __init__(self, *, name: builtins.str = ...) -> None: ...
class TeleportAbsolute(robolink.message.Service):
    """Put a turtle elsewhere.

    Where, in metres and radians.
    """
    class Request(robolink.message.Message):
        x: builtins.float
        y: builtins.float
        theta: builtins.float
        def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., theta: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class TeleportRelative(robolink.message.Service):
    """Move a turtle at once.

    First it turns by `angular` radians, then it goes `linear` metres ahead.
    """
    class Request(robolink.message.Message):
        linear: builtins.float
        angular: builtins.float
        def __init__(self, *, linear: builtins.float = ..., angular: builtins.float = ...) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
