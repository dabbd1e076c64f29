# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["ReadSplitEvent", "WriteSplitEvent"]

class ReadSplitEvent(robolink.message.Message):
    """A player has finished one file of a bag and opened the next: both paths, and the player's node."""
    closed_file: builtins.str
    opened_file: builtins.str
    node_name: builtins.str
    def __init__(self, *, closed_file: builtins.str = ..., opened_file: builtins.str = ..., node_name: builtins.str = ...) -> None: ...
class WriteSplitEvent(robolink.message.Message):
    """A recorder has closed one file of a bag and begun the next: both paths, and the recorder's node."""
    closed_file: builtins.str
    opened_file: builtins.str
    node_name: builtins.str
    def __init__(self, *, closed_file: builtins.str = ..., opened_file: builtins.str = ..., node_name: builtins.str = ...) -> None: ...
