# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["Fibonacci"]

class Fibonacci(robolink.message.Action):
    """Compute Fibonacci numbers, slowly.

    Index of the last number, where the sequence begins 0, 1, 1, 2.
    """
    class Goal(robolink.message.Message):
        order: builtins.int
        def __init__(self, *, order: builtins.int = ...) -> None: ...
    class Result(robolink.message.Message):
        """All numbers."""
        sequence: collections.abc.MutableSequence[builtins.int]
        def __init__(self, *, sequence: collections.abc.Iterable[builtins.int] = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The numbers so far."""
        partial_sequence: collections.abc.MutableSequence[builtins.int]
        def __init__(self, *, partial_sequence: collections.abc.Iterable[builtins.int] = ...) -> None: ...
