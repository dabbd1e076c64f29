"""The messages of std_msgs: the header, and single values and arrays of each primitive type."""

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.message import (
    Message,
    Sequence,
    byte,
    char,
    float32,
    float64,
    int8,
    int16,
    int32,
    int64,
    string,
    uint8,
    uint16,
    uint32,
    uint64,
)


class Header(Message):
    """When and where: the time that the data stand for, and the name of the frame that they are given in."""

    stamp: Time
    frame_id: string


class Empty(Message):
    """Nothing: that it arrived is all it says."""


class Bool(Message):
    """True or false."""

    data: bool


class Byte(Message):
    """One opaque octet: a bytes object of length one."""

    data: byte


class Char(Message):
    """One character code, 0 to 255."""

    data: char


class String(Message):
    """A text in UTF-8."""

    data: string


class Int8(Message):
    """A whole number from -128 to 127."""

    data: int8


class Int16(Message):
    """A whole number from -32,768 to 32,767."""

    data: int16


class Int32(Message):
    """A whole number of 32 bits with sign."""

    data: int32


class Int64(Message):
    """A whole number of 64 bits with sign."""

    data: int64


class UInt8(Message):
    """A whole number from 0 to 255."""

    data: uint8


class UInt16(Message):
    """A whole number from 0 to 65,535."""

    data: uint16


class UInt32(Message):
    """A whole number of 32 bits without sign."""

    data: uint32


class UInt64(Message):
    """A whole number of 64 bits without sign."""

    data: uint64


class Float32(Message):
    """A number in single precision."""

    data: float32


class Float64(Message):
    """A number in double precision."""

    data: float64


class ColorRGBA(Message):
    """A colour: red, green, blue and opacity, each from 0.0 to 1.0 (opaque)."""

    r: float32
    g: float32
    b: float32
    a: float32


class MultiArrayDimension(Message):
    """One axis of an array: its name, its length, and the stride.

    The stride is the length of this axis times that of all inner ones: the number of elements from one index
    of the next outer axis to the following.
    """

    label: string
    size: uint32
    stride: uint32


class MultiArrayLayout(Message):
    """Layout of the flat data of a multi-dimensional array; the outermost axis stands first.

    With three axes element (i, j, k) is ``data[data_offset + dim[1].stride * i + dim[2].stride * j + k]``.
    """

    dim: Sequence[MultiArrayDimension]
    data_offset: uint32


class ByteMultiArray(Message):
    """An array of opaque octets, each a bytes object of length one."""

    layout: MultiArrayLayout
    data: Sequence[byte]


class Int8MultiArray(Message):
    """An array of int8."""

    layout: MultiArrayLayout
    data: Sequence[int8]


class Int16MultiArray(Message):
    """An array of int16."""

    layout: MultiArrayLayout
    data: Sequence[int16]


class Int32MultiArray(Message):
    """An array of int32."""

    layout: MultiArrayLayout
    data: Sequence[int32]


class Int64MultiArray(Message):
    """An array of int64."""

    layout: MultiArrayLayout
    data: Sequence[int64]


class UInt8MultiArray(Message):
    """An array of uint8."""

    layout: MultiArrayLayout
    data: Sequence[uint8]


class UInt16MultiArray(Message):
    """An array of uint16."""

    layout: MultiArrayLayout
    data: Sequence[uint16]


class UInt32MultiArray(Message):
    """An array of uint32."""

    layout: MultiArrayLayout
    data: Sequence[uint32]


class UInt64MultiArray(Message):
    """An array of uint64."""

    layout: MultiArrayLayout
    data: Sequence[uint64]


class Float32MultiArray(Message):
    """An array of numbers in single precision."""

    layout: MultiArrayLayout
    data: Sequence[float32]


class Float64MultiArray(Message):
    """An array of numbers in double precision."""

    layout: MultiArrayLayout
    data: Sequence[float64]
