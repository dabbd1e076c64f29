# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["UUID"]

class UUID(robolink.message.Message):
    """The 16 bytes of an RFC 4122 UUID, in the order in which its text has them: ``UUID(uuid=uuid4().bytes)``."""
    uuid: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, uuid: collections.abc.Iterable[builtins.int] = ...) -> None: ...
