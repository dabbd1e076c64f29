# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["Bool", "Byte", "ByteMultiArray", "Char", "ColorRGBA", "Empty", "Float32", "Float32MultiArray", "Float64", "Float64MultiArray", "Header", "Int16", "Int16MultiArray", "Int32", "Int32MultiArray", "Int64", "Int64MultiArray", "Int8", "Int8MultiArray", "MultiArrayDimension", "MultiArrayLayout", "String", "UInt16", "UInt16MultiArray", "UInt32", "UInt32MultiArray", "UInt64", "UInt64MultiArray", "UInt8", "UInt8MultiArray"]

class Bool(robolink.message.Message):
    """True or false."""
    data: builtins.bool
    def __init__(self, *, data: builtins.bool = ...) -> None: ...
class Byte(robolink.message.Message):
    """One opaque octet: a bytes object of length one."""
    data: builtins.bytes
    def __init__(self, *, data: builtins.bytes = ...) -> None: ...
class ByteMultiArray(robolink.message.Message):
    """An array of opaque octets, each a bytes object of length one."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.bytes]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.bytes] = ...) -> None: ...
class Char(robolink.message.Message):
    """One character code, 0 to 255."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class ColorRGBA(robolink.message.Message):
    """A colour: red, green, blue and opacity, each from 0.0 to 1.0 (opaque)."""
    r: builtins.float
    g: builtins.float
    b: builtins.float
    a: builtins.float
    def __init__(self, *, r: builtins.float = ..., g: builtins.float = ..., b: builtins.float = ..., a: builtins.float = ...) -> None: ...
class Empty(robolink.message.Message):
    """Nothing: that it arrived is all it says."""
    def __init__(self) -> None: ...
class Float32(robolink.message.Message):
    """A number in single precision."""
    data: builtins.float
    def __init__(self, *, data: builtins.float = ...) -> None: ...
class Float32MultiArray(robolink.message.Message):
    """An array of numbers in single precision."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class Float64(robolink.message.Message):
    """A number in double precision."""
    data: builtins.float
    def __init__(self, *, data: builtins.float = ...) -> None: ...
class Float64MultiArray(robolink.message.Message):
    """An array of numbers in double precision."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.float]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.float] = ...) -> None: ...
class Header(robolink.message.Message):
    """When and where: the time that the data stand for, and the name of the frame that they are given in."""
    stamp: robolink.interfaces.builtin_interfaces.msg.Time
    frame_id: builtins.str
    def __init__(self, *, stamp: robolink.interfaces.builtin_interfaces.msg.Time = ..., frame_id: builtins.str = ...) -> None: ...
class Int16(robolink.message.Message):
    """A whole number from -32,768 to 32,767."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class Int16MultiArray(robolink.message.Message):
    """An array of int16."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class Int32(robolink.message.Message):
    """A whole number of 32 bits with sign."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class Int32MultiArray(robolink.message.Message):
    """An array of int32."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class Int64(robolink.message.Message):
    """A whole number of 64 bits with sign."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class Int64MultiArray(robolink.message.Message):
    """An array of int64."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class Int8(robolink.message.Message):
    """A whole number from -128 to 127."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class Int8MultiArray(robolink.message.Message):
    """An array of int8."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class MultiArrayDimension(robolink.message.Message):
    """One axis of an array: its name, its length, and the stride.

    The stride is the length of this axis times that of all inner ones: the number of elements from one index
    of the next outer axis to the following.
    """
    label: builtins.str
    size: builtins.int
    stride: builtins.int
    def __init__(self, *, label: builtins.str = ..., size: builtins.int = ..., stride: builtins.int = ...) -> None: ...
class MultiArrayLayout(robolink.message.Message):
    """Layout of the flat data of a multi-dimensional array; the outermost axis stands first.

    With three axes element (i, j, k) is ``data[data_offset + dim[1].stride * i + dim[2].stride * j + k]``.
    """
    dim: collections.abc.MutableSequence[robolink.interfaces.std_msgs.msg.MultiArrayDimension]
    data_offset: builtins.int
    def __init__(self, *, dim: collections.abc.Iterable[robolink.interfaces.std_msgs.msg.MultiArrayDimension] = ..., data_offset: builtins.int = ...) -> None: ...
class String(robolink.message.Message):
    """A text in UTF-8."""
    data: builtins.str
    def __init__(self, *, data: builtins.str = ...) -> None: ...
class UInt16(robolink.message.Message):
    """A whole number from 0 to 65,535."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class UInt16MultiArray(robolink.message.Message):
    """An array of uint16."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class UInt32(robolink.message.Message):
    """A whole number of 32 bits without sign."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class UInt32MultiArray(robolink.message.Message):
    """An array of uint32."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class UInt64(robolink.message.Message):
    """A whole number of 64 bits without sign."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class UInt64MultiArray(robolink.message.Message):
    """An array of uint64."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class UInt8(robolink.message.Message):
    """A whole number from 0 to 255."""
    data: builtins.int
    def __init__(self, *, data: builtins.int = ...) -> None: ...
class UInt8MultiArray(robolink.message.Message):
    """An array of uint8."""
    layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout
    data: collections.abc.MutableSequence[builtins.int]
    def __init__(self, *, layout: robolink.interfaces.std_msgs.msg.MultiArrayLayout = ..., data: collections.abc.Iterable[builtins.int] = ...) -> None: ...
