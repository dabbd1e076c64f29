"""The parameters of a node: declared, read, set and described, with the callbacks that watch over them."""

from __future__ import annotations

import copy
import threading
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, overload

from robolink.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
    imported_as,
)
from robolink.interfaces.rcl_interfaces.msg import (
    ListParametersResult,
    ParameterDescriptor,
    ParameterEvent,
    ParameterValue,
    SetParametersResult,
)
from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.parameter import (
    PARAMETER_SEPARATOR_STRING,
    AllowableParameterValue,
    AllowableParameterValueT,
    Parameter,
)
from robolink.parameter_callbacks import ParameterCallbacks, Parameters, listed
from robolink.parameter_rules import (
    EMPTY_LIST,
    WrittenParameter,
    as_declared,
    check_names,
    describing,
    first_fitting,
    has_wrong_type,
    is_listed,
    read_declaration,
    record,
    refusal,
)
from robolink.validate_parameter_name import validate_parameter_name

if TYPE_CHECKING:
    from robolink.clock import Clock


class NodeParameters(ParameterCallbacks):
    """The part of a node that keeps its parameters.

    Any thread may read: what is stored is never changed but replaced as a whole, so that a reader sees all of an
    atomic step or nothing of it. Callbacks run with no lock held, and may themselves set parameters.
    """

    PARAM_REL_TOL = 1e-6
    """How near a float must be to an end or a step of its range, relative to its size."""

    if TYPE_CHECKING:  # the node's

        def get_clock(self) -> Clock:
            """Give the clock that stamps events."""

        def get_fully_qualified_name(self) -> str:
            """Give the name that events carry."""

        def _on_parameter_event_(self, event: ParameterEvent) -> None: ...

    def _init_parameters_(self, overrides: Mapping[str, Parameter[Any]], allow_undeclared: bool) -> None:
        """Begin without parameters. `overrides` go before the default values of what will be declared."""
        self._parameters: dict[str, Parameter[Any]] = {}
        self._descriptors: dict[str, ParameterDescriptor] = {}
        self._declared_so_far_: set[str] = set()
        """The names of all that was ever declared, also of what was refused or is no longer there."""
        self._parameter_overrides = dict(overrides)
        self._wished_parameters_: Mapping[str, Any] = {}
        """Values that go before default ones, where nobody has given another and the declaration lets them through."""
        self._allow_undeclared_parameters = allow_undeclared
        self._init_parameter_callbacks_()
        self._parameters_lock_ = threading.Lock()

    # Declaring

    def _declare_from_overrides_(self) -> None:
        """Declare all that the overrides name, each with the type that it has there."""
        self.declare_parameters("", [(name, each.type_) for name, each in self._parameter_overrides.items()])

    @overload
    def declare_parameter(
        self,
        name: str,
        value: Parameter.Type | ParameterValue | None = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter[Any]: ...

    @overload
    def declare_parameter(
        self,
        name: str,
        value: AllowableParameterValueT,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter[AllowableParameterValueT]: ...

    def declare_parameter(
        self,
        name: str,
        value: AllowableParameterValue = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter[Any]:
        """Declare a parameter with a default value, or a `Parameter.Type` and no value yet; give what it then is.

        An override from a command line, a file or the constructor goes before the default value. The type stays
        what it first is unless the descriptor says `dynamic_typing`. The on-set and post-set callbacks run.

        Raises ParameterAlreadyDeclaredException, InvalidParameterException (the name),
        InvalidParameterTypeException (an override of another type), InvalidParameterValueException (a range or
        an on-set callback refused the value), ValueError (no value and no type), TypeError (no parameter's value).
        """
        if value is None and descriptor is None:
            return self._declare_([(name,)], "", ignore_override)[0]
        described = ParameterDescriptor() if descriptor is None else descriptor
        return self._declare_([(name, value, described)], "", ignore_override)[0]

    def declare_parameters(
        self,
        namespace: str,
        parameters: Sequence[tuple[str] | tuple[str, Any] | tuple[str, Any, ParameterDescriptor]],
        ignore_override: bool = False,
    ) -> Parameters:
        """Declare several parameters, given as (name, value) or (name, value, descriptor), under ``namespace.``.

        All tuples are read before the first is declared. When a callback or a range then refuses one, those
        before it stay declared. Raises what `declare_parameter` raises.
        """
        return self._declare_(parameters, namespace, ignore_override)

    def _declare_(self, entries: Iterable[Sequence[Any]], namespace: str, ignore_override: bool) -> Parameters:
        overrides = {} if ignore_override else self._parameter_overrides
        declarations = []
        for index, entry in enumerate(entries):
            declarations.append(read_declaration(entry, index, namespace, overrides))
            if len(entry) == 1:
                warnings.warn(
                    f"declaring parameter '{entry[0]}' by its name alone is deprecated: give a default value, "
                    "a Parameter.Type or a ParameterDescriptor(dynamic_typing=True)",
                    stacklevel=3,
                )
        self._declared_so_far_.update(parameter.name for parameter, _ in declarations)
        taken = [parameter.name for parameter, _ in declarations if parameter.name in self._parameters]
        if taken:
            raise ParameterAlreadyDeclaredException(taken)
        for parameter, descriptor in declarations:
            is_given = parameter.name in self._parameter_overrides
            if is_given or not self._declare_as_wished_(parameter, descriptor):
                self._declare_one_(parameter, descriptor)
        return [self._parameters.get(parameter.name, parameter) for parameter, _ in declarations]

    def _declare_as_wished_(self, parameter: Parameter[Any], descriptor: ParameterDescriptor) -> bool:
        """Declare a parameter with what is wished for it, if that is of its type and nothing refuses it."""
        if parameter.name not in self._wished_parameters_:
            return False
        wish = WrittenParameter(parameter.name, value=self._wished_parameters_[parameter.name])
        wished = as_declared(wish, descriptor)
        fits = parameter.type_ in (Parameter.Type.NOT_SET, wished.type_)
        return fits and self._apply_([wished], descriptor).successful

    def _declare_one_(self, parameter: Parameter[Any], descriptor: ParameterDescriptor) -> None:
        result = self._apply_([parameter], descriptor)
        if result.successful:
            return
        if has_wrong_type(parameter, descriptor):
            raise InvalidParameterTypeException(parameter, Parameter.Type(descriptor.type).name)
        raise InvalidParameterValueException(parameter.name, parameter.value, result.reason)

    def undeclare_parameter(self, name: str) -> None:
        """Forget a parameter. As in rclpy, no callback hears of it and no event is sent.

        Raises ParameterNotDeclaredException, and ParameterImmutableException for a read-only parameter.
        """
        with self._parameters_lock_:
            if name not in self._parameters:
                raise self._not_declared_(name)
            if self._descriptors[name].read_only:
                raise ParameterImmutableException(name)
            self._parameters = {key: each for key, each in self._parameters.items() if key != name}
            self._descriptors = {key: each for key, each in self._descriptors.items() if key != name}

    def _not_declared_(self, names: str | list[str]) -> ParameterNotDeclaredException:
        return ParameterNotDeclaredException(names, known=self._parameters)

    # Reading

    def has_parameter(self, name: str) -> bool:
        """Say whether a parameter is declared."""
        return name in self._parameters

    def get_parameter(self, name: str) -> Parameter[Any]:
        """Give a parameter as it is now; one without value where it is undeclared and that is allowed.

        Raises ParameterNotDeclaredException, and ParameterUninitializedException for a parameter of static type
        that has had no value yet.
        """
        return self._read_(name, self._parameters)

    def get_parameters(self, names: list[str]) -> Parameters:
        """Give several parameters as they are at one moment. Raises what `get_parameter` does; TypeError for names."""
        check_names(names)
        parameters = self._parameters
        return [self._read_(name, parameters) for name in names]

    def _read_(self, name: str, parameters: Mapping[str, Parameter[Any]]) -> Parameter[Any]:
        parameter = parameters.get(name)
        if parameter is None:
            if self._allow_undeclared_parameters:
                return Parameter(name)
            raise self._not_declared_(name)
        descriptor = self._descriptors.get(name)
        if parameter.type_ is Parameter.Type.NOT_SET and descriptor is not None and not descriptor.dynamic_typing:
            raise ParameterUninitializedException(name)
        return parameter

    def get_parameter_or(self, name: str, alternative_value: Parameter[Any] | None = None) -> Parameter[Any]:
        """Give a parameter, or the alternative (default: one without value) where it is undeclared or has none."""
        parameter = self._parameters.get(name)
        if parameter is None or parameter.type_ is Parameter.Type.NOT_SET:
            return Parameter(name) if alternative_value is None else alternative_value
        return parameter

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter[Any]]:
        """Give the parameters under ``prefix.`` by the rest of their names; '' gives all.

        ``foo.ping`` is ``ping`` under the prefix ``foo``.
        """
        start = prefix + PARAMETER_SEPARATOR_STRING if prefix else ""
        return {name[len(start) :]: parameter for name, parameter in self._parameters.items() if name.startswith(start)}

    def get_parameter_type(self, name: str) -> Parameter.Type:
        """Give the type of a parameter's value, NOT_SET while it has none. Raises ParameterNotDeclaredException."""
        parameter = self._parameters.get(name)
        if parameter is not None:
            return parameter.type_
        if self._allow_undeclared_parameters:
            return Parameter.Type.NOT_SET
        raise self._not_declared_(name)

    def get_parameter_types(self, names: list[str]) -> list[Parameter.Type]:
        """Give the types of several parameters; raises as `get_parameter_type` does, and TypeError for names."""
        check_names(names)
        return [self.get_parameter_type(name) for name in names]

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Name the parameters that are one of the prefixes, or lie at most `depth` dots below one.

        No prefixes name all parameters, depth 0 means any depth. Raises TypeError for arguments of another type,
        and ValueError for a negative depth.
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

    # Setting

    def set_parameters(self, parameter_list: Parameters) -> list[SetParametersResult]:
        """Set parameters one after another, and say of each whether it was taken and if not, why.

        A value of NOT_SET undeclares a parameter whose type is dynamic. Raises ParameterNotDeclaredException at
        the first that is undeclared where that is not allowed: those before it are set then, the rest are not.
        """
        return [self._set_atomically_([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: Parameters) -> SetParametersResult:
        """Set all these parameters, or none, in one step with one event and one call of each callback.

        Raises ParameterNotDeclaredException where one is undeclared and that is not allowed, and
        InvalidParameterException where it is allowed, but the name is empty.
        """
        return self._set_atomically_(parameter_list)

    def _set_atomically_(self, parameters: Parameters) -> SetParametersResult:
        callbacks = tuple(self._pre_set_parameters_callbacks)
        if callbacks:
            parameters = [each for callback in callbacks for each in listed(callback, callback(parameters))]
            if not parameters:
                return SetParametersResult(successful=False, reason=EMPTY_LIST)
        for each in parameters:
            if not isinstance(each, Parameter):
                raise TypeError(f"expected a {imported_as()}.parameter.Parameter, got {each!r}")
        undeclared = [each.name for each in parameters if each.name not in self._parameters]
        if undeclared and not self._allow_undeclared_parameters:
            raise self._not_declared_(undeclared)
        for name in undeclared:
            validate_parameter_name(name)
        return self._apply_(parameters)

    def _apply_(self, parameters: Parameters, declaring: ParameterDescriptor | None = None) -> SetParametersResult:
        """Check parameters, ask the callbacks, store, tell. `declaring` is the descriptor of a single new one."""
        for parameter in parameters:
            reason = self._refusal_(parameter, declaring)
            if reason:
                return SetParametersResult(successful=False, reason=reason)
        for callback in tuple(self._on_set_parameters_callbacks):
            result = callback(parameters)
            if not hasattr(result, "successful"):
                raise TypeError(f"on-set callback {callback!r} must return a SetParametersResult, got {result!r:.80}")
            if not result.successful:
                return result
        self._on_parameter_event_(self._store_(parameters, declaring))
        for heard in tuple(self._post_set_parameters_callbacks):
            heard(parameters)
        return SetParametersResult(successful=True)

    def _refusal_(self, parameter: Parameter[Any], declaring: ParameterDescriptor | None) -> str:
        name = parameter.name
        descriptor = declaring or self._descriptors.get(name) or ParameterDescriptor(dynamic_typing=True)
        if descriptor.read_only and declaring is None:
            return f"Trying to set a read-only parameter: {name}."
        return refusal(parameter, descriptor, is_declared=name in self._parameters, rel_tol=self.PARAM_REL_TOL)

    def _store_(self, parameters: Parameters, declaring: ParameterDescriptor | None) -> ParameterEvent:
        with self._parameters_lock_:
            values, descriptors = dict(self._parameters), dict(self._descriptors)
            event = record(parameters, values, descriptors, declaring)
            # In this order, so that whoever finds a parameter finds its descriptor.
            self._descriptors, self._parameters = descriptors, values
        event.node = self.get_fully_qualified_name()
        event.stamp = self.get_clock().now().to_msg()
        return event

    # Describing

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Give a parameter's descriptor; an empty one where it is undeclared and that is allowed.

        Raises ParameterNotDeclaredException.
        """
        descriptor = self._descriptors.get(name)
        if descriptor is not None:
            return descriptor
        if self._allow_undeclared_parameters:
            return ParameterDescriptor()
        raise self._not_declared_(name)

    def describe_parameters(self, names: list[str]) -> list[ParameterDescriptor]:
        """Give the descriptors of several parameters. Raises ParameterNotDeclaredException."""
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(
        self, name: str, descriptor: ParameterDescriptor, alternative_value: ParameterValue | None = None
    ) -> ParameterValue:
        """Describe a parameter anew, and give the value that it then has: the alternative if its own does not fit.

        The name in the descriptor does not count. As in rclpy, no callback runs and no event is sent. Raises
        ParameterNotDeclaredException, ParameterImmutableException (it is read-only), and
        InvalidParameterValueException when neither value fits.
        """
        if not self.has_parameter(name):
            return self.get_parameter(name).get_parameter_value()
        if self.describe_parameter(name).read_only:
            raise ParameterImmutableException(name)
        candidates = [current := self.get_parameter(name)]
        if alternative_value is not None:
            candidates.append(Parameter.from_parameter_msg(ParameterMsg(name=name, value=alternative_value)))
        parameter = first_fitting(candidates, descriptor, self.PARAM_REL_TOL)
        with self._parameters_lock_:
            if parameter is not current:
                self._parameters = {**self._parameters, name: parameter}
            self._descriptors = {**self._descriptors, name: describing(parameter, copy.copy(descriptor))}
        return parameter.get_parameter_value()
