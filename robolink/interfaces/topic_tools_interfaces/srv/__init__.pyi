# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["DemuxAdd", "DemuxDelete", "DemuxList", "DemuxSelect", "MuxAdd", "MuxDelete", "MuxList", "MuxSelect"]

class DemuxAdd(robolink.message.Service):
    """Add a topic that messages may be passed on to.

    The topic's name.
    """
    class Request(robolink.message.Message):
        topic: builtins.str
        def __init__(self, *, topic: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class DemuxDelete(robolink.message.Service):
    """Remove a topic that messages may be passed on to.

    The topic's name.
    """
    class Request(robolink.message.Message):
        topic: builtins.str
        def __init__(self, *, topic: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class DemuxList(robolink.message.Service):
    """List the topics that messages may be passed on to.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Names of the topics."""
        topics: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, topics: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class DemuxSelect(robolink.message.Service):
    """Choose the topic that messages are passed on to.

    The topic; `__none` for none.
    """
    class Request(robolink.message.Message):
        topic: builtins.str
        def __init__(self, *, topic: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The topic chosen before, and success."""
        prev_topic: builtins.str
        success: builtins.bool
        def __init__(self, *, prev_topic: builtins.str = ..., success: builtins.bool = ...) -> None: ...
class MuxAdd(robolink.message.Service):
    """Add a topic to choose from.

    The topic's name.
    """
    class Request(robolink.message.Message):
        topic: builtins.str
        def __init__(self, *, topic: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class MuxDelete(robolink.message.Service):
    """Remove a topic from those to choose from.

    The topic's name.
    """
    class Request(robolink.message.Message):
        topic: builtins.str
        def __init__(self, *, topic: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success."""
        success: builtins.bool
        def __init__(self, *, success: builtins.bool = ...) -> None: ...
class MuxList(robolink.message.Service):
    """List the topics to choose from.

    Nothing.
    """
    class Request(robolink.message.Message):
        def __init__(self) -> None: ...
    class Response(robolink.message.Message):
        """Names of the topics."""
        topics: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, topics: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class MuxSelect(robolink.message.Service):
    """Choose the topic whose messages are passed on.

    The topic; `__none` for none.
    """
    class Request(robolink.message.Message):
        topic: builtins.str
        def __init__(self, *, topic: builtins.str = ...) -> None: ...
    class Response(robolink.message.Message):
        """The topic chosen before, and success."""
        prev_topic: builtins.str
        success: builtins.bool
        def __init__(self, *, prev_topic: builtins.str = ..., success: builtins.bool = ...) -> None: ...
