# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["AddTwoInts", "SetBool", "Trigger"]

class AddTwoInts(robolink.message.Service):
    """Add two numbers.

    The numbers.
    """
    class Request(robolink.message.Message):
        a: builtins.int
        b: builtins.int
        def __init__(self, *, a: builtins.int = ..., b: builtins.int = ...) -> None: ...
    class Response(robolink.message.Message):
        """Their sum."""
        sum: builtins.int
        def __init__(self, *, sum: builtins.int = ...) -> None: ...
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
