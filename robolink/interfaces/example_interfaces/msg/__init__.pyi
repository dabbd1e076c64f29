# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.example_interfaces.msg

__all__ = ["Bool", "Byte", "ByteMultiArray", "Char", "Empty", "Float32", "Float32MultiArray", "Float64", "Float64MultiArray", "Int16", "Int16MultiArray", "Int32", "Int32MultiArray", "Int64", "Int64MultiArray", "Int8", "Int8MultiArray", "MultiArrayDimension", "MultiArrayLayout", "String", "UInt16", "UInt16MultiArray", "UInt32", "UInt32MultiArray", "UInt64", "UInt64MultiArray", "UInt8", "UInt8MultiArray", "WString"]

class Bool(robolink.message.Message):
    """One truth value, to try things out with."""
    data: builtins.bool
    def __init__(self, *, data: builtins.bool = ...) -> None: ...
class Byte(robolink.message.Message):
    """One byte, a bytes object of length one, to try things out with."""
    data: builtins.bytes
    def __init__(self, *, data: builtins.bytes = ...) -> None: ...
class ByteMultiArray(robolink.message.Message):
    """Many bytes, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.bytes]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.bytes] = ...) -> None: ...
class Char(robolink.message.Message):
    """One character, as a number from 0 to 255, to try things out with."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class Empty(robolink.message.Message):
    """Nothing: only that it was sent counts."""
    def __init__(self) -> None: ...
class Float32(robolink.message.Message):
    """One floating point number of 32 bits, to try things out with."""
    data: builtins.float
    def __init__(self, *, data: builtins.float = ...) -> None: ...
class Float32MultiArray(robolink.message.Message):
    """Many floating point numbers of 32 bits, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class Float64(robolink.message.Message):
    """One floating point number of 64 bits, to try things out with."""
    data: builtins.float
    def __init__(self, *, data: builtins.float = ...) -> None: ...
class Float64MultiArray(robolink.message.Message):
    """Many floating point numbers of 64 bits, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class Int16(robolink.message.Message):
    """One signed integer of 16 bits, to try things out with."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class Int16MultiArray(robolink.message.Message):
    """Many signed integers of 16 bits, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class Int32(robolink.message.Message):
    """One signed integer of 32 bits, to try things out with."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class Int32MultiArray(robolink.message.Message):
    """Many signed integers of 32 bits, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class Int64(robolink.message.Message):
    """One signed integer of 64 bits, to try things out with."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class Int64MultiArray(robolink.message.Message):
    """Many signed integers of 64 bits, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class Int8(robolink.message.Message):
    """One signed integer of 8 bits, to try things out with."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class Int8MultiArray(robolink.message.Message):
    """Many signed integers of 8 bits, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class MultiArrayDimension(robolink.message.Message):
    """One dimension of an array: its name, its length and its stride.

    The stride is how many elements one step in the next larger dimension takes: the product of this length and all
    that follow.
    """
    label: builtins.str
    size: builtins.int
    stride: builtins.int
    def __init__(self, *, label: builtins.str = ..., size: builtins.int = ..., stride: builtins.int = ...) -> None: ...
class MultiArrayLayout(robolink.message.Message):
    """The dimensions of an array, outermost first, and the number of elements to skip before the first that counts.

    With three dimensions, the element (i, j, k) is ``data[data_offset + dim[1].stride * i + dim[2].stride * j + k]``.
    """
    dim: collections.abc.MutableSequence[robolink.interfaces.example_interfaces.msg.MultiArrayDimension]
    data_offset: builtins.int
    def __init__(self, *, dim: collections.abc.Iterable[robolink.interfaces.example_interfaces.msg.MultiArrayDimension] = ..., data_offset: builtins.int = ...) -> None: ...
class String(robolink.message.Message):
    """One text, to try things out with."""
    data: builtins.str
    def __init__(self, *, data: builtins.str = ...) -> None: ...
class UInt16(robolink.message.Message):
    """One unsigned integer of 16 bits, to try things out with."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class UInt16MultiArray(robolink.message.Message):
    """Many unsigned integers of 16 bits, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class UInt32(robolink.message.Message):
    """One unsigned integer of 32 bits, to try things out with."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class UInt32MultiArray(robolink.message.Message):
    """Many unsigned integers of 32 bits, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class UInt64(robolink.message.Message):
    """One unsigned integer of 64 bits, to try things out with."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class UInt64MultiArray(robolink.message.Message):
    """Many unsigned integers of 64 bits, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class UInt8(robolink.message.Message):
    """One unsigned integer of 8 bits, to try things out with."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class UInt8MultiArray(robolink.message.Message):
    """Many unsigned integers of 8 bits, in as many dimensions as `layout` says."""
    layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.example_interfaces.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class WString(robolink.message.Message):
    """One text, sent as UTF-16."""
    data: builtins.str
    def __init__(self, *, data: builtins.str = ...) -> None: ...
