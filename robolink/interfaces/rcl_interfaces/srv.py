"""The services of rcl_interfaces: the parameters of a node, and the levels of its loggers."""

from typing import ClassVar

from robolink.interfaces.rcl_interfaces.msg import (
    ListParametersResult,
    LoggerLevel,
    Parameter,
    ParameterDescriptor,
    ParameterValue,
    SetLoggerLevelsResult,
    SetParametersResult,
)
from robolink.message import Message, Sequence, Service, string, uint8, uint64


class GetParameters(Service):
    """Ask a node for parameters, at ``NODE/get_parameters``."""

    class Request(Message):
        """The parameters' names."""

        names: Sequence[string]

    class Response(Message):
        """The values in the order of the names; one that is not set has the type PARAMETER_NOT_SET."""

        values: Sequence[ParameterValue]


class GetParameterTypes(Service):
    """Ask a node for the types of parameters, at ``NODE/get_parameter_types``."""

    class Request(Message):
        """The parameters' names."""

        names: Sequence[string]

    class Response(Message):
        """Codes of ParameterType in the order of the names; PARAMETER_NOT_SET for one that is not set."""

        types: Sequence[uint8]


class SetParameters(Service):
    """Set parameters of a node, each for itself, at ``NODE/set_parameters``."""

    class Request(Message):
        """The parameters; one of the type PARAMETER_NOT_SET is undeclared."""

        parameters: Sequence[Parameter]

    class Response(Message):
        """For each parameter, in that order, whether it was set, and if not, why not."""

        results: Sequence[SetParametersResult]


class SetParametersAtomically(Service):
    """Set parameters of a node, all or none, at ``NODE/set_parameters_atomically``."""

    class Request(Message):
        """The parameters."""

        parameters: Sequence[Parameter]

    class Response(Message):
        """Success, or the reason of the refusal."""

        result: SetParametersResult


class DescribeParameters(Service):
    """Ask a node what its parameters mean, at ``NODE/describe_parameters``."""

    class Request(Message):
        """The parameters' names."""

        names: Sequence[string]

    class Response(Message):
        """Their descriptors, in the order of the names."""

        descriptors: Sequence[ParameterDescriptor]


class ListParameters(Service):
    """Ask a node which parameters it has, at ``NODE/list_parameters``."""

    class Request(Message):
        """Prefixes to search below; with none everything is searched.

        `depth` is how many levels of names, parted by dots, to go down; DEPTH_RECURSIVE is all of them.
        """

        DEPTH_RECURSIVE: ClassVar[uint64] = 0

        prefixes: Sequence[string]
        depth: uint64

    class Response(Message):
        """The names found, and the prefixes that they stand under."""

        result: ListParametersResult


class GetLoggerLevels(Service):
    """Ask a node for the levels of loggers, at ``NODE/get_logger_levels``."""

    class Request(Message):
        """The loggers' names."""

        names: Sequence[string]

    class Response(Message):
        """The levels in the order of the names; LOG_LEVEL_UNKNOWN for a logger that was given none."""

        levels: Sequence[LoggerLevel]


class SetLoggerLevels(Service):
    """Set the levels of loggers, at ``NODE/set_logger_levels``."""

    class Request(Message):
        """Loggers, each with its new level."""

        levels: Sequence[LoggerLevel]

    class Response(Message):
        """For each logger, in that order, whether it was set, and if not, why not."""

        results: Sequence[SetLoggerLevelsResult]
