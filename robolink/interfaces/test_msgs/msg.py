"""The messages of test_msgs: one of everything that a message can be made of, for tests."""

from typing import Annotated, ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration, Time
from robolink.message import (
    AtMost,
    Message,
    Sequence,
    Size,
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


class Empty(Message):
    """No fields."""


class BasicTypes(Message):
    """One field of each primitive type."""

    bool_value: bool
    byte_value: byte
    char_value: char
    float32_value: float32
    float64_value: float64
    int8_value: int8
    uint8_value: uint8
    int16_value: int16
    uint16_value: uint16
    int32_value: int32
    uint32_value: uint32
    int64_value: int64
    uint64_value: uint64


class Builtins(Message):
    """A duration and a time."""

    duration_value: Duration
    time_value: Time


class Constants(Message):
    """Only constants."""

    BOOL_CONST: ClassVar[bool] = True
    BYTE_CONST: ClassVar[byte] = b"2"
    CHAR_CONST: ClassVar[char] = 100
    FLOAT32_CONST: ClassVar[float32] = 1.125
    FLOAT64_CONST: ClassVar[float64] = 1.125
    INT8_CONST: ClassVar[int8] = -50
    UINT8_CONST: ClassVar[uint8] = 200
    INT16_CONST: ClassVar[int16] = -1000
    UINT16_CONST: ClassVar[uint16] = 2000
    INT32_CONST: ClassVar[int32] = -30000
    UINT32_CONST: ClassVar[uint32] = 60000
    INT64_CONST: ClassVar[int64] = -40000000
    UINT64_CONST: ClassVar[uint64] = 50000000


class Defaults(Message):
    """Each primitive type, with a default other than zero."""

    bool_value: bool = True
    byte_value: byte = b"2"
    char_value: char = 100
    float32_value: float32 = 1.125
    float64_value: float64 = 1.125
    int8_value: int8 = -50
    uint8_value: uint8 = 200
    int16_value: int16 = -1000
    uint16_value: uint16 = 2000
    int32_value: int32 = -30000
    uint32_value: uint32 = 60000
    int64_value: int64 = -40000000
    uint64_value: uint64 = 50000000


class Nested(Message):
    """A message in a message."""

    basic_types_value: BasicTypes


class Strings(Message):
    """Text, with and without a bound (in bytes), with quotes in the defaults."""

    STRING_CONST: ClassVar[string] = "Hello world!"

    string_value: string
    string_value_default1: string = "Hello world!"
    string_value_default2: string = "Hello'world!"
    string_value_default3: string = 'Hello"world!'
    string_value_default4: string = "Hello'world!"
    string_value_default5: string = 'Hello"world!'
    bounded_string_value: Annotated[string, AtMost(22)]
    bounded_string_value_default1: Annotated[string, AtMost(22)] = "Hello world!"
    bounded_string_value_default2: Annotated[string, AtMost(22)] = "Hello'world!"
    bounded_string_value_default3: Annotated[string, AtMost(22)] = 'Hello"world!'
    bounded_string_value_default4: Annotated[string, AtMost(22)] = "Hello'world!"
    bounded_string_value_default5: Annotated[string, AtMost(22)] = 'Hello"world!'


class WStrings(Message):
    """Text in UTF-16, alone and in each kind of sequence."""

    wstring_value: wstring
    wstring_value_default1: wstring = "Hello world!"
    wstring_value_default2: wstring = "Hellö wörld!"
    wstring_value_default3: wstring = "ハローワールド"
    array_of_wstrings: Annotated[Sequence[wstring], Size(3)]
    bounded_sequence_of_wstrings: Annotated[Sequence[wstring], AtMost(3)]
    unbounded_sequence_of_wstrings: Sequence[wstring]


class Arrays(Message):
    """Three of each primitive type and of some messages."""

    bool_values: Annotated[Sequence[bool], Size(3)]
    byte_values: Annotated[Sequence[byte], Size(3)]
    char_values: Annotated[Sequence[char], Size(3)]
    float32_values: Annotated[Sequence[float32], Size(3)]
    float64_values: Annotated[Sequence[float64], Size(3)]
    int8_values: Annotated[Sequence[int8], Size(3)]
    uint8_values: Annotated[Sequence[uint8], Size(3)]
    int16_values: Annotated[Sequence[int16], Size(3)]
    uint16_values: Annotated[Sequence[uint16], Size(3)]
    int32_values: Annotated[Sequence[int32], Size(3)]
    uint32_values: Annotated[Sequence[uint32], Size(3)]
    int64_values: Annotated[Sequence[int64], Size(3)]
    uint64_values: Annotated[Sequence[uint64], Size(3)]
    string_values: Annotated[Sequence[string], Size(3)]
    basic_types_values: Annotated[Sequence[BasicTypes], Size(3)]
    constants_values: Annotated[Sequence[Constants], Size(3)]
    defaults_values: Annotated[Sequence[Defaults], Size(3)]
    bool_values_default: Annotated[Sequence[bool], Size(3)] = [False, True, False]
    byte_values_default: Annotated[Sequence[byte], Size(3)] = [b"\x00", b"\x01", b"\xff"]
    char_values_default: Annotated[Sequence[char], Size(3)] = [0, 1, 127]
    float32_values_default: Annotated[Sequence[float32], Size(3)] = [1.125, 0.0, -1.125]
    float64_values_default: Annotated[Sequence[float64], Size(3)] = [3.1415, 0.0, -3.1415]
    int8_values_default: Annotated[Sequence[int8], Size(3)] = [0, 127, -128]
    uint8_values_default: Annotated[Sequence[uint8], Size(3)] = [0, 1, 255]
    int16_values_default: Annotated[Sequence[int16], Size(3)] = [0, 32767, -32768]
    uint16_values_default: Annotated[Sequence[uint16], Size(3)] = [0, 1, 65535]
    int32_values_default: Annotated[Sequence[int32], Size(3)] = [0, 2147483647, -2147483648]
    uint32_values_default: Annotated[Sequence[uint32], Size(3)] = [0, 1, 4294967295]
    int64_values_default: Annotated[Sequence[int64], Size(3)] = [0, 9223372036854775807, -9223372036854775808]
    uint64_values_default: Annotated[Sequence[uint64], Size(3)] = [0, 1, 18446744073709551615]
    string_values_default: Annotated[Sequence[string], Size(3)] = ["", "max value", "min value"]
    alignment_check: int32


class BoundedPlainSequences(Message):
    """At most three of each primitive type of fixed size, and of some messages."""

    bool_values: Annotated[Sequence[bool], AtMost(3)]
    byte_values: Annotated[Sequence[byte], AtMost(3)]
    char_values: Annotated[Sequence[char], AtMost(3)]
    float32_values: Annotated[Sequence[float32], AtMost(3)]
    float64_values: Annotated[Sequence[float64], AtMost(3)]
    int8_values: Annotated[Sequence[int8], AtMost(3)]
    uint8_values: Annotated[Sequence[uint8], AtMost(3)]
    int16_values: Annotated[Sequence[int16], AtMost(3)]
    uint16_values: Annotated[Sequence[uint16], AtMost(3)]
    int32_values: Annotated[Sequence[int32], AtMost(3)]
    uint32_values: Annotated[Sequence[uint32], AtMost(3)]
    int64_values: Annotated[Sequence[int64], AtMost(3)]
    uint64_values: Annotated[Sequence[uint64], AtMost(3)]
    basic_types_values: Annotated[Sequence[BasicTypes], AtMost(3)]
    constants_values: Annotated[Sequence[Constants], AtMost(3)]
    defaults_values: Annotated[Sequence[Defaults], AtMost(3)]
    bool_values_default: Annotated[Sequence[bool], AtMost(3)] = [False, True, False]
    byte_values_default: Annotated[Sequence[byte], AtMost(3)] = [b"\x00", b"\x01", b"\xff"]
    char_values_default: Annotated[Sequence[char], AtMost(3)] = [0, 1, 127]
    float32_values_default: Annotated[Sequence[float32], AtMost(3)] = [1.125, 0.0, -1.125]
    float64_values_default: Annotated[Sequence[float64], AtMost(3)] = [3.1415, 0.0, -3.1415]
    int8_values_default: Annotated[Sequence[int8], AtMost(3)] = [0, 127, -128]
    uint8_values_default: Annotated[Sequence[uint8], AtMost(3)] = [0, 1, 255]
    int16_values_default: Annotated[Sequence[int16], AtMost(3)] = [0, 32767, -32768]
    uint16_values_default: Annotated[Sequence[uint16], AtMost(3)] = [0, 1, 65535]
    int32_values_default: Annotated[Sequence[int32], AtMost(3)] = [0, 2147483647, -2147483648]
    uint32_values_default: Annotated[Sequence[uint32], AtMost(3)] = [0, 1, 4294967295]
    int64_values_default: Annotated[Sequence[int64], AtMost(3)] = [0, 9223372036854775807, -9223372036854775808]
    uint64_values_default: Annotated[Sequence[uint64], AtMost(3)] = [0, 1, 18446744073709551615]
    alignment_check: int32


class BoundedSequences(Message):
    """At most three of each primitive type, and of some messages."""

    bool_values: Annotated[Sequence[bool], AtMost(3)]
    byte_values: Annotated[Sequence[byte], AtMost(3)]
    char_values: Annotated[Sequence[char], AtMost(3)]
    float32_values: Annotated[Sequence[float32], AtMost(3)]
    float64_values: Annotated[Sequence[float64], AtMost(3)]
    int8_values: Annotated[Sequence[int8], AtMost(3)]
    uint8_values: Annotated[Sequence[uint8], AtMost(3)]
    int16_values: Annotated[Sequence[int16], AtMost(3)]
    uint16_values: Annotated[Sequence[uint16], AtMost(3)]
    int32_values: Annotated[Sequence[int32], AtMost(3)]
    uint32_values: Annotated[Sequence[uint32], AtMost(3)]
    int64_values: Annotated[Sequence[int64], AtMost(3)]
    uint64_values: Annotated[Sequence[uint64], AtMost(3)]
    string_values: Annotated[Sequence[string], AtMost(3)]
    basic_types_values: Annotated[Sequence[BasicTypes], AtMost(3)]
    constants_values: Annotated[Sequence[Constants], AtMost(3)]
    defaults_values: Annotated[Sequence[Defaults], AtMost(3)]
    bool_values_default: Annotated[Sequence[bool], AtMost(3)] = [False, True, False]
    byte_values_default: Annotated[Sequence[byte], AtMost(3)] = [b"\x00", b"\x01", b"\xff"]
    char_values_default: Annotated[Sequence[char], AtMost(3)] = [0, 1, 127]
    float32_values_default: Annotated[Sequence[float32], AtMost(3)] = [1.125, 0.0, -1.125]
    float64_values_default: Annotated[Sequence[float64], AtMost(3)] = [3.1415, 0.0, -3.1415]
    int8_values_default: Annotated[Sequence[int8], AtMost(3)] = [0, 127, -128]
    uint8_values_default: Annotated[Sequence[uint8], AtMost(3)] = [0, 1, 255]
    int16_values_default: Annotated[Sequence[int16], AtMost(3)] = [0, 32767, -32768]
    uint16_values_default: Annotated[Sequence[uint16], AtMost(3)] = [0, 1, 65535]
    int32_values_default: Annotated[Sequence[int32], AtMost(3)] = [0, 2147483647, -2147483648]
    uint32_values_default: Annotated[Sequence[uint32], AtMost(3)] = [0, 1, 4294967295]
    int64_values_default: Annotated[Sequence[int64], AtMost(3)] = [0, 9223372036854775807, -9223372036854775808]
    uint64_values_default: Annotated[Sequence[uint64], AtMost(3)] = [0, 1, 18446744073709551615]
    string_values_default: Annotated[Sequence[string], AtMost(3)] = ["", "max value", "min value"]
    alignment_check: int32


class UnboundedSequences(Message):
    """Any number of each primitive type, and of some messages."""

    bool_values: Sequence[bool]
    byte_values: Sequence[byte]
    char_values: Sequence[char]
    float32_values: Sequence[float32]
    float64_values: Sequence[float64]
    int8_values: Sequence[int8]
    uint8_values: Sequence[uint8]
    int16_values: Sequence[int16]
    uint16_values: Sequence[uint16]
    int32_values: Sequence[int32]
    uint32_values: Sequence[uint32]
    int64_values: Sequence[int64]
    uint64_values: Sequence[uint64]
    string_values: Sequence[string]
    basic_types_values: Sequence[BasicTypes]
    constants_values: Sequence[Constants]
    defaults_values: Sequence[Defaults]
    bool_values_default: Sequence[bool] = [False, True, False]
    byte_values_default: Sequence[byte] = [b"\x00", b"\x01", b"\xff"]
    char_values_default: Sequence[char] = [0, 1, 127]
    float32_values_default: Sequence[float32] = [1.125, 0.0, -1.125]
    float64_values_default: Sequence[float64] = [3.1415, 0.0, -3.1415]
    int8_values_default: Sequence[int8] = [0, 127, -128]
    uint8_values_default: Sequence[uint8] = [0, 1, 255]
    int16_values_default: Sequence[int16] = [0, 32767, -32768]
    uint16_values_default: Sequence[uint16] = [0, 1, 65535]
    int32_values_default: Sequence[int32] = [0, 2147483647, -2147483648]
    uint32_values_default: Sequence[uint32] = [0, 1, 4294967295]
    int64_values_default: Sequence[int64] = [0, 9223372036854775807, -9223372036854775808]
    uint64_values_default: Sequence[uint64] = [0, 1, 18446744073709551615]
    string_values_default: Sequence[string] = ["", "max value", "min value"]
    alignment_check: int32


class MultiNested(Message):
    """Sequences of messages that have sequences of messages."""

    array_of_arrays: Annotated[Sequence[Arrays], Size(3)]
    array_of_bounded_sequences: Annotated[Sequence[BoundedSequences], Size(3)]
    array_of_unbounded_sequences: Annotated[Sequence[UnboundedSequences], Size(3)]
    bounded_sequence_of_arrays: Annotated[Sequence[Arrays], AtMost(3)]
    bounded_sequence_of_bounded_sequences: Annotated[Sequence[BoundedSequences], AtMost(3)]
    bounded_sequence_of_unbounded_sequences: Annotated[Sequence[UnboundedSequences], AtMost(3)]
    unbounded_sequence_of_arrays: Sequence[Arrays]
    unbounded_sequence_of_bounded_sequences: Sequence[BoundedSequences]
    unbounded_sequence_of_unbounded_sequences: Sequence[UnboundedSequences]
