"""The messages of rcl_interfaces: parameters with their values and constraints, log lines and log levels."""

from typing import Annotated, ClassVar

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.message import AtMost, Message, Sequence, byte, float64, int64, string, uint8, uint32, uint64


class ParameterType(Message):
    """The codes for what a parameter can hold; only its constants are used."""

    PARAMETER_NOT_SET: ClassVar[uint8] = 0
    PARAMETER_BOOL: ClassVar[uint8] = 1
    PARAMETER_INTEGER: ClassVar[uint8] = 2
    PARAMETER_DOUBLE: ClassVar[uint8] = 3
    PARAMETER_STRING: ClassVar[uint8] = 4
    PARAMETER_BYTE_ARRAY: ClassVar[uint8] = 5
    PARAMETER_BOOL_ARRAY: ClassVar[uint8] = 6
    PARAMETER_INTEGER_ARRAY: ClassVar[uint8] = 7
    PARAMETER_DOUBLE_ARRAY: ClassVar[uint8] = 8
    PARAMETER_STRING_ARRAY: ClassVar[uint8] = 9


class ParameterValue(Message):
    """A value of one of several types: `type`, a code of ParameterType, says which other field counts."""

    type: uint8
    bool_value: bool
    integer_value: int64
    double_value: float64
    string_value: string
    byte_array_value: Sequence[byte]
    bool_array_value: Sequence[bool]
    integer_array_value: Sequence[int64]
    double_array_value: Sequence[float64]
    string_array_value: Sequence[string]


class Parameter(Message):
    """A parameter's name and value."""

    name: string
    value: ParameterValue


class FloatingPointRange(Message):
    """The values that a floating point parameter may take: both ends belong to it.

    They are `step` apart, counted from `from_value`, and `to_value` is always one of them. A step of zero
    allows everything between the ends; of a negative step the magnitude counts.
    """

    from_value: float64
    to_value: float64
    step: float64


class IntegerRange(Message):
    """The values that an integer parameter may take: both ends belong to it.

    They are `step` apart, counted from `from_value`, and `to_value` is always one of them. A step of zero
    allows everything between the ends.
    """

    from_value: int64
    to_value: int64
    step: uint64


class ParameterDescriptor(Message):
    """Description of a parameter: all that is known beside its value.

    `type` is a code of ParameterType. `additional_constraints` tells people what the ranges cannot say. A
    read-only parameter keeps its first value; `dynamic_typing` lets its type change. At most one of the two
    ranges is given.
    """

    name: string
    type: uint8
    description: string
    additional_constraints: string
    read_only: bool = False
    dynamic_typing: bool = False
    floating_point_range: Annotated[Sequence[FloatingPointRange], AtMost(1)]
    integer_range: Annotated[Sequence[IntegerRange], AtMost(1)]


class ParameterEvent(Message):
    """Changes of one step in the parameters of `node` (its full name), as sent on /parameter_events."""

    stamp: Time
    node: string
    new_parameters: Sequence[Parameter]
    changed_parameters: Sequence[Parameter]
    deleted_parameters: Sequence[Parameter]


class ParameterEventDescriptors(Message):
    """The descriptors of the parameters that one step added, changed and deleted."""

    new_parameters: Sequence[ParameterDescriptor]
    changed_parameters: Sequence[ParameterDescriptor]
    deleted_parameters: Sequence[ParameterDescriptor]


class SetParametersResult(Message):
    """Success of setting a parameter, or the reason of the refusal, in words for people."""

    successful: bool
    reason: string


class ListParametersResult(Message):
    """The parameters found, by full name, and the prefixes (``a.b`` of ``a.b.c``) that they stand under."""

    names: Sequence[string]
    prefixes: Sequence[string]


class Log(Message):
    """A line that a node logged, as sent on /rosout: its level, logger, text, and place in the code."""

    DEBUG: ClassVar[uint8] = 10
    INFO: ClassVar[uint8] = 20
    WARN: ClassVar[uint8] = 30
    ERROR: ClassVar[uint8] = 40
    FATAL: ClassVar[uint8] = 50

    stamp: Time
    level: uint8
    name: string
    msg: string
    file: string
    function: string
    line: uint32


class LoggerLevel(Message):
    """A logger, by name, and the lowest level that it lets through."""

    LOG_LEVEL_UNKNOWN: ClassVar[uint8] = 0
    LOG_LEVEL_DEBUG: ClassVar[uint8] = 10
    LOG_LEVEL_INFO: ClassVar[uint8] = 20
    LOG_LEVEL_WARN: ClassVar[uint8] = 30
    LOG_LEVEL_ERROR: ClassVar[uint8] = 40
    LOG_LEVEL_FATAL: ClassVar[uint8] = 50

    name: string
    level: uint32


class SetLoggerLevelsResult(Message):
    """Success of setting a logger's level, and the reason of a refusal, in words for people."""

    successful: bool
    reason: string
