# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.rcl_interfaces.msg

__all__ = ["FloatingPointRange", "IntegerRange", "ListParametersResult", "Log", "LoggerLevel", "Parameter", "ParameterDescriptor", "ParameterEvent", "ParameterEventDescriptors", "ParameterType", "ParameterValue", "SetLoggerLevelsResult", "SetParametersResult"]

class FloatingPointRange(robolink.message.Message):
    """The values that a floating point parameter may take: both ends belong to it.

    They are `step` apart, counted from `from_value`, and `to_value` is always one of them. A step of zero
    allows everything between the ends; of a negative step the magnitude counts.
    """
    from_value: builtins.float
    to_value: builtins.float
    step: builtins.float
    def __init__(self, *, from_value: builtins.float = ..., to_value: builtins.float = ..., step: builtins.float = ...) -> None: ...
class IntegerRange(robolink.message.Message):
    """The values that an integer parameter may take: both ends belong to it.

    They are `step` apart, counted from `from_value`, and `to_value` is always one of them. A step of zero
    allows everything between the ends.
    """
    from_value: builtins.int
    to_value: builtins.int
    step: builtins.int
    def __init__(self, *, from_value: builtins.int = ..., to_value: builtins.int = ..., step: builtins.int = ...) -> None: ...
class ListParametersResult(robolink.message.Message):
    """The parameters found, by full name, and the prefixes (``a.b`` of ``a.b.c``) that they stand under."""
    names: collections.abc.MutableSequence[builtins.str]
    prefixes: collections.abc.MutableSequence[builtins.str]
    def __init__(self, *, names: collections.abc.Iterable[builtins.str] = ..., prefixes: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class Log(robolink.message.Message):
    """A line that a node logged, as sent on /rosout: its level, logger, text, and place in the code."""
    DEBUG: typing.ClassVar[builtins.int]
    INFO: typing.ClassVar[builtins.int]
    WARN: typing.ClassVar[builtins.int]
    ERROR: typing.ClassVar[builtins.int]
    FATAL: typing.ClassVar[builtins.int]
    stamp: robolink.interfaces.builtin_interfaces.msg.Time
    level: builtins.int
    name: builtins.str
    msg: builtins.str
    file: builtins.str
    function: builtins.str
    line: builtins.int
    def __init__(self, *, stamp: robolink.interfaces.builtin_interfaces.msg.Time = ..., level: builtins.int = ..., name: builtins.str = ..., msg: builtins.str = ..., file: builtins.str = ..., function: builtins.str = ..., line: builtins.int = ...) -> None: ...
class LoggerLevel(robolink.message.Message):
    """A logger, by name, and the lowest level that it lets through."""
    LOG_LEVEL_UNKNOWN: typing.ClassVar[builtins.int]
    LOG_LEVEL_DEBUG: typing.ClassVar[builtins.int]
    LOG_LEVEL_INFO: typing.ClassVar[builtins.int]
    LOG_LEVEL_WARN: typing.ClassVar[builtins.int]
    LOG_LEVEL_ERROR: typing.ClassVar[builtins.int]
    LOG_LEVEL_FATAL: typing.ClassVar[builtins.int]
    name: builtins.str
    level: builtins.int
    def __init__(self, *, name: builtins.str = ..., level: builtins.int = ...) -> None: ...
class Parameter(robolink.message.Message):
    """A parameter's name and value."""
    name: builtins.str
    value: robolink.interfaces.rcl_interfaces.msg.ParameterValue
    def __init__(self, *, name: builtins.str = ..., value: robolink.interfaces.rcl_interfaces.msg.ParameterValue = ...) -> None: ...
class ParameterDescriptor(robolink.message.Message):
    """Description of a parameter: all that is known beside its value.

    `type` is a code of ParameterType. `additional_constraints` tells people what the ranges cannot say. A
    read-only parameter keeps its first value; `dynamic_typing` lets its type change. At most one of the two
    ranges is given.
    """
    name: builtins.str
    type: builtins.int
    description: builtins.str
    additional_constraints: builtins.str
    read_only: builtins.bool
    dynamic_typing: builtins.bool
    floating_point_range: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.FloatingPointRange]
    integer_range: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.IntegerRange]
    def __init__(self, *, name: builtins.str = ..., type: builtins.int = ..., description: builtins.str = ..., additional_constraints: builtins.str = ..., read_only: builtins.bool = ..., dynamic_typing: builtins.bool = ..., floating_point_range: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.FloatingPointRange] = ..., integer_range: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.IntegerRange] = ...) -> None: ...
class ParameterEvent(robolink.message.Message):
    """Changes of one step in the parameters of `node` (its full name), as sent on /parameter_events."""
    stamp: robolink.interfaces.builtin_interfaces.msg.Time
    node: builtins.str
    new_parameters: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.Parameter]
    changed_parameters: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.Parameter]
    deleted_parameters: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.Parameter]
    def __init__(self, *, stamp: robolink.interfaces.builtin_interfaces.msg.Time = ..., node: builtins.str = ..., new_parameters: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.Parameter] = ..., changed_parameters: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.Parameter] = ..., deleted_parameters: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.Parameter] = ...) -> None: ...
class ParameterEventDescriptors(robolink.message.Message):
    """The descriptors of the parameters that one step added, changed and deleted."""
    new_parameters: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.ParameterDescriptor]
    changed_parameters: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.ParameterDescriptor]
    deleted_parameters: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.ParameterDescriptor]
    def __init__(self, *, new_parameters: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.ParameterDescriptor] = ..., changed_parameters: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.ParameterDescriptor] = ..., deleted_parameters: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.ParameterDescriptor] = ...) -> None: ...
class ParameterType(robolink.message.Message):
    """The codes for what a parameter can hold; only its constants are used."""
    PARAMETER_NOT_SET: typing.ClassVar[builtins.int]
    PARAMETER_BOOL: typing.ClassVar[builtins.int]
    PARAMETER_INTEGER: typing.ClassVar[builtins.int]
    PARAMETER_DOUBLE: typing.ClassVar[builtins.int]
    PARAMETER_STRING: typing.ClassVar[builtins.int]
    PARAMETER_BYTE_ARRAY: typing.ClassVar[builtins.int]
    PARAMETER_BOOL_ARRAY: typing.ClassVar[builtins.int]
    PARAMETER_INTEGER_ARRAY: typing.ClassVar[builtins.int]
    PARAMETER_DOUBLE_ARRAY: typing.ClassVar[builtins.int]
    PARAMETER_STRING_ARRAY: typing.ClassVar[builtins.int]
    def __init__(self) -> None: ...
class ParameterValue(robolink.message.Message):
    """A value of one of several types: `type`, a code of ParameterType, says which other field counts."""
    type: builtins.int
    bool_value: builtins.bool
    integer_value: builtins.int
    double_value: builtins.float
    string_value: builtins.str
    byte_array_value: collections.abc.MutableSequence[builtins.bytes]
    bool_array_value: collections.abc.MutableSequence[builtins.bool]
    integer_array_value: collections.abc.MutableSequence[builtins.int]
    double_array_value: collections.abc.MutableSequence[builtins.float]
    string_array_value: collections.abc.MutableSequence[builtins.str]
    def __init__(self, *, type: builtins.int = ..., bool_value: builtins.bool = ..., integer_value: builtins.int = ..., double_value: builtins.float = ..., string_value: builtins.str = ..., byte_array_value: collections.abc.Iterable[builtins.bytes] = ..., bool_array_value: collections.abc.Iterable[builtins.bool] = ..., integer_array_value: collections.abc.Iterable[builtins.int] = ..., double_array_value: collections.abc.Iterable[builtins.float] = ..., string_array_value: collections.abc.Iterable[builtins.str] = ...) -> None: ...
class SetLoggerLevelsResult(robolink.message.Message):
    """Success of setting a logger's level, and the reason of a refusal, in words for people."""
    successful: builtins.bool
    reason: builtins.str
    def __init__(self, *, successful: builtins.bool = ..., reason: builtins.str = ...) -> None: ...
class SetParametersResult(robolink.message.Message):
    """Success of setting a parameter, or the reason of the refusal, in words for people."""
    successful: builtins.bool
    reason: builtins.str
    def __init__(self, *, successful: builtins.bool = ..., reason: builtins.str = ...) -> None: ...
