# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.rcl_interfaces.msg

__all__ = ["DescribeParameters", "GetLoggerLevels", "GetParameterTypes", "GetParameters", "ListParameters", "SetLoggerLevels", "SetParameters", "SetParametersAtomically"]

class DescribeParameters(robolink.message.Service):
    """Ask a node what its parameters mean, at ``NODE/describe_parameters``.

    The parameters' names.
    """
    class Request(robolink.message.Message):
        names: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, names: collections.abc.Iterable[builtins.str] = ...) -> None: ...
    class Response(robolink.message.Message):
        """Their descriptors, in the order of the names."""
        descriptors: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.ParameterDescriptor]
        def __init__(self, *, descriptors: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.ParameterDescriptor] = ...) -> None: ...
class GetLoggerLevels(robolink.message.Service):
    """Ask a node for the levels of loggers, at ``NODE/get_logger_levels``.

    The loggers' names.
    """
    class Request(robolink.message.Message):
        names: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, names: collections.abc.Iterable[builtins.str] = ...) -> None: ...
    class Response(robolink.message.Message):
        """The levels in the order of the names; LOG_LEVEL_UNKNOWN for a logger that was given none."""
        levels: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.LoggerLevel]
        def __init__(self, *, levels: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.LoggerLevel] = ...) -> None: ...
class GetParameterTypes(robolink.message.Service):
    """Ask a node for the types of parameters, at ``NODE/get_parameter_types``.

    The parameters' names.
    """
    class Request(robolink.message.Message):
        names: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, names: collections.abc.Iterable[builtins.str] = ...) -> None: ...
    class Response(robolink.message.Message):
        """Codes of ParameterType in the order of the names; PARAMETER_NOT_SET for one that is not set."""
        types: collections.abc.MutableSequence[builtins.int]
        def __init__(self, *, types: collections.abc.Iterable[builtins.int] = ...) -> None: ...
class GetParameters(robolink.message.Service):
    """Ask a node for parameters, at ``NODE/get_parameters``.

    The parameters' names.
    """
    class Request(robolink.message.Message):
        names: collections.abc.MutableSequence[builtins.str]
        def __init__(self, *, names: collections.abc.Iterable[builtins.str] = ...) -> None: ...
    class Response(robolink.message.Message):
        """The values in the order of the names; one that is not set has the type PARAMETER_NOT_SET."""
        values: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.ParameterValue]
        def __init__(self, *, values: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.ParameterValue] = ...) -> None: ...
class ListParameters(robolink.message.Service):
    """Ask a node which parameters it has, at ``NODE/list_parameters``.

    Prefixes to search below; with none everything is searched.

    `depth` is how many levels of names, parted by dots, to go down; DEPTH_RECURSIVE is all of them.
    """
    class Request(robolink.message.Message):
        DEPTH_RECURSIVE: typing.ClassVar[builtins.int]
        prefixes: collections.abc.MutableSequence[builtins.str]
        depth: builtins.int
        def __init__(self, *, prefixes: collections.abc.Iterable[builtins.str] = ..., depth: builtins.int = ...) -> None: ...
    class Response(robolink.message.Message):
        """The names found, and the prefixes that they stand under."""
        result: robolink.interfaces.rcl_interfaces.msg.ListParametersResult
        def __init__(self, *, result: robolink.interfaces.rcl_interfaces.msg.ListParametersResult = ...) -> None: ...
class SetLoggerLevels(robolink.message.Service):
    """Set the levels of loggers, at ``NODE/set_logger_levels``.

    Loggers, each with its new level.
    """
    class Request(robolink.message.Message):
        levels: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.LoggerLevel]
        def __init__(self, *, levels: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.LoggerLevel] = ...) -> None: ...
    class Response(robolink.message.Message):
        """For each logger, in that order, whether it was set, and if not, why not."""
        results: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.SetLoggerLevelsResult]
        def __init__(self, *, results: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.SetLoggerLevelsResult] = ...) -> None: ...
class SetParameters(robolink.message.Service):
    """Set parameters of a node, each for itself, at ``NODE/set_parameters``.

    The parameters; one of the type PARAMETER_NOT_SET is undeclared.
    """
    class Request(robolink.message.Message):
        parameters: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.Parameter]
        def __init__(self, *, parameters: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.Parameter] = ...) -> None: ...
    class Response(robolink.message.Message):
        """For each parameter, in that order, whether it was set, and if not, why not."""
        results: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.SetParametersResult]
        def __init__(self, *, results: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.SetParametersResult] = ...) -> None: ...
class SetParametersAtomically(robolink.message.Service):
    """Set parameters of a node, all or none, at ``NODE/set_parameters_atomically``.

    The parameters.
    """
    class Request(robolink.message.Message):
        parameters: collections.abc.MutableSequence[robolink.interfaces.rcl_interfaces.msg.Parameter]
        def __init__(self, *, parameters: collections.abc.Iterable[robolink.interfaces.rcl_interfaces.msg.Parameter] = ...) -> None: ...
    class Response(robolink.message.Message):
        """Success, or the reason of the refusal."""
        result: robolink.interfaces.rcl_interfaces.msg.SetParametersResult
        def __init__(self, *, result: robolink.interfaces.rcl_interfaces.msg.SetParametersResult = ...) -> None: ...
