"""The messages of example_interfaces: one value of each primitive type, and arrays of them, to try things out with."""

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
    wstring,
)


class Bool(Message):
    """One truth value, to try things out with."""

    data: bool


class Byte(Message):
    """One byte, a bytes object of length one, to try things out with."""

    data: byte


class Char(Message):
    """One character, as a number from 0 to 255, to try things out with."""

    data: char


class Empty(Message):
    """Nothing: only that it was sent counts."""


class Float32(Message):
    """One floating point number of 32 bits, to try things out with."""

    data: float32


class Float64(Message):
    """One floating point number of 64 bits, to try things out with."""

    data: float64


class Int8(Message):
    """One signed integer of 8 bits, to try things out with."""

    data: int8


class Int16(Message):
    """One signed integer of 16 bits, to try things out with."""

    data: int16


class Int32(Message):
    """One signed integer of 32 bits, to try things out with."""

    data: int32


class Int64(Message):
    """One signed integer of 64 bits, to try things out with."""

    data: int64


class UInt8(Message):
    """One unsigned integer of 8 bits, to try things out with."""

    data: uint8


class UInt16(Message):
    """One unsigned integer of 16 bits, to try things out with."""

    data: uint16


class UInt32(Message):
    """One unsigned integer of 32 bits, to try things out with."""

    data: uint32


class UInt64(Message):
    """One unsigned integer of 64 bits, to try things out with."""

    data: uint64


class String(Message):
    """One text, to try things out with."""

    data: string


class WString(Message):
    """One text, sent as UTF-16."""

    data: wstring


class MultiArrayDimension(Message):
    """One dimension of an array: its name, its length and its stride.

    The stride is how many elements one step in the next larger dimension takes: the product of this length and all
    that follow.
    """

    label: string
    size: uint32
    stride: uint32


class MultiArrayLayout(Message):
    """The dimensions of an array, outermost first, and the number of elements to skip before the first that counts.

    With three dimensions, the element (i, j, k) is ``data[data_offset + dim[1].stride * i + dim[2].stride * j + k]``.
    """

    dim: Sequence[MultiArrayDimension]
    data_offset: uint32


class ByteMultiArray(Message):
    """Many bytes, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[byte]


class Float32MultiArray(Message):
    """Many floating point numbers of 32 bits, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[float32]


class Float64MultiArray(Message):
    """Many floating point numbers of 64 bits, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[float64]


class Int8MultiArray(Message):
    """Many signed integers of 8 bits, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[int8]


class Int16MultiArray(Message):
    """Many signed integers of 16 bits, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[int16]


class Int32MultiArray(Message):
    """Many signed integers of 32 bits, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[int32]


class Int64MultiArray(Message):
    """Many signed integers of 64 bits, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[int64]


class UInt8MultiArray(Message):
    """Many unsigned integers of 8 bits, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[uint8]


class UInt16MultiArray(Message):
    """Many unsigned integers of 16 bits, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[uint16]


class UInt32MultiArray(Message):
    """Many unsigned integers of 32 bits, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[uint32]


class UInt64MultiArray(Message):
    """Many unsigned integers of 64 bits, in as many dimensions as `layout` says."""

    layout: MultiArrayLayout
    data: Sequence[uint64]
