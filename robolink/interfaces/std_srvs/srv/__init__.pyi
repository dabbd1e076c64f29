# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["Empty", "SetBool", "Trigger"]

class Empty(robolink.message.Service):
    """A call that carries nothing but the fact that it happened.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class SetBool(robolink.message.Service):
    """Switch something on or off.

    On is True.
    """
    class Request(robolink.message.Message):
        data: builtins.bool
        def __init__(self, *, data: builtins.bool = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, and a sentence for people, above all after a failure."""
        success: builtins.bool
        message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., message: builtins.str = ...) -> None: ...
class Trigger(robolink.message.Service):
    """Set something off.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Success, and a sentence for people, above all after a failure."""
        success: builtins.bool
        message: builtins.str
        def __init__(self, *, success: builtins.bool = ..., message: builtins.str = ...) -> None: ...
