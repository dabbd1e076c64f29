"""Store of a node's parameters: declared, read, set and described, with the callbacks that watch over them."""

from __future__ import annotations

import copy
import threading
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

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
from robolink.parameter import PARAMETER_SEPARATOR_STRING, Parameter
from robolink.parameters.rules import (
    EMPTY_LIST,
    INVALID_RESULT,
    WrittenParameter,
    as_declared,
    describing,
    first_fitting,
    has_wrong_type,
    is_listed,
    leniency,
    read_declaration,
    record,
    refusal,
)
from robolink.validate_parameter_name import validate_parameter_name

if TYPE_CHECKING:
    from robolink.clock import Clock
    from robolink.impl.rcutils_logger import RcutilsLogger
    from robolink.publisher import Publisher

Parameters: TypeAlias = list[Parameter[Any]]
PreSetCallback: TypeAlias = Callable[[Parameters], Parameters]
OnSetCallback: TypeAlias = Callable[[Parameters], SetParametersResult]
PostSetCallback: TypeAlias = Callable[[Parameters], None]


class ParameterStore:
    """Parameters of one node, which owns this.

    Any thread may read: the values and descriptors are never changed but replaced as a whole, so that a reader sees
    all of an atomic step or nothing of it. Callbacks run with no lock held, and may themselves set parameters.

    Args:
        full_name: Full name of the node, which events carry.
        clock: Clock that stamps events.
        logger: Logger for warnings about declarations.
        overrides: Values that go before the defaults of what will be declared.
        allows_undeclared: True lets parameters be set that were never declared.
        rel_tol: Tolerance of a float towards an end or a step of its range, relative to its size.
    """

    def __init__(
        self,
        full_name: str,
        clock: Clock,
        logger: RcutilsLogger,
        overrides: dict[str, Parameter[Any]],
        allows_undeclared: bool,
        rel_tol: float,
    ) -> None:
        self._full_name, self._clock, self._logger, self._rel_tol = full_name, clock, logger, rel_tol
        self.values: dict[str, Parameter[Any]] = {}
        self.descriptors: dict[str, ParameterDescriptor] = {}
        self.declared_so_far: set[str] = set()
        """The names of all that was ever declared, also of what was refused or is no longer there."""
        self.overrides = overrides
        self.preferred: Mapping[str, Any] = {}
        """Values that go before default ones, where nobody has given another and the declaration lets them through."""
        self.allows_undeclared = allows_undeclared
        self.pre_set: list[PreSetCallback] = []
        self.on_set: list[OnSetCallback] = []
        self.post_set: list[PostSetCallback] = []
        self.events: Publisher[ParameterEvent] | None = None
        """Publisher of events; the node makes it once it is announced, and declares nothing before."""
        self._lock = threading.Lock()

    # Reading

    def read(self, name: str, values: Mapping[str, Parameter[Any]]) -> Parameter[Any]:
        """Return a parameter of `values`, which are those of one moment. Raises what `Node.get_parameter` raises."""
        parameter = values.get(name)
        if parameter is None:
            if self.allows_undeclared:
                return Parameter(name)
            raise self._not_declared(f"{name}")  # a number, by mistake, is not declared either
        descriptor = self.descriptors.get(name)
        if parameter.type_ is Parameter.Type.NOT_SET and descriptor is not None and not descriptor.dynamic_typing:
            raise ParameterUninitializedException(name)
        return parameter

    def type_of(self, name: str) -> Parameter.Type:
        """Return the type of a parameter's value. Raises what `Node.get_parameter_type` raises."""
        parameter = self.values.get(name)
        if parameter is not None:
            return parameter.type_
        if self.allows_undeclared:
            return Parameter.Type.NOT_SET
        raise self._not_declared(name)

    def below(self, prefix: str) -> dict[str, Parameter[Any]]:
        """Return the parameters below a prefix by the rest of their names."""
        start = prefix + PARAMETER_SEPARATOR_STRING if prefix else ""
        return {name[len(start) :]: parameter for name, parameter in self.values.items() if name.startswith(start)}

    def names(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return names of parameters, and their prefixes. Raises what `Node.list_parameters` raises."""
        if not isinstance(prefixes, list) or not all(isinstance(each, str) for each in prefixes):
            raise TypeError(f"prefixes must be a list of str, got {prefixes!r}")
        if not isinstance(depth, int):
            raise TypeError(f"depth must be an int, got {depth!r}")
        if depth < 0:
            raise ValueError(f"depth must not be negative, got {depth}")
        requested = frozenset(prefixes)
        names = [name for name in self.values if is_listed(name, requested, depth)]
        parents = (name.rpartition(PARAMETER_SEPARATOR_STRING)[:2] for name in names)
        return ListParametersResult(names=names, prefixes=list(dict.fromkeys(each for each, dot in parents if dot)))

    def describe(self, name: str) -> ParameterDescriptor:
        """Return the descriptor of a parameter. Raises what `Node.describe_parameter` raises."""
        descriptor = self.descriptors.get(name)
        if descriptor is not None:
            return descriptor
        if self.allows_undeclared:
            return ParameterDescriptor()
        raise self._not_declared(name)

    def _not_declared(self, names: str | list[str]) -> ParameterNotDeclaredException:
        return ParameterNotDeclaredException(names, known=self.values)

    # Declaring

    def declare(self, entries: Iterable[Sequence[Any]], namespace: str, ignore_override: bool) -> Parameters:
        """Declare parameters, and return them as they then are. Raises what `Node.declare_parameter` raises."""
        overrides = {} if ignore_override else self.overrides
        declarations = []
        for index, entry in enumerate(entries):
            declarations.append(read_declaration(entry, index, namespace, overrides))
            if len(entry) == 1:
                warnings.warn(
                    f"declaring parameter '{entry[0]}' by its name alone is deprecated: give a default value, "
                    "a Parameter.Type or a ParameterDescriptor(dynamic_typing=True)",
                    stacklevel=3,
                )
        self.declared_so_far.update(parameter.name for parameter, _ in declarations)
        taken = [parameter.name for parameter, _ in declarations if parameter.name in self.values]
        if taken:
            raise ParameterAlreadyDeclaredException(taken)
        for parameter, descriptor in declarations:
            is_given = parameter.name in self.overrides
            if is_given or not self._declare_as_preferred(parameter, descriptor):
                self._declare_one(parameter, descriptor)
                if warning := leniency(overrides.get(parameter.name), parameter):
                    self._logger.warning(warning)
        return [self.values.get(parameter.name, parameter) for parameter, _ in declarations]

    def _declare_as_preferred(self, parameter: Parameter[Any], descriptor: ParameterDescriptor) -> bool:
        """Declare a parameter with its preferred value, if that is of its type and nothing refuses it."""
        if parameter.name not in self.preferred:
            return False
        written = WrittenParameter(parameter.name, value=self.preferred[parameter.name])
        preferred = as_declared(written, descriptor)
        fits = parameter.type_ in (Parameter.Type.NOT_SET, preferred.type_)
        return fits and self._apply([preferred], descriptor).successful

    def _declare_one(self, parameter: Parameter[Any], descriptor: ParameterDescriptor) -> None:
        result = self._apply([parameter], descriptor)
        if result.successful:
            return
        if has_wrong_type(parameter, descriptor):
            raise InvalidParameterTypeException(parameter, Parameter.Type(descriptor.type).name)
        raise InvalidParameterValueException(parameter.name, parameter.value, result.reason)

    def undeclare(self, name: str) -> None:
        """Remove a parameter. Raises what `Node.undeclare_parameter` raises."""
        with self._lock:
            if name not in self.values:
                raise self._not_declared(name)
            if self.descriptors[name].read_only:
                raise ParameterImmutableException(name)
            self.values = {key: each for key, each in self.values.items() if key != name}
            self.descriptors = {key: each for key, each in self.descriptors.items() if key != name}

    # Setting

    def set_atomically(self, parameters: Parameters) -> SetParametersResult:
        """Set all these parameters, or none. Raises what `Node.set_parameters_atomically` raises."""
        callbacks = tuple(self.pre_set)
        if callbacks:
            parameters = [each for callback in callbacks for each in _listed(callback, callback(parameters))]
            if not parameters:
                return SetParametersResult(successful=False, reason=EMPTY_LIST)
        for each in parameters:
            if not isinstance(each, Parameter):
                raise TypeError(f"expected a {imported_as()}.parameter.Parameter, got {each!r}")
        undeclared = [each.name for each in parameters if each.name not in self.values]
        if undeclared and not self.allows_undeclared:
            raise self._not_declared(undeclared)
        for name in undeclared:
            validate_parameter_name(name)
        return self._apply(parameters)

    def _apply(self, parameters: Parameters, declaring: ParameterDescriptor | None = None) -> SetParametersResult:
        """Check parameters, ask the callbacks, store, notify. `declaring` is the descriptor of a single new one."""
        for parameter in parameters:
            reason = self._refusal(parameter, declaring)
            if reason:
                return SetParametersResult(successful=False, reason=reason)
        for callback in tuple(self.on_set):
            result = callback(parameters)
            if not hasattr(result, "successful"):
                text = f"on-set callback {callback!r} must return a SetParametersResult, got {result!r:.80}"
                warnings.warn(text, stacklevel=4)
                return SetParametersResult(successful=False, reason=INVALID_RESULT)
            if not result.successful:
                return result
        event = self._store(parameters, declaring)
        if self.events is not None:
            self.events.publish(event)
        for heard in tuple(self.post_set):
            heard(parameters)
        return SetParametersResult(successful=True)

    def _refusal(self, parameter: Parameter[Any], declaring: ParameterDescriptor | None) -> str:
        name = parameter.name
        descriptor = declaring or self.descriptors.get(name) or ParameterDescriptor(dynamic_typing=True)
        if descriptor.read_only and declaring is None:
            return f"Trying to set a read-only parameter: {name}."
        return refusal(parameter, descriptor, is_declared=name in self.values, rel_tol=self._rel_tol)

    def _store(self, parameters: Parameters, declaring: ParameterDescriptor | None) -> ParameterEvent:
        with self._lock:
            values, descriptors = dict(self.values), dict(self.descriptors)
            event = record(parameters, values, descriptors, declaring)
            # In this order, so that whoever finds a parameter finds its descriptor.
            self.descriptors, self.values = descriptors, values
        event.node = self._full_name
        event.stamp = self._clock.now().to_msg()
        return event

    def set_descriptor(
        self, name: str, descriptor: ParameterDescriptor, alternative: ParameterValue | None
    ) -> ParameterValue:
        """Replace the descriptor of a parameter. Raises what `Node.set_descriptor` raises."""
        if name not in self.values:
            return self.read(name, self.values).get_parameter_value()
        if self.descriptors[name].read_only:
            raise ParameterImmutableException(name)
        candidates = [current := self.read(name, self.values)]
        if alternative is not None:
            candidates.append(Parameter.from_parameter_msg(ParameterMsg(name=name, value=alternative)))
        parameter = first_fitting(candidates, descriptor, self._rel_tol)
        with self._lock:
            if parameter is not current:
                self.values = {**self.values, name: parameter}
            self.descriptors = {**self.descriptors, name: describing(parameter, copy.copy(descriptor))}
        return parameter.get_parameter_value()


def _listed(callback: PreSetCallback, given: Any) -> Parameters:
    """Return the result of a pre-set callback as a list. Raises TypeError, naming the callback, for what is none."""
    if isinstance(given, Iterable):
        return list(given)
    raise TypeError(f"pre-set callback {callback!r} must return a list of parameters, got {given!r:.80}")
