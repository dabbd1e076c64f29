# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["FrameGraph"]

class FrameGraph(robolink.message.Service):
    """Ask a transform buffer for all frames that it knows.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """The frames as YAML: a mapping of each frame to its parent and what is known of the link."""
        frame_yaml: builtins.str
        def __init__(self, *, frame_yaml: builtins.str = ...) -> None: ...
