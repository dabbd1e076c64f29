"""Parameters of a node as it reads them: their values, types and descriptors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from robolink.exceptions import ParameterNotDeclaredException, ParameterUninitializedException
from robolink.interfaces.rcl_interfaces.msg import ListParametersResult, ParameterDescriptor
from robolink.parameter import PARAMETER_SEPARATOR_STRING, Parameter
from robolink.parameters.callbacks import ParameterCallbacks, Parameters
from robolink.parameters.rules import check_names, is_listed


class ParameterReading(ParameterCallbacks):
    """The part of a node that reads its parameters.

    Any thread may: what is stored is never changed but replaced as a whole, so that a reader sees all of an atomic
    step or nothing of it.
    """

    _parameters: dict[str, Parameter[Any]]
    _descriptors: dict[str, ParameterDescriptor]
    _allow_undeclared_parameters: bool

    def has_parameter(self, name: str) -> bool:
        """True if the parameter `name` is declared."""
        return name in self._parameters

    def get_parameter(self, name: str) -> Parameter[Any]:
        """Return the parameter `name` as it is now; one without value if undeclared ones are allowed.

        Raises:
            ParameterNotDeclaredException: if it is not declared, and undeclared ones are not allowed.
            ParameterUninitializedException: if it has a static type and no value yet.
        """
        return self._read_(name, self._parameters)

    def get_parameters(self, names: list[str]) -> Parameters:
        """Return the parameters `names` as they are at one moment.

        Raises what `get_parameter` raises, and TypeError if a name is not a str.
        """
        check_names(names)
        parameters = self._parameters
        return [self._read_(name, parameters) for name in names]

    def _read_(self, name: str, parameters: Mapping[str, Parameter[Any]]) -> Parameter[Any]:
        parameter = parameters.get(name)
        if parameter is None:
            if self._allow_undeclared_parameters:
                return Parameter(name)
            raise self._not_declared_(f"{name}")  # a number, by mistake, is not declared either
        descriptor = self._descriptors.get(name)
        if parameter.type_ is Parameter.Type.NOT_SET and descriptor is not None and not descriptor.dynamic_typing:
            raise ParameterUninitializedException(name)
        return parameter

    def get_parameter_or(self, name: str, alternative_value: Parameter[Any] | None = None) -> Parameter[Any]:
        """Return a parameter, or an alternative if it is undeclared or has no value.

        Args:
            name: Name of the parameter.
            alternative_value: Parameter to return instead; None is one without value.
        """
        parameter = self._parameters.get(name)
        if parameter is None or parameter.type_ is Parameter.Type.NOT_SET:
            return Parameter(name) if alternative_value is None else alternative_value
        return parameter

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter[Any]]:
        """Return the parameters below `prefix` by the rest of their names; '' returns all.

        `foo.ping` is `ping` below the prefix `foo`.
        """
        start = prefix + PARAMETER_SEPARATOR_STRING if prefix else ""
        return {name[len(start) :]: parameter for name, parameter in self._parameters.items() if name.startswith(start)}

    def get_parameter_type(self, name: str) -> Parameter.Type:
        """Return the type of the value of the parameter `name`, NOT_SET while it has none.

        Raises ParameterNotDeclaredException if it is not declared, and undeclared ones are not allowed.
        """
        parameter = self._parameters.get(name)
        if parameter is not None:
            return parameter.type_
        if self._allow_undeclared_parameters:
            return Parameter.Type.NOT_SET
        raise self._not_declared_(name)

    def get_parameter_types(self, names: list[str]) -> list[Parameter.Type]:
        """Return the types of the parameters `names`. Raises what `get_parameter_type` raises, TypeError for no str."""
        check_names(names)
        return [self.get_parameter_type(name) for name in names]

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return the names of parameters, and the prefixes of these names.

        Args:
            prefixes: Names of parameters, or what their names begin with (without the dot); none lists all.
            depth: Largest number of dots below a prefix; 0 is any number.

        Raises:
            TypeError: if the arguments are of another type.
            ValueError: if the depth is negative.
        """
        if not isinstance(prefixes, list) or not all(isinstance(each, str) for each in prefixes):
            raise TypeError(f"prefixes must be a list of str, got {prefixes!r}")
        if not isinstance(depth, int):
            raise TypeError(f"depth must be an int, got {depth!r}")
        if depth < 0:
            raise ValueError(f"depth must not be negative, got {depth}")
        wanted = frozenset(prefixes)
        names = [name for name in self._parameters if is_listed(name, wanted, depth)]
        parents = (name.rpartition(PARAMETER_SEPARATOR_STRING)[:2] for name in names)
        return ListParametersResult(names=names, prefixes=list(dict.fromkeys(each for each, dot in parents if dot)))

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Return the descriptor of the parameter `name`; an empty one if undeclared ones are allowed.

        Raises ParameterNotDeclaredException if it is not declared, and undeclared ones are not allowed.
        """
        descriptor = self._descriptors.get(name)
        if descriptor is not None:
            return descriptor
        if self._allow_undeclared_parameters:
            return ParameterDescriptor()
        raise self._not_declared_(name)

    def describe_parameters(self, names: list[str]) -> list[ParameterDescriptor]:
        """Return the descriptors of the parameters `names`. Raises what `describe_parameter` raises."""
        return [self.describe_parameter(name) for name in names]

    def _not_declared_(self, names: str | list[str]) -> ParameterNotDeclaredException:
        return ParameterNotDeclaredException(names, known=self._parameters)
