# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["TypeDef"]

class TypeDef(robolink.message.Message):
    """Definition of a message type: names, types and example values of its fields, and its constants.

    The length of a field is -1 for a single value, 0 for a sequence, and the size of a fixed array.
    """
    type: builtins.str
    fieldnames: collections.abc.MutableSequence[builtins.str]
    fieldtypes: collections.abc.MutableSequence[builtins.str]
    fieldarraylen: collections.abc.MutableSequence[builtins.int]
    examples: collections.abc.MutableSequence[builtins.str]
    constnames: collections.abc.MutableSequence[builtins.str]
    constvalues: collections.abc.MutableSequence[builtins.str]
    def __init__(self, *, type: builtins.str = ..., fieldnames: collections.abc.Iterable[builtins.str] = ..., fieldtypes: collections.abc.Iterable[builtins.str] = ..., fieldarraylen: collections.abc.Iterable[builtins.int] = ..., examples: collections.abc.Iterable[builtins.str] = ..., constnames: collections.abc.Iterable[builtins.str] = ..., constvalues: collections.abc.Iterable[builtins.str] = ...) -> None: ...
