"""The services of test_msgs, for tests."""

from typing import Annotated

from robolink.interfaces.test_msgs.msg import BasicTypes as BasicTypesMessage
from robolink.interfaces.test_msgs.msg import Constants, Defaults
from robolink.message import (
    Message,
    Sequence,
    Service,
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
)


class Empty(Service):
    """Nothing there and nothing back."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Nothing."""


class BasicTypes(Service):
    """Each primitive type, both ways."""

    class Request(Message):
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
        string_value: string

    class Response(Message):
        """The same."""

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
        string_value: string


class Arrays(Service):
    """Fixed arrays, both ways."""

    class Request(Message):
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
        basic_types_values: Annotated[Sequence[BasicTypesMessage], Size(3)]
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

    class Response(Message):
        """The same."""

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
        basic_types_values: Annotated[Sequence[BasicTypesMessage], Size(3)]
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
