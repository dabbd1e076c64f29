"""Parameters of a node: declared, set and described, with the callbacks that watch over them."""

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
    imported_as,
)
from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.interfaces.rcl_interfaces.msg import (
    ParameterDescriptor,
    ParameterEvent,
    ParameterValue,
    SetParametersResult,
)
from robolink.node_parts.parameter_reading import ParameterReading
from robolink.parameter import (
    AllowableParameterValue,
    AllowableParameterValueT,
    Parameter,
)
from robolink.parameters.callbacks import Parameters, listed
from robolink.parameters.rules import (
    EMPTY_LIST,
    INVALID_RESULT,
    WrittenParameter,
    as_declared,
    describing,
    first_fitting,
    has_wrong_type,
    leniency,
    read_declaration,
    record,
    refusal,
)
from robolink.validate_parameter_name import validate_parameter_name

if TYPE_CHECKING:
    from robolink.clock import Clock
    from robolink.impl.rcutils_logger import RcutilsLogger


class NodeParameters(ParameterReading):
    """The part of a node that keeps its parameters.

    Callbacks run with no lock held, and may themselves set parameters.
    """

    PARAM_REL_TOL = 1e-6
    """Tolerance of a float towards an end or a step of its range, relative to its size."""

    if TYPE_CHECKING:  # the node's

        def get_logger(self) -> RcutilsLogger:
            """Return the logger of what is told about its parameters."""

        def get_clock(self) -> Clock:
            """Return the clock that stamps events."""

        def get_fully_qualified_name(self) -> str:
            """Return the name that events carry."""

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
        """Declare a parameter, and return it as it then is. The on-set and post-set callbacks run.

        Args:
            name: Name of the parameter; dots nest.
            value: Default value: bool, int, float, str, or a list of one of them; a `Parameter.Type` fixes the type
                without a value. The type of the parameter stays what it first is.
            descriptor: Description, range, `read_only`, and `dynamic_typing`, which lets the type change. None
                describes nothing.
            ignore_override: True takes the default value, even if a command line, a file or the node's constructor
                overrides it.

        Raises:
            ParameterAlreadyDeclaredException: if the parameter is declared.
            InvalidParameterException: (a ValueError) if the name is empty.
            InvalidParameterTypeException: (a TypeError) if the override is of another type.
            InvalidParameterValueException: (a ValueError) if a range or an on-set callback refuses the value.
            ValueError: if there is neither value nor type.
            TypeError: if the value is of no parameter's type.
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
        """Declare several parameters, and return them as they then are.

        All are checked before the first is declared. If a callback or a range then refuses one, those before it stay
        declared. Raises what `declare_parameter` raises.

        Args:
            namespace: Prefix of all names, without its dot; '' is none.
            parameters: Tuples (name, value) or (name, value, descriptor), as `declare_parameter` takes them.
            ignore_override: True takes the default values, even if they are overridden.
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
                told = leniency(overrides.get(parameter.name), parameter)
                if told:
                    self.get_logger().warning(told)
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
        """Remove the parameter `name`. As in rclpy, no callback is called and no event is sent.

        Raises:
            ParameterNotDeclaredException: if it is not declared.
            ParameterImmutableException: if it is read-only.
        """
        with self._parameters_lock_:
            if name not in self._parameters:
                raise self._not_declared_(name)
            if self._descriptors[name].read_only:
                raise ParameterImmutableException(name)
            self._parameters = {key: each for key, each in self._parameters.items() if key != name}
            self._descriptors = {key: each for key, each in self._descriptors.items() if key != name}

    # Setting

    def set_parameters(self, parameter_list: Parameters) -> list[SetParametersResult]:
        """Set parameters one after another, and return a result for each: successful or not, and the reason.

        Args:
            parameter_list: Parameters to set; one of the type NOT_SET undeclares a parameter whose type is dynamic.

        Raises:
            ParameterNotDeclaredException: at the first that is undeclared, if that is not allowed: those before it
                are set then, the rest is not.
        """
        return [self._set_atomically_([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: Parameters) -> SetParametersResult:
        """Set all these parameters, or none, in one step with one event and one call of each callback.

        Args:
            parameter_list: Parameters to set; one of the type NOT_SET undeclares a parameter whose type is dynamic.

        Returns:
            A result: successful or not, and the reason.

        Raises:
            ParameterNotDeclaredException: if one is undeclared, and that is not allowed.
            InvalidParameterException: (a ValueError) if a name is empty.
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
        """Check parameters, ask the callbacks, store, notify. `declaring` is the descriptor of a single new one."""
        for parameter in parameters:
            reason = self._refusal_(parameter, declaring)
            if reason:
                return SetParametersResult(successful=False, reason=reason)
        for callback in tuple(self._on_set_parameters_callbacks):
            result = callback(parameters)
            if not hasattr(result, "successful"):
                text = f"on-set callback {callback!r} must return a SetParametersResult, got {result!r:.80}"
                warnings.warn(text, stacklevel=4)
                return SetParametersResult(successful=False, reason=INVALID_RESULT)
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

    def set_descriptor(
        self, name: str, descriptor: ParameterDescriptor, alternative_value: ParameterValue | None = None
    ) -> ParameterValue:
        """Replace the descriptor of a parameter. As in rclpy, no callback runs and no event is sent.

        Args:
            name: Name of the parameter.
            descriptor: New descriptor; the name in it does not count.
            alternative_value: Value for the parameter if its own does not fit the descriptor; None is none.

        Returns:
            The value that the parameter then has.

        Raises:
            ParameterNotDeclaredException: if it is not declared, and undeclared ones are not allowed.
            ParameterImmutableException: if it is read-only.
            InvalidParameterValueException: (a ValueError) if neither value fits.
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
